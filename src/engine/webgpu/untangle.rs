//! Records the kernels that untangle a mesh in the plane, in an update.

use super::WebGpu;
use super::compile::compile_now;
use super::device::Device;
use super::kernels::Plan;
use super::steps::Step;

/// Rounds with dispatches of their own on a device whose loops end early: all but the last ones, whose number is not known.
/// It has to be that of `untangle.wgsl`.
pub(super) const MOST_ROUNDS: u32 = 30;

/// The same elsewhere. One workgroup does the rest.
const WIDE_ROUNDS: u32 = 1;

/// The most workgroups of such a round: enough for a large GPU, and few to begin in vain.
const MOST_WORKGROUPS: u32 = 128;

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
        if self.params.untangles == 0 {
            return;
        }
        let compile =
            || compile_now(&Plan::untangle(self.form, self.gpu.tail_size), &self.gpu.device).pipelines;
        let [half, all] = &self.kernels.untangle.get_or_init(compile)[..] else { return };
        let triangles = self.params.triangles;
        let groups = if self.gpu.ends_loops_early {
            self.gpu.workgroups(triangles.div_ceil(SHARE))
        } else {
            self.gpu.workgroups(triangles).min(MOST_WORKGROUPS)
        };
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
