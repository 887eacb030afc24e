//! The phases as compute shaders, through wgpu: natively and in the browser.
//!
//! An iteration is four dispatches, and a batch of them with a tail of short ones is one submission: a later
//! iteration sees on the device that an earlier one has flipped nothing. The host reads the history of a
//! batch when it has ended.

mod adjacency;
#[cfg(target_arch = "wasm32")]
mod ahead;
#[cfg(target_arch = "wasm32")]
mod browser;
mod buffers;
mod copies;
mod device;
mod faults;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
mod host;
mod kernels;
mod limits;
mod params;
mod programs;
mod shared;
mod start;
mod steps;
#[cfg(test)]
mod tests;

#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub use browser::GpuDevice;
pub(crate) use device::Device;
pub(crate) use kernels::Kernel;
pub(crate) use shared::{GivenDevice, Handle};

#[cfg(all(target_arch = "wasm32", feature = "js"))]
use super::SharedObjects;
use super::upload::Form;
use super::{Answer, Census, EdgeCounts, Engine};
use crate::Error;
#[cfg(test)]
use crate::adjacency::unflagged;
use crate::mesh::Mesh;
use crate::phases::Thresholds;
use buffers::Buffers;
#[cfg(test)]
use kernels::Plan;
use kernels::{Kernels, WORKGROUP_SIZE};
use params::Params;
use programs::{DECIDERS, LANE_COUNT};
use std::sync::Arc;
use steps::Step;

/// Iterations with a dispatch for each phase in one submission.
const BATCH: u32 = 12;
/// Iterations that the tail may run after them.
const TAIL: u32 = 256;
/// The same where loops end too early.
const SHORT_TAIL: u32 = 4;
/// How often it may pause in a submission for exact arithmetic.
const PAUSES: u32 = 8;

// Words of the history, as in `state.wgsl`.
const COUNTS: usize = 6;
const ENTRIES: usize = 8;
const ENTRY_WORDS: usize = 4;
const HISTORY_WORDS: usize = ENTRIES + ENTRY_WORDS * (1 + BATCH as usize + TAIL as usize);

/// The entry of the history that the next iteration starts from: FLIPS, LENGTH, BUILT, RAN.
type Entry = [u32; ENTRY_WORDS];

/// A mesh on the device.
pub(crate) struct WebGpu {
    gpu: Handle,
    kernels: Arc<Kernels>,
    thresholds: Thresholds,
    form: Form,
    params: Params,
    counts: EdgeCounts,
    bindings: wgpu::BindGroup,
    buffers: Buffers,
    state: Entry,
    dispatches: u64,
    adjacency_ms: f64,
    /// The most that its buffers took at a time.
    bytes: u64,
}

impl WebGpu {
    /// One submission of up to `count` iterations; returns the flips of those that ran, the last of which may
    /// be zero.
    async fn submit(&mut self, count: u32) -> Result<Vec<u32>, Error> {
        let batch = count.min(BATCH);
        self.params.tail = batch;
        self.params.tail_iterations =
            (count - batch).min(if self.gpu.ends_loops_early { SHORT_TAIL } else { TAIL });
        self.dispatches += u64::from(4 * batch + self.params.tail_iterations.min(1) * (1 + 2 * PAUSES));
        let record = |pass: &mut wgpu::ComputePass| {
            for index in 0..batch {
                self.at_step(pass, Step::Iterate(index));
                for kernel in Kernel::ITERATION {
                    self.dispatch(pass, kernel, self.params.triangles);
                }
            }
            if self.params.tail_iterations > 0 {
                self.dispatch(pass, Kernel::Tail, 1);
                self.at_step(pass, Step::Resume);
                for _ in 0..PAUSES {
                    self.dispatch(pass, Kernel::Decide, self.params.tail_length);
                    self.dispatch(pass, Kernel::Tail, 1);
                }
            }
        };
        let history = self.read_history(&record).await?;
        Ok(self.take_over(&history))
    }

    /// Writes the state as the first entry, and zeros behind it.
    fn begin_history(&self) {
        let mut history = [0u32; HISTORY_WORDS];
        history[ENTRIES..ENTRIES + ENTRY_WORDS].copy_from_slice(&self.state);
        self.gpu.queue.write_buffer(&self.buffers.history, 0, bytemuck::cast_slice(&history));
    }

    /// Submits commands that continue the history, and reads it behind them.
    async fn read_history(&self, record: &dyn Fn(&mut wgpu::ComputePass)) -> Result<Vec<u32>, Error> {
        let commands = || {
            self.begin_history();
            self.encode(record)
        };
        self.gpu.submit_and_read(&commands, &self.buffers.history, HISTORY_WORDS).await
    }

    /// Takes over the last state of a history, and returns the flips of the iterations that ran.
    fn take_over(&mut self, history: &[u32]) -> Vec<u32> {
        let entries = history[ENTRIES..].chunks_exact(ENTRY_WORDS).skip(1);
        let ran: Vec<&[u32]> = entries.take_while(|entry| entry[3] == 1).collect();
        if let Some(last) = ran.last() {
            self.state.copy_from_slice(last);
        }
        self.params.first += ran.len() as u32;
        ran.iter().map(|entry| entry[0]).collect()
    }

    /// Commands in one compute pass, with the parameters as they are now and the first step bound.
    fn encode(&self, record: &dyn Fn(&mut wgpu::ComputePass)) -> wgpu::CommandEncoder {
        self.gpu.queue.write_buffer(&self.buffers.uniform, 0, bytemuck::bytes_of(&self.params));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_bind_group(0, &self.bindings, &[0]);
        record(&mut pass);
        drop(pass);
        encoder
    }

