//! The phases as compute shaders, through wgpu: natively and in the browser.
//!
//! An iteration is three dispatches, and a batch of them with a tail of short ones is one submission: a later
//! iteration sees on the device that an earlier one has flipped nothing. The host reads the history of a
//! batch when it has ended.

mod adjacency;
mod device;
mod limits;
#[cfg(test)]
mod tests;

pub(crate) use device::{Device, Handle};

#[cfg(all(target_arch = "wasm32", feature = "js"))]
use super::SharedObjects;
use super::{Answer, Census, EdgeCounts, Engine};
use crate::mesh::{Dimension, Mesh};
use crate::predicates::cosine_fraction;
use crate::star::Fans;
use crate::winding::Winding;
use crate::{Error, Reason};
use limits::{refuse, refuse_beyond_limits, refuse_large_buffer};
use std::sync::Arc;
use wgpu::BufferUsages;

/// Iterations with a dispatch for each phase in one submission.
const BATCH: u32 = 16;
/// Iterations that the tail may run after them, on lists of up to so many triangles.
const TAIL: u32 = 256;
const TAIL_LENGTH: u32 = 2048;
/// The same where loops end too early: a few thousand rounds for each of a few triangles are safe.
const SHORT_TAIL: u32 = 4;
const SHORT_TAIL_LENGTH: u32 = 256;
/// Meshes of up to so many triangles go by lists from the start.
const SMALL_MESH: usize = 4096;
/// The most triangles at one vertex where loops end too early.
const SHORT_STAR: u32 = 20_000;
/// Words from one step to the next: the alignment of a dynamic offset that every device offers.
const STEP_WORDS: u32 = 64;

// Words of the history, as in `state.wgsl`.
const ENTRIES: usize = 4;
const ENTRY_WORDS: usize = 4;
const HISTORY_WORDS: usize = ENTRIES + ENTRY_WORDS * (1 + BATCH as usize + TAIL as usize);

/// As in `state.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Params {
    dimension: u32,
    vertices: u32,
    triangles: u32,
    first: u32,
    fans: u32,
    fans_length: u32,
    winding_length: u32,
    tail: u32,
    cos: f32,
    cos_sign: i32,
    cos_shift: u32,
    tail_iterations: u32,
    tail_length: u32,
    list_below: u32,
    padding: [u32; 2],
    cos_square: [u32; 4],
}

/// The kernels of `iteration.wgsl`.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kernel {
    Label,
    Select,
    Flip,
    Tail,
    Census,
    FlagCreases,
}

impl Kernel {
    const ALL: [Self; 6] =
        [Self::Label, Self::Select, Self::Flip, Self::Tail, Self::Census, Self::FlagCreases];

    /// The entry point.
    fn name(self) -> &'static str {
        match self {
            Self::Label => "label_all",
            Self::Select => "select_all",
            Self::Flip => "flip_all",
            Self::Tail => "tail",
            Self::Census => "census",
            Self::FlagCreases => "flag_creases",
        }
    }
}

/// The entry of the history that the next iteration starts from: FLIPS, LENGTH, BUILT, RAN.
type Entry = [u32; ENTRY_WORDS];

/// A mesh on the device.
pub(crate) struct WebGpu {
    gpu: Handle,
    params: Params,
    counts: EdgeCounts,
    bindings: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    steps: wgpu::Buffer,
    positions: wgpu::Buffer,
    triangles: wgpu::Buffer,
    twins: wgpu::Buffer,
    choices: wgpu::Buffer,
    frontier: wgpu::Buffer,
    history: wgpu::Buffer,
    topology: wgpu::Buffer,
    state: Entry,
    dispatches: u64,
}

