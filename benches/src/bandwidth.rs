//! How close a time is to the limit of the device: the fewest bytes that the work can move, and what that is of the
//! bandwidth.

use edgeflip::{Backend, Dimension, Mesh, Options, Outcome, Session, families, wgpu};
use pollster::block_on;
use std::error::Error;
use std::time::Instant;

/// Bytes of the buffers of the measurement: as many as every device binds, and more than caches hold.
const SIZE: u64 = 1 << 27;
const COPIES: u32 = 16;

/// A kernel copies faster than the command that copies buffers.
const COPY: &str = "
    @group(0) @binding(0) var<storage, read> source: array<vec4u>;
    @group(0) @binding(1) var<storage, read_write> copy: array<vec4u>;
    @compute @workgroup_size(256) fn main(@builtin(global_invocation_id) id: vec3u) { copy[id.x] = source[id.x]; }
";

/// Bytes that the device reads and writes in a second while it copies: the best of several measurements.
pub fn of_device() -> Result<f64, Box<dyn Error>> {
    let options = Options { backend: Backend::Gpu, ..Options::default() };
    let session = block_on(Session::new(families::by_name("random 10")?, options))?;
    let gpu = session.gpu().ok_or("the session has no buffers on a device")?;
    let usage = wgpu::BufferUsages::STORAGE;
    let descriptor = wgpu::BufferDescriptor { label: None, size: SIZE, usage, mapped_at_creation: false };
    let [source, copy] = [0, 1].map(|_| gpu.device.create_buffer(&descriptor));
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(COPY.into()),
    });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    });
    let bindings = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: source.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: copy.as_entire_binding() },
        ],
    });
    let mut best = f64::INFINITY;
    // The first ones raise the clock rate.
    for _ in 0..20 {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        for _ in 0..COPIES {
            pass.dispatch_workgroups((SIZE / (16 * 256)) as u32, 1, 1);
        }
        drop(pass);
        let start = Instant::now();
        gpu.queue.submit([encoder.finish()]);
        gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    Ok(2.0 * f64::from(COPIES) * SIZE as f64 / best)
}

/// The fewest bytes that each part of the work moves.
pub struct Fewest {
    /// From the host: positions and triangles.
    pub upload: f64,
    /// Reads the triangles, writes the twins.
    pub adjacency: f64,
    /// Reads every triangle with its twins once, and every position; each flip writes two vertices and ten twins.
    pub flips: f64,
    /// From the host and back.
    pub total: f64,
}

impl Fewest {
    /// For the work on a mesh that ended with this outcome.
    pub fn of(mesh: &Mesh, outcome: &Outcome) -> Self {
        let axes = match mesh.dimension() {
            Dimension::Two => 2.0,
            Dimension::Three => 3.0,
        };
        let (positions, triangles) =
            (4.0 * axes * mesh.vertex_count() as f64, 12.0 * mesh.triangle_count() as f64);
        Self {
            upload: positions + triangles,
            adjacency: 2.0 * triangles,
            flips: positions + 2.0 * triangles + 48.0 * outcome.flips as f64,
            total: positions + 2.0 * triangles,
        }
    }
}

/// A time with its bytes, and with their share of a bandwidth in bytes per second.
pub fn with_share(ms: f64, bytes: f64, bandwidth: f64) -> String {
    format!("{ms:.2} ({:.0} MB, {:.0} %)", bytes / 1e6, 100.0 * bytes / (ms / 1e3) / bandwidth)
}

/// A time with its bytes, and how many of them it moves in a second.
pub fn with_rate(ms: f64, bytes: f64) -> String {
    format!("{ms:.2} ({:.0} MB, {:.1} GB/s)", bytes / 1e6, bytes / ms / 1e6)
}
