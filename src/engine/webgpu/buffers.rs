//! The buffers of a mesh. Their sizes are known from the start; only the topology may grow later.

use super::buffer::{Begun, Buffer, Sent};
use super::device::{Device, bytes_for};
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
    /// The buffer of the triangles. A page may draw from it and from the positions without a copy.
    pub(super) fn triangles(gpu: &Device, words: usize) -> Buffer {
        gpu.buffer("triangles", words, BufferUsages::STORAGE | BufferUsages::INDEX)
    }

    pub(super) fn positions(gpu: &Device, words: usize) -> Buffer {
        gpu.buffer("positions", words, BufferUsages::STORAGE | BufferUsages::VERTEX)
    }

    /// Makes the buffers except those that were sent, and writes the steps. Returns how many words of the triangles and of
    /// the positions are written.
    pub(super) fn new(gpu: &Device, upload: &Upload, sent: Sent) -> (Self, [usize; 2]) {
        let mesh = &upload.mesh;
        let count = mesh.triangle_count();
        // The words of fixed-point numbers are not those of the page.
        let positions = sent.positions.filter(|_| !upload.form().is_fixed);
        let fitting =
            |sent: Option<Begun>, words| sent.filter(|(buffer, _)| buffer.size() == bytes_for(words));
        let (triangles, positions) =
            (fitting(sent.triangles, 3 * count), fitting(positions, upload.words().len()));
        let written = [&triangles, &positions].map(|sent| sent.as_ref().map_or(0, |sent| sent.1));
        let storage = |label, words| gpu.buffer(label, words, BufferUsages::STORAGE);
        let drawn = |label, words, usage| gpu.buffer(label, words, BufferUsages::STORAGE | usage);
        let step_words = Step::words();
        let buffers = Self {
            uniform: gpu.buffer("params", size_of::<Params>() / 4, BufferUsages::UNIFORM),
            steps: gpu.buffer("steps", step_words.len(), BufferUsages::UNIFORM),
            positions: positions.map_or_else(|| Self::positions(gpu, upload.words().len()), |sent| sent.0),
            triangles: triangles.map_or_else(|| Self::triangles(gpu, 3 * count), |sent| sent.0),
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
        (buffers, written)
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

    /// Writes the mesh, behind the words of the triangles and of the positions that are written. Returns the faults.
    pub(super) async fn upload(&self, gpu: &Device, upload: &Upload, written: [usize; 2]) -> Vec<Caught> {
        let [triangles, positions] = written;
        let writes = [
            (&self.triangles, triangles, &upload.mesh.triangles()[triangles..]),
            (&self.positions, positions, &upload.words()[positions..]),
        ];
        let mut faults = gpu.upload(&writes).await;
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
        buffers.push((&gpu.programs, None));
        gpu.bind(layout, &buffers)
    }
}