impl WebGpu {
    /// Uploads the mesh and builds its adjacency; `cos` is the cosine of β.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] for a mesh that is too large for the device or has coordinates of too many
    /// magnitudes; [`Error::Device`].
    pub(crate) async fn new(gpu: Handle, mesh: &Arc<Mesh>, cos: f64) -> Result<Self, Error> {
        refuse_beyond_limits(&gpu, mesh)?;
        let count = mesh.triangle_count();
        let storage = |label, words| gpu.buffer(label, words, BufferUsages::STORAGE);
        let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        // A page may draw from these two without a copy.
        let positions =
            gpu.buffer("positions", mesh.positions().len(), BufferUsages::STORAGE | BufferUsages::VERTEX);
        let triangles = gpu.buffer("triangles", 3 * count, BufferUsages::STORAGE | BufferUsages::INDEX);
        let twins = storage("twins", 3 * count);
        let choices = storage("choices", 2 * count);
        let frontier = storage("frontier", 3 * count);
        let history = storage("history", HISTORY_WORDS);
        let uniform = gpu.buffer("params", size_of::<Params>() / 4, BufferUsages::UNIFORM);
        let steps = gpu.buffer("steps", (BATCH * STEP_WORDS) as usize, BufferUsages::UNIFORM);
        if scope.pop().await.is_some() {
            return refuse(format!("{} has no memory left for it", gpu.adapter));
        }
        gpu.queue.write_buffer(&positions, 0, bytemuck::cast_slice(mesh.positions()));
        gpu.queue.write_buffer(&triangles, 0, bytemuck::cast_slice(mesh.triangles()));
        let indices: Vec<u32> = (0..BATCH * STEP_WORDS).map(|word| word / STEP_WORDS).collect();
        gpu.queue.write_buffer(&steps, 0, bytemuck::cast_slice(&indices));
        let found = adjacency::build(&gpu, mesh, &triangles, &twins, &frontier).await?;
        if gpu.ends_loops_early && found.most_corners > SHORT_STAR {
            let corners = found.most_corners;
            return refuse(format!("a vertex has {corners} triangles, {} ends loops early", gpu.adapter));
        }

        // Meshes with components of both windings or vertices of several fans are rare: the host has time.
        let winding = Winding::of_triangles(mesh);
        let on_host = if winding.is_none() || found.has_several_fans {
            let encoder = gpu.device.create_command_encoder(&Default::default());
            gpu.submit_and_read(encoder, &twins, 3 * count).await?
        } else {
            Vec::new()
        };
        let winding = winding.unwrap_or_else(|| Winding::of_components(mesh, &on_host));
        let fans = if found.has_several_fans {
            Fans::new(mesh.vertex_count(), mesh.triangles(), &on_host)
        } else {
            Fans::default()
        };
        let words = [winding.clockwise.as_slice(), fans.table.as_slice()].concat();
        refuse_large_buffer(&gpu, words.len())?;
        let topology = storage("topology", words.len());
        gpu.queue.write_buffer(&topology, 0, bytemuck::cast_slice(&words));

        let whole = [&positions, &triangles, &twins, &choices, &frontier, &history, &topology];
        let mut buffers = vec![(&uniform, None), (&steps, Some(4))];
        buffers.extend(whole.map(|buffer| (buffer, None)));
        let bindings = gpu.bind(&gpu.phases.layout, &buffers);
        let (mantissa, shift) = cosine_fraction(cos);
        let square = u128::from(mantissa) * u128::from(mantissa);
        let params = Params {
            dimension: mesh.dimension().stride() as u32,
            vertices: mesh.vertex_count() as u32,
            triangles: count as u32,
            first: 0,
            fans: winding.clockwise.len() as u32,
            fans_length: fans.table.len() as u32,
            winding_length: winding.clockwise.len() as u32,
            tail: 0,
            cos: cos as f32,
            cos_sign: if cos == 0.0 { 0 } else { cos.signum() as i32 },
            cos_shift: 2 * shift,
            tail_iterations: 0,
            tail_length: if gpu.ends_loops_early { SHORT_TAIL_LENGTH } else { TAIL_LENGTH },
            // A flip appends six triangles at most; a small mesh is not worth a sweep.
            list_below: if count <= SMALL_MESH { u32::MAX } else { count as u32 / 24 },
            padding: [0; 2],
            cos_square: [0, 32, 64, 96].map(|bits| (square >> bits) as u32),
        };
        let mut result = Self {
            params,
            counts: found.counts,
            bindings,
            uniform,
            steps,
            positions,
            triangles,
            twins,
            choices,
            frontier,
            history,
            topology,
            state: [count as u32, 0, 0, 1],
            dispatches: found.dispatches,
            gpu,
        };
        if mesh.dimension() == Dimension::Three && count > 0 {
            let half_edges = 3 * result.params.triangles;
            let groups = result.gpu.workgroups(half_edges);
            let encoder = result.encode(|pass| result.dispatch(pass, Kernel::FlagCreases, groups));
            result.gpu.queue.submit([encoder.finish()]);
            result.dispatches += 1;
        }
        result.gpu.check()?;
        Ok(result)
    }

    /// One submission of up to `count` iterations; returns the flips of those that ran, the last of which may
    /// be zero.
    async fn submit(&mut self, count: u32) -> Result<Vec<u32>, Error> {
        let batch = count.min(BATCH);
        self.params.tail = batch;
        self.params.tail_iterations =
            (count - batch).min(if self.gpu.ends_loops_early { SHORT_TAIL } else { TAIL });
        self.begin_history();
        let encoder = self.encode(|pass| {
            let groups = self.gpu.workgroups(self.params.triangles);
            for step in 0..batch {
                pass.set_bind_group(0, &self.bindings, &[4 * step * STEP_WORDS]);
                for kernel in [Kernel::Label, Kernel::Select, Kernel::Flip] {
                    self.dispatch(pass, kernel, groups);
                }
            }
            if self.params.tail_iterations > 0 {
                self.dispatch(pass, Kernel::Tail, 1);
            }
        });
        self.dispatches += u64::from(3 * batch + self.params.tail_iterations.min(1));
        self.read_history(encoder).await
    }

