//! Records the kernels that untangle a mesh in the plane, in an update. Natively only: the modules of the npm package flip.

use super::WebGpu;
use super::device::Device;
use super::steps::Step;

/// Rounds with dispatches of their own on a device whose loops end early: all but the last ones, whose number is not known.
/// It has to be that of `untangle.wgsl`.
pub(super) const MOST_ROUNDS: u32 = 30;

/// The same elsewhere. One workgroup does the rest.
const WIDE_ROUNDS: u32 = 0;

/// Triangles for each invocation of half a round on a device whose loops end early. If half of all triangles are turned
/// over, it has so few of them that its loops have tens of thousands of rounds. Software GPUs begin workgroups slowly.
const SHARE: u32 = 32;

/// How many rounds are dispatches of their own.
pub(super) fn rounds(gpu: &Device) -> u32 {
    if gpu.ends_loops_early { MOST_ROUNDS } else { WIDE_ROUNDS }
}

impl WebGpu {
    /// So many rounds get dispatches of their own.
    #[cfg(test)]
    pub(crate) fn set_wide_rounds(&mut self, rounds: u32) {
        self.rounds = rounds;
    }

    /// Untangles before the embedded stars are marked, and after the signs of all triangles are known.
    pub(super) fn record_untangling(&self, pass: &mut wgpu::ComputePass) {
        let Some([half, all]) = self.kernels.untangle.get().map(|kernels| &kernels[..]) else { return };
        if self.params.untangles == 0 {
            return;
        }
        let share = if self.gpu.ends_loops_early { SHARE } else { 1 };
        let groups = self.gpu.workgroups(self.params.triangles.div_ceil(share));
        pass.set_pipeline(half);
        for index in 0..2 * self.rounds {
            self.at_step(pass, Step::Iterate(index));
            pass.dispatch_workgroups(groups, 1, 1);
        }
        self.at_step(pass, Step::Iterate(2 * self.rounds));
        pass.set_pipeline(all);
        pass.dispatch_workgroups(1, 1, 1);
    }
}