    fn at_step(&self, pass: &mut wgpu::ComputePass, step: Step) {
        pass.set_bind_group(0, &self.bindings, &[step.offset()]);
    }

    /// For so many triangles.
    fn dispatch(&self, pass: &mut wgpu::ComputePass, kernel: Kernel, triangles: u32) {
        let groups = self.gpu.workgroups(triangles);
        pass.set_pipeline(&self.kernels.pipelines[kernel as usize]);
        if kernel != Kernel::Decide {
            return pass.dispatch_workgroups(groups, 1, 1);
        }
        let most = LANE_COUNT / DECIDERS;
        // Where loops end too early, each invocation decides one triangle at a time.
        let all =
            if self.gpu.ends_loops_early { groups.div_ceil(most) * WORKGROUP_SIZE / DECIDERS } else { 1 };
        for _ in 0..all {
            pass.dispatch_workgroups(groups.min(most), 1, 1);
        }
    }

    async fn run(&mut self, count: u32) -> Result<Vec<u32>, Error> {
        let mut flips = Vec::new();
        // The first word of the state: the flips of the last iteration.
        while self.state[0] > 0 && (flips.len() as u32) < count {
            let ran = self.submit(count - flips.len() as u32).await?;
            if ran.is_empty() {
                return Err(Error::Device { message: "the device ran no iteration".to_owned() });
            }
            flips.extend(ran);
            if flips.last() == Some(&0) {
                flips.pop();
                break;
            }
        }
        Ok(flips)
    }

    async fn count(&mut self) -> Result<Census, Error> {
        self.dispatches += 3;
        let counts = self
            .count_by(&|pass| {
                for (step, kernel) in [
                    (Step::Census, Kernel::Census),
                    (Step::Census, Kernel::Decide),
                    (Step::Resume, Kernel::Census),
                ] {
                    self.at_step(pass, step);
                    self.dispatch(pass, kernel, self.params.triangles);
                }
            })
            .await?;
        Ok(Census::of_counts(&counts))
    }

    /// What kernels count.
    async fn count_by(&self, record: &dyn Fn(&mut wgpu::ComputePass)) -> Result<Vec<u32>, Error> {
        let commands = || {
            let history = &self.buffers.history;
            self.gpu.queue.write_buffer(history, 0, bytemuck::cast_slice(&[0u32; ENTRIES]));
            self.encode(record)
        };
        self.gpu.submit_and_read(&commands, &self.buffers.history, COUNTS).await
    }
}

impl Engine for WebGpu {
    fn batch(&self) -> u32 {
        BATCH + TAIL
    }

    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        Box::pin(self.flag_locked(half_edges))
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        Box::pin(self.run(count))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(self.count())
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.gpu.read(&self.buffers.triangles, 3 * self.params.triangles as usize))
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.gpu.read(&self.buffers.twins, 3 * self.params.triangles as usize))
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>) -> Answer<'_, ()> {
        Box::pin(self.move_vertices(mesh))
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.counts
    }

    fn backend(&self) -> &'static str {
        "gpu"
    }

    fn adapter(&self) -> Option<String> {
        Some(self.gpu.adapter.clone())
    }

    fn dispatches(&self) -> u64 {
        self.dispatches
    }

    fn device_bytes(&self) -> u64 {
        self.bytes
    }

    fn adjacency_ms(&self) -> Option<f64> {
        Some(self.adjacency_ms)
    }

    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn shared_objects(&self) -> Option<SharedObjects> {
        Some(SharedObjects {
            device: self.gpu.device.as_webgpu()?.into(),
            positions: self.buffers.floats.as_ref().unwrap_or(&self.buffers.positions).as_webgpu()?.into(),
            triangles: self.buffers.triangles.as_webgpu()?.into(),
        })
    }
}

/// One phase at a time, for the tests.
#[cfg(test)]
impl WebGpu {
    /// Runs one phase of the next iteration; after the flips, which end it, returns their number.
    pub(crate) async fn run_phase(&mut self, kernel: Kernel) -> Result<u32, Error> {
        let history = self.read_history(&|pass| self.dispatch(pass, kernel, self.params.triangles)).await?;
        Ok(self.take_over(&history).last().copied().unwrap_or(0))
    }

    /// Interior edges that the filter decides, and those that it does not.
    pub(crate) async fn tiers(&self) -> Result<[u32; 2], Error> {
        let compiled = kernels::compile(&[Plan::tiers(self.form)], &self.gpu.device).await;
        let [kernels] = &compiled.unwrap_or_default()[..] else {
            return Err(Error::Device { message: "the tiers do not compile".to_owned() });
        };
        let record = |pass: &mut wgpu::ComputePass| {
            pass.set_pipeline(&kernels.pipelines[0]);
            pass.dispatch_workgroups(self.gpu.workgroups(self.params.triangles), 1, 1);
        };
        let counts = self.count_by(&record).await?;
        Ok([counts[0], counts[1]])
    }

    /// Lists from the start and sweeps in between, whatever the size of the mesh.
    pub(crate) fn set_list_below(&mut self, flips: u32) {
        self.params.list_below = flips;
    }

    /// `best` and `selected`.
    pub(crate) async fn choices(&self) -> Result<(Vec<u32>, Vec<u32>), Error> {
        let count = self.params.triangles as usize;
        let mut best = self.gpu.read(&self.buffers.choices, 2 * count).await?;
        let selected = best.split_off(count).into_iter().map(unflagged).collect();
        Ok((best, selected))
    }

    pub(crate) async fn fans(&self) -> Result<Vec<u32>, Error> {
        let words = (self.params.fans + self.params.fans_length) as usize;
        Ok(self.gpu.read(&self.buffers.topology, words).await?.split_off(self.params.fans as usize))
    }
}