    /// Writes the state as the first entry, and zeros behind it.
    fn begin_history(&self) {
        let mut history = [0u32; HISTORY_WORDS];
        history[ENTRIES..ENTRIES + ENTRY_WORDS].copy_from_slice(&self.state);
        self.gpu.queue.write_buffer(&self.history, 0, bytemuck::cast_slice(&history));
    }

    /// Submits the commands, takes over the last state and returns the flips of the iterations that ran.
    async fn read_history(&mut self, encoder: wgpu::CommandEncoder) -> Result<Vec<u32>, Error> {
        let history = self.gpu.submit_and_read(encoder, &self.history, HISTORY_WORDS).await?;
        let entries = history[ENTRIES..].chunks_exact(ENTRY_WORDS).skip(1);
        let ran: Vec<&[u32]> = entries.take_while(|entry| entry[3] == 1).collect();
        if let Some(last) = ran.last() {
            self.state.copy_from_slice(last);
        }
        self.params.first += ran.len() as u32;
        Ok(ran.iter().map(|entry| entry[0]).collect())
    }

    /// Commands in one compute pass, with the parameters as they are now and the first step bound.
    fn encode(&self, record: impl FnOnce(&mut wgpu::ComputePass)) -> wgpu::CommandEncoder {
        self.gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&self.params));
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_bind_group(0, &self.bindings, &[0]);
        record(&mut pass);
        drop(pass);
        encoder
    }

    fn dispatch(&self, pass: &mut wgpu::ComputePass, kernel: Kernel, workgroups: u32) {
        pass.set_pipeline(&self.gpu.phases.pipelines[kernel as usize]);
        pass.dispatch_workgroups(workgroups, 1, 1);
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
        self.gpu.queue.write_buffer(&self.history, 0, bytemuck::cast_slice(&[0u32; ENTRIES]));
        let encoder = self.encode(|pass| {
            self.dispatch(pass, Kernel::Census, self.gpu.workgroups(3 * self.params.triangles));
        });
        self.dispatches += 1;
        let counts = self.gpu.submit_and_read(encoder, &self.history, ENTRIES).await?;
        let mut census = Census { labelled: counts[0], ..Census::default() };
        for (reason, count) in [Reason::Angle, Reason::Fold, Reason::Duplicate].into_iter().zip(&counts[1..])
        {
            census.blocked[reason] = u64::from(*count);
        }
        Ok(census)
    }

    async fn read(&self, buffer: &wgpu::Buffer, words: usize) -> Result<Vec<u32>, Error> {
        let encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.gpu.submit_and_read(encoder, buffer, words).await
    }
}

impl Engine for WebGpu {
    fn batch(&self) -> u32 {
        BATCH + TAIL
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        Box::pin(self.run(count))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(self.count())
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.read(&self.triangles, 3 * self.params.triangles as usize))
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.read(&self.twins, 3 * self.params.triangles as usize))
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

    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn shared_objects(&self) -> Option<SharedObjects> {
        Some(SharedObjects {
            device: self.gpu.device.as_webgpu()?.into(),
            positions: self.positions.as_webgpu()?.into(),
            triangles: self.triangles.as_webgpu()?.into(),
        })
    }
}

impl Drop for WebGpu {
    /// In a browser the garbage collector would take its time.
    fn drop(&mut self) {
        let Self {
            uniform, steps, positions, triangles, twins, choices, frontier, history, topology, ..
        } = self;
        for buffer in [uniform, steps, positions, triangles, twins, choices, frontier, history, topology] {
            buffer.destroy();
        }
    }
}

/// One phase at a time, for the tests.
#[cfg(test)]
impl WebGpu {
    /// Runs one phase of the next iteration; after the flips, which end it, returns their number.
    pub(crate) async fn run_phase(&mut self, kernel: Kernel) -> Result<u32, Error> {
        if kernel == Kernel::Label {
            self.begin_history();
        }
        let groups = self.gpu.workgroups(self.params.triangles);
        let encoder = self.encode(|pass| self.dispatch(pass, kernel, groups));
        Ok(self.read_history(encoder).await?.last().copied().unwrap_or(0))
    }

    /// Lists from the start and sweeps in between, whatever the size of the mesh.
    pub(crate) fn set_list_below(&mut self, flips: u32) {
        self.params.list_below = flips;
    }

    /// `best` and `selected`.
    pub(crate) async fn choices(&self) -> Result<(Vec<u32>, Vec<u32>), Error> {
        let mut best = self.read(&self.choices, 2 * self.params.triangles as usize).await?;
        let selected = best.split_off(self.params.triangles as usize);
        Ok((best, selected))
    }

    pub(crate) async fn fans(&self) -> Result<Vec<u32>, Error> {
        let words = (self.params.fans + self.params.fans_length) as usize;
        Ok(self.read(&self.topology, words).await?.split_off(self.params.fans as usize))
    }
}
