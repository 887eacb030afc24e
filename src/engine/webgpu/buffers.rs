//! The buffers of a mesh whose sizes are known from the start.

use super::device::{Buffer, Device};
use super::params::Params;
use super::{BATCH, HISTORY_WORDS, STEP_WORDS};
use crate::engine::upload::Upload;
use wgpu::BufferUsages;

pub(super) struct Buffers {
    pub(super) uniform: Buffer,
    pub(super) steps: Buffer,
    pub(super) positions: Buffer,
    pub(super) triangles: Buffer,
    pub(super) twins: Buffer,
    pub(super) choices: Buffer,
    pub(super) frontier: Buffer,
    pub(super) history: Buffer,
    /// The positions as floats, where those that the shaders read are none.
    pub(super) floats: Option<Buffer>,
}

impl Buffers {
    /// With the triangles and the steps in them.
    pub(super) fn new(gpu: &Device, upload: &Upload) -> Self {
        let mesh = &upload.mesh;
        let count = mesh.triangle_count();
        let storage = |label, words| gpu.buffer(label, words, BufferUsages::STORAGE);
        let drawn = |label, words, usage| gpu.buffer(label, words, BufferUsages::STORAGE | usage);
        let buffers = Self {
            uniform: gpu.buffer("params", size_of::<Params>() / 4, BufferUsages::UNIFORM),
            steps: gpu.buffer("steps", (BATCH * STEP_WORDS) as usize, BufferUsages::UNIFORM),
            // A page may draw from these two without a copy.
            positions: drawn("positions", upload.words().len(), BufferUsages::VERTEX),
            triangles: drawn("triangles", 3 * count, BufferUsages::INDEX),
            twins: storage("twins", 3 * count),
            choices: storage("choices", 2 * count),
            frontier: storage("frontier", 3 * count),
            history: storage("history", HISTORY_WORDS),
            floats: upload
                .form()
                .is_fixed
                .then(|| drawn("floats", mesh.positions().len(), BufferUsages::VERTEX)),
        };
        gpu.queue.write_buffer(&buffers.triangles, 0, bytemuck::cast_slice(mesh.triangles()));
        let indices: Vec<u32> = (0..BATCH * STEP_WORDS).map(|word| word / STEP_WORDS).collect();
        gpu.queue.write_buffer(&buffers.steps, 0, bytemuck::cast_slice(&indices));
        buffers
    }

    /// Bound for the phases, with the topology behind them.
    pub(super) fn bind(
        &self,
        gpu: &Device,
        layout: &wgpu::BindGroupLayout,
        topology: &Buffer,
    ) -> wgpu::BindGroup {
        let Self { uniform, steps, positions, triangles, twins, choices, frontier, history, .. } = self;
        let whole = [positions, triangles, twins, choices, frontier, history, topology];
        let mut buffers = vec![(uniform, None), (steps, Some(4))];
        buffers.extend(whole.map(|buffer| (buffer, None)));
        gpu.bind(layout, &buffers)
    }
}
