//! The buffers of a mesh. Their sizes are known from the start; only the topology may grow later.

use super::buffer::Buffer;
use super::device::Device;
use super::faults::{Caught, watch};
use super::history::HISTORY_WORDS;
use super::params::{DEVICE_WORDS, Params, TopologyOffsets};
use super::steps::Step;
use crate::engine::gpu::upload::Upload;
use wgpu::BufferUsages;

/// Words of the frontier for `triangles` triangles. It is longer than every other buffer whose length depends on the
/// triangles; `state.wgsl` has its layout. The table of edges is in it before the first iteration. A twelfth more words
/// than edges keep the search in the table short.
pub(super) fn frontier_words(triangles: usize) -> usize {
    3 * triangles + triangles / 4 + 64
}

pub(super) struct Buffers {
    pub(super) uniform: Buffer,
    pub(super) steps: Buffer,
    pub(super) positions: Buffer,
    pub(super) triangles: Buffer,
    pub(super) twins: Buffer,
    pub(super) choices: Buffer,
    pub(super) frontier: Buffer,
    pub(super) history: Buffer,
    pub(super) topology: Buffer,
    /// The positions as floats, if the shaders read fixed-point numbers.
    pub(super) floats: Option<Buffer>,
}

impl Buffers {
    /// Makes the buffers, and writes the steps.
    pub(super) fn new(gpu: &Device, upload: &Upload) -> Self {
        let mesh = &upload.mesh;
        let count = mesh.triangle_count();
        let storage = |label, words| gpu.buffer(label, words, BufferUsages::STORAGE);
        let drawn = |label, words, usage| gpu.buffer(label, words, BufferUsages::STORAGE | usage);
        let step_words = Step::words();
        let buffers = Self {
            uniform: gpu.buffer("params", size_of::<Params>() / 4, BufferUsages::UNIFORM),
            steps: gpu.buffer("steps", step_words.len(), BufferUsages::UNIFORM),
            // A page may draw from these two buffers without a copy.
            positions: drawn("positions", upload.words().len(), BufferUsages::VERTEX),
            triangles: drawn("triangles", 3 * count, BufferUsages::INDEX),
            twins: storage("twins", 3 * count),
            choices: storage("choices", 2 * count),
            frontier: storage("frontier", frontier_words(count)),
            history: storage("history", HISTORY_WORDS),
            topology: storage("topology", TopologyOffsets::new(mesh).fans as usize),
            floats: upload
                .form()
                .is_fixed
                .then(|| drawn("floats", mesh.positions().len(), BufferUsages::VERTEX)),
        };
        gpu.write(&buffers.steps, &step_words);
        gpu.write(&buffers.uniform, &[0; DEVICE_WORDS]);
        buffers
    }

    /// Records the zeros that the work begins with.
    pub(super) fn clear(&self, encoder: &mut wgpu::CommandEncoder) {
        for buffer in [&self.twins, &self.choices, &self.frontier, &self.history, &self.topology] {
            encoder.clear_buffer(buffer, 0, None);
        }
    }

    /// Their size on the device.
    pub(super) fn bytes(&self) -> u64 {
        let Self {
            uniform,
            steps,
            positions,
            triangles,
            twins,
            choices,
            frontier,
            history,
            topology,
            floats,
        } = self;
        let all = [uniform, steps, positions, triangles, twins, choices, frontier, history, topology];
        all.into_iter().chain(floats).map(|buffer| buffer.size()).sum()
    }

    /// Writes the mesh. Returns the faults.
    pub(super) async fn upload(&self, gpu: &Device, upload: &Upload) -> Vec<Caught> {
        let (triangles, positions) = (upload.mesh.triangles(), upload.words());
        let mut faults = gpu.upload(&[(&self.triangles, triangles), (&self.positions, positions)]).await;
        faults.push(watch(&gpu.device, || self.write_floats(gpu, upload)).1);
        faults
    }

    /// Writes other positions.
    pub(super) fn write_positions(&self, gpu: &Device, upload: &Upload) {
        gpu.write(&self.positions, upload.words());
        self.write_floats(gpu, upload);
    }

    fn write_floats(&self, gpu: &Device, upload: &Upload) {
        if let Some(floats) = &self.floats {
            gpu.write(floats, bytemuck::cast_slice(&upload.mesh.positions().to_f32()));
        }
    }

    /// The bind group for the phases.
    pub(super) fn bind(&self, gpu: &Device, layout: &wgpu::BindGroupLayout) -> wgpu::BindGroup {
        let Self {
            uniform, steps, positions, triangles, twins, choices, frontier, history, topology, ..
        } = self;
        let whole = [positions, triangles, twins, choices, frontier, history, topology];
        let mut buffers = vec![(uniform, None), (steps, Some(8))];
        buffers.extend(whole.map(|buffer| (buffer, None)));
        buffers.push((&gpu.numbers, None));
        gpu.bind(layout, &buffers)
    }
}
