//! Records the kernels that untangle a mesh in the plane, in an update.

use super::WebGpu;
use super::compile::compile_now;
use super::copies::Source;
use super::faults::{Caught, watch};
use super::history::TURNED;
use super::kernels::Plan;
use super::steps::Step;

/// Rounds with dispatches of their own on a device whose loops end early: all but the last ones, whose number is not
/// known. It has to be that of `untangle.wgsl`. One workgroup does the others.
pub(super) const ALL_ROUNDS: u32 = 30;

/// The same elsewhere if many triangles were turned over. The rounds after these find little to do.
const MANY_ROUNDS: u32 = 22;

/// The same if fewer than [`MANY`] were, and if none was: mostly there is nothing to do again.
const FEW_ROUNDS: u32 = 4;
const IDLE_ROUNDS: u32 = 1;

const MANY: u32 = 2048;

/// The fewest workgroups of such a round, enough to keep a large GPU busy, and those if none was turned over.
const FEWEST_WORKGROUPS: u32 = 128;
const IDLE_WORKGROUPS: u32 = 32;

/// Triangles for each invocation of half a round on a device whose loops end early. If half of all triangles are turned
/// over, it has so few of them that its loops have tens of thousands of rounds. Software GPUs begin workgroups slowly.
const SHARE: u32 = 32;

impl WebGpu {
    /// So many rounds get dispatches of their own.
    #[cfg(test)]
    pub(crate) fn set_wide_rounds(&mut self, rounds: u32) {
        self.turned.rounds = Some(rounds);
    }

    /// How many rounds of an update are dispatches of their own.
    fn rounds(&self) -> u32 {
        #[cfg(test)]
        if let Some(rounds) = self.turned.rounds {
            return rounds;
        }
        match self.turned.count {
            _ if self.gpu.ends_loops_early => ALL_ROUNDS,
            0 => IDLE_ROUNDS,
            1..MANY => FEW_ROUNDS,
            _ => MANY_ROUNDS,
        }
    }

    /// Submits the commands of an update. If it untangles, the host asks for the number of turned triangles.
    pub(super) fn submit_frame(&mut self, record: &dyn Fn(&Self) -> wgpu::CommandEncoder) -> Caught {
        let gpu = self.gpu.clone();
        if self.params.untangles > 0 {
            let asks = !gpu.ends_loops_early && self.turned.advance(&gpu);
            self.dispatches += 2 * u64::from(self.rounds()) + 1;
            if asks {
                let source = Source { buffer: &self.buffers.history, first: TURNED, words: 1 };
                let mut read = gpu.submit_and_map(&|| record(self), &[source]);
                let caught = read.take_caught();
                self.turned.read = Some(read);
                return caught;
            }
        }
        watch(&gpu.device, || gpu.submit(record(self).finish())).1
    }

    /// The workgroups of a round.
    fn workgroups_of(&self, round: u32) -> u32 {
        if self.gpu.ends_loops_early {
            return self.gpu.workgroups(self.params.triangles.div_ceil(SHARE));
        }
        match self.turned.count {
            0 => IDLE_WORKGROUPS,
            // Each round leaves about half of the work of the round before.
            count => self.gpu.workgroups(3 * (count >> round)).max(FEWEST_WORKGROUPS),
        }
    }

    /// Untangles before the embedded stars are marked, and after the signs of all triangles are known.
    pub(super) fn record_untangling(&self, pass: &mut wgpu::ComputePass) {
        if self.params.untangles == 0 {
            return;
        }
        let compile =
            || compile_now(&Plan::untangle(self.form, self.gpu.tail_size), &self.gpu.device).pipelines;
        let [half, all] = &self.kernels.untangle.get_or_init(compile)[..] else { return };
        pass.set_pipeline(half);
        let rounds = self.rounds();
        for index in 0..2 * rounds {
            self.at_step(pass, Step::Iterate(index));
            pass.dispatch_workgroups(self.workgroups_of(index / 2), 1, 1);
        }
        self.at_step(pass, Step::Iterate(2 * rounds));
        pass.set_pipeline(all);
        pass.dispatch_workgroups(1, 1, 1);
    }
}
