//! Records the kernels that untangle a mesh in the plane, in an update.

use super::WebGpu;
use super::compile::compile_now;
use super::kernels::Plan;
use super::steps::Step;

/// Rounds with dispatches of their own on a device whose loops end early: all but the last ones, whose number is not known.
/// It has to be that of `untangle.wgsl`.
pub(super) const MOST_ROUNDS: u32 = 30;

/// The same elsewhere. One workgroup does the rest.
const WIDE_ROUNDS: u32 = 0;

/// Triangles for each invocation of half a round on a device whose loops end early. If half of all triangles are turned
/// over, it has so few of them that its loops have tens of thousands of rounds. Software GPUs begin workgroups slowly.
const SHARE: u32 = 32;

impl WebGpu {
    /// Decides whether the next preparation untangles.
    pub(super) fn set_untangling(&mut self, untangles: bool) {
        let rounds = if self.gpu.ends_loops_early { MOST_ROUNDS } else { WIDE_ROUNDS };
        self.rounds = untangles.then_some(self.rounds.unwrap_or(rounds));
    }

    /// So many rounds get dispatches of their own.
    #[cfg(test)]
    pub(crate) fn set_wide_rounds(&mut self, rounds: u32) {
        self.rounds = Some(rounds);
    }

    /// Untangles before the embedded stars are marked, and after the signs of all triangles are known.
    pub(super) fn record_untangling(&self, pass: &mut wgpu::ComputePass) {
        let Some(rounds) = self.rounds.filter(|_| self.params.update > 0) else { return };
        let compile = || {
            let plan = Plan::untangle(self.form, self.gpu.tail_size);
            plan.map(|plan| compile_now(&plan, &self.gpu.device).pipelines).unwrap_or_default()
        };
        let [half, all] = &self.kernels.untangle.get_or_init(compile)[..] else { return };
        let share = if self.gpu.ends_loops_early { SHARE } else { 1 };
        let groups = self.gpu.workgroups(self.params.triangles.div_ceil(share));
        pass.set_pipeline(half);
        for index in 0..2 * rounds {
            self.at_step(pass, Step::Iterate(index));
            pass.dispatch_workgroups(groups, 1, 1);
        }
        self.at_step(pass, Step::Iterate(2 * rounds));
        pass.set_pipeline(all);
        pass.dispatch_workgroups(1, 1, 1);
    }
}
