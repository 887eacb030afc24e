//! Estimates how long a whole job takes on each engine, from the caller's arrays to the result. `auto` compares them.
//!
//! The constants fit the tables of `npm run crossover` on an NVIDIA H200 with 16 cores; `Rates::start` fits the table
//! of `cargo bench -p benches --bench start`. On another machine, the times of all engines change by about the same
//! factor; `npm run crossover` shows whether the choice is right there.

use crate::Dimension;

/// What the estimates depend on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Job {
    pub(crate) triangles: usize,
    pub(crate) dimension: Dimension,
    /// Threads of the CPU engine.
    pub(crate) threads: usize,
}

/// Milliseconds that a GPU has to save to be chosen.
const MARGIN: f64 = 2.5;

/// The fraction of a CPU job that precedes its first iteration.
const SET_UP: f64 = 0.5;

/// Constants of a native or a WebAssembly build.
struct Rates {
    /// Nanoseconds per triangle on one thread of the CPU, in the plane and in space.
    cpu: [f64; 2],
    /// The sequential fraction of that time.
    alone: f64,
    /// Milliseconds to start several threads.
    several: f64,
    /// Milliseconds for an empty job on a GPU that is ready.
    gpu: f64,
    /// Nanoseconds per triangle on the GPU.
    gpu_triangle: f64,
    /// Milliseconds to make a GPU ready if its driver has to compile all kernels.
    start: f64,
}

#[cfg(not(target_arch = "wasm32"))]
const RATES: Rates =
    Rates { cpu: [200.0, 220.0], alone: 0.06, several: 2.0, gpu: 1.5, gpu_triangle: 13.0, start: 700.0 };

#[cfg(target_arch = "wasm32")]
const RATES: Rates =
    Rates { cpu: [220.0, 260.0], alone: 0.15, several: 7.0, gpu: 4.2, gpu_triangle: 22.0, start: 850.0 };

impl Job {
    fn cpu(self) -> f64 {
        let rate = RATES.cpu[self.dimension.stride() - 2];
        let share = RATES.alone + (1.0 - RATES.alone) / self.threads as f64;
        let start = if self.threads > 1 { RATES.several } else { 0.0 };
        start + 1e-6 * rate * share * self.triangles as f64
    }

    fn gpu(self) -> f64 {
        RATES.gpu + 1e-6 * RATES.gpu_triangle * self.triangles as f64
    }

    /// Whether a GPU that is ready finishes first.
    pub(crate) fn is_for_gpu(self) -> bool {
        self.cpu() > self.gpu() + MARGIN
    }

    /// The same for the rest of a job, after `set_up` and `flip` milliseconds on the CPU. A slow set-up raises the
    /// estimate for the CPU.
    pub(crate) fn continues_on_gpu(self, set_up: f64, flip: f64) -> bool {
        let whole = self.cpu().max(set_up / SET_UP);
        whole - set_up - flip > self.gpu() + MARGIN
    }

    /// Whether a GPU finishes first even if it has to start.
    pub(crate) fn waits_for_gpu(self) -> bool {
        self.cpu() > self.gpu() + RATES.start
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn job(triangles: usize, threads: usize) -> Job {
        Job { triangles, dimension: Dimension::Three, threads }
    }

    #[test]
    fn small_jobs_are_for_the_cpu_and_large_ones_for_the_gpu() {
        assert!(!job(0, 1).is_for_gpu());
        assert!(!job(1000, 1).is_for_gpu());
        for threads in [1, 16] {
            assert!(job(1_000_000, threads).is_for_gpu());
            assert!(!job(50_000, threads).waits_for_gpu());
            assert!(job(100_000_000, threads).waits_for_gpu());
        }
    }

    #[test]
    fn jobs_that_wait_for_a_gpu_suit_a_gpu_and_larger_ones_do_too() {
        for threads in [1, 2, 16, 256] {
            let jobs: Vec<_> = (0..27).map(|power| job(1 << power, threads)).collect();
            assert!(jobs.iter().all(|job| !job.waits_for_gpu() || job.is_for_gpu()));
            assert!(jobs.is_sorted_by_key(|job| job.is_for_gpu()));
            assert!(jobs.is_sorted_by_key(|job| job.waits_for_gpu()));
        }
    }

    #[test]
    fn a_job_that_is_nearly_done_stays_on_the_cpu() {
        assert!(job(2_000_000, 1).continues_on_gpu(100.0, 100.0));
        assert!(!job(2_000_000, 1).continues_on_gpu(400.0, 600.0));
        // On a slow machine.
        assert!(job(2_000_000, 1).continues_on_gpu(1000.0, 600.0));
    }
}
