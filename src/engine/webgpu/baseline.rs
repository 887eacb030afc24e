//! A baseline for benchmarks: Selection on the CPU, as in the paper that the README cites. The other phases stay on the
//! GPU. In each iteration the labels go to the host and the selection goes back.
//!
//! A label is the best edge of a triangle, as Label finds it. The host takes the edges one after another, each if both
//! of its triangles are free. As in the paper, there is no guard against two flips that make the same edge: on a coarse
//! mesh the result may be not manifold.

use super::WebGpu;
use super::adjacency::COUNTERS;
use super::compile::compile;
use super::copies::Source;
use super::kernels::{Kernel, Plan};
use super::known::Known;
use super::params::UNEMBEDDED;
use crate::{Error, NONE};
use std::sync::atomic::{AtomicBool, Ordering};

/// Smaller choices of Label are half-edges, as in `mesh.wgsl`.
const DOUBTFUL: u32 = 0xffff_fffd;

static IS_ON: AtomicBool = AtomicBool::new(false);

/// From now on, sessions on the WebGPU engine select on the CPU, or on the GPU again.
pub fn select_on_cpu(is_on: bool) {
    IS_ON.store(is_on, Ordering::Relaxed);
}

pub(super) fn is_on() -> bool {
    IS_ON.load(Ordering::Relaxed)
}

impl WebGpu {
    pub(super) async fn run_selecting_on_cpu(&mut self, count: u32) -> Result<Vec<u32>, Error> {
        self.known = Known::default();
        self.compile_baseline().await?;
        let (gpu, triangles) = (self.gpu.clone(), self.params.triangles);
        // With this bit, Flip takes the selection of Select.
        let signs = [gpu.read(&self.counters, COUNTERS + 1).await?[COUNTERS] | UNEMBEDDED];
        gpu.queue.write_buffer(&self.buffers.uniform, 0, bytemuck::cast_slice(&signs));
        let mut flips = Vec::new();
        while (flips.len() as u32) < count {
            let label = |pass: &mut wgpu::ComputePass| {
                self.dispatch(pass, Kernel::Label, triangles);
                self.dispatch(pass, Kernel::Decide, triangles);
            };
            let commands = || {
                self.begin_history();
                self.encode(&label)
            };
            let labels = [Source::new(&self.buffers.choices, triangles as usize)];
            let labels = gpu.submit_and_read(&commands, &labels).await?.words(0)?;
            let Some(selection) = select(&labels) else {
                break;
            };
            let flip = |pass: &mut wgpu::ComputePass| {
                if let Some(take_selection) = self.kernels.take_selection.get() {
                    pass.set_pipeline(take_selection);
                    pass.dispatch_workgroups(gpu.workgroups(triangles), 1, 1);
                }
                self.dispatch(pass, Kernel::Flip, triangles);
            };
            gpu.write_all(&[(&self.buffers.choices, triangles as usize, &selection)]);
            let history = self.read_history(&flip).await?;
            self.dispatches += 4;
            flips.extend(self.take_over(&history));
        }
        Ok(flips)
    }

    async fn compile_baseline(&self) -> Result<(), Error> {
        if self.kernels.take_selection.get().is_none() {
            let compiled = compile(&[Plan::baseline(self.form)], &self.gpu.device).await;
            let pipeline = compiled.unwrap_or_default().pop().and_then(|mut kernels| kernels.pipelines.pop());
            let message = || "the baseline does not compile".to_owned();
            let pipeline = pipeline.ok_or_else(|| Error::Device { message: message() })?;
            // Two first runs may both compile it.
            let _ = self.kernels.take_selection.set(pipeline);
        }
        Ok(())
    }
}

/// For each triangle a half-edge of its selected edge, or [`NONE`]; `None` if no edge is labelled.
fn select(labels: &[u32]) -> Option<Vec<u32>> {
    let mut selection = vec![NONE; labels.len()];
    let mut is_empty = true;
    for (t, &g) in labels.iter().enumerate().filter(|&(_, &g)| g < DOUBTFUL) {
        let other = g as usize / 3;
        if selection[t] == NONE && selection[other] == NONE {
            (selection[t], selection[other], is_empty) = (g, g, false);
        }
    }
    (!is_empty).then_some(selection)
}
