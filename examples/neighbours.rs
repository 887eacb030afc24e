//! The neighbours of each point within a radius, found on the GPU by walks over a triangulation that stays Delaunay
//! while a vortex stirs its points. `cargo run --release --example neighbours [SIDE] [FRAMES]`

use edgeflip::wgpu::{self, BufferUsages};
use edgeflip::{Backend, Dimension, GpuBuffers, Mesh, Options, Reason, Session, families};
use pollster::block_on;
use std::{env, error::Error, ops::ControlFlow};

/// The kernels, without the radius and `neighbours.wgsl`.
const SHADER: &str = "
@group(0) @binding(0) var<storage, read_write> positions: array<vec2f>;
@group(0) @binding(1) var<storage, read> indices: array<u32>;
@group(0) @binding(2) var<storage, read> twins: array<u32>;
@group(0) @binding(3) var<storage, read> half_edges: array<u32>;
@group(0) @binding(4) var<storage, read_write> counts: array<u32>;

fn place(v: u32) -> vec2f {
    return positions[v];
}

// Moves each point of the unit square along a vortex that leaves its boundary where it is.
@compute @workgroup_size(64)
fn stir(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&positions) {
        let half = sin(3.14159265 * positions[id.x]);
        let whole = sin(6.2831853 * positions[id.x]);
        positions[id.x] += 0.2 * RADIUS * half * half * whole.yx * vec2f(1, -1);
    }
}

// Counts the neighbours of each point.
@compute @workgroup_size(64)
fn count(@builtin(global_invocation_id) id: vec3u) {
    if id.x < arrayLength(&positions) {
        let points = search(id.x);
        var neighbours = select(0u, NONE, points > MOST);
        for (var i = 1u; i < min(points, MOST); i++) {
            neighbours += u32(is_near(place(found[i]) - place(id.x)));
        }
        counts[id.x] = neighbours;
    }
}
";

fn main() -> Result<(), Box<dyn Error>> {
    let number = |index, default: u32| env::args().nth(index).map_or(Ok(default), |word| word.parse());
    println!("{}", run(number(1, 100)?, number(2, 60)?)?);
    Ok(())
}

/// Stirs `side` times `side` points, and compares the neighbours in the last frame with a search among all points.
/// Returns a line about them.
pub fn run(side: u32, frames: u32) -> Result<String, Box<dyn Error>> {
    let grid = families::grid(side as usize, 1)?;
    let width = 1.0 - 1.0 / side as f32;
    let unit = grid.positions().to_f32().iter().map(|x| x / width).collect::<Vec<_>>();
    let mesh = Mesh::new(Dimension::Two, unit, grid.triangles().to_vec())?;
    let options = Options { backend: Backend::Gpu, adjacency: true, ..Options::default() };
    let mut session = block_on(Session::new(&mesh, options))?;
    block_on(session.run(|_, _| ControlFlow::Continue(())))?;
    let gpu = session.gpu().ok_or("the session is not on a GPU")?;
    let radius = 2.0 / side as f32;
    let search = Search::new(&gpu, mesh.vertex_count() as u32, radius)?;
    for _ in 0..frames {
        search.submit(&gpu, &search.stir);
        session.update(None, 16)?;
    }
    search.submit(&gpu, &search.count);

    let counts = read(&gpu, &search.counts)?;
    let points: Vec<f32> = read(&gpu, &gpu.positions)?.into_iter().map(f32::from_bits).collect();
    let wrong =
        points.chunks(2).zip(&counts).filter(|(p, count)| **count != among_all(&points, p, radius)).count();
    let counters = block_on(session.counters())?;
    Ok(format!(
        "{} points, {:.2} neighbours on average, at most {}, {wrong} counts wrong; {} flips, {} edges left to flip",
        counts.len(),
        counts.iter().sum::<u32>() as f32 / counts.len() as f32,
        counts.iter().max().unwrap_or(&0),
        counters.flips,
        counters.remaining[Reason::Stopped]
    ))
}

/// Counts the neighbours of a point, with the rule of `is_near` in `neighbours.wgsl`.
fn among_all(points: &[f32], point: &[f32], radius: f32) -> u32 {
    let whole = |x: f32, y: f32| ((x - y) * (16384.0 / radius)) as i64;
    let is_near = |p: &&[f32]| {
        let [x, y] = [whole(p[0], point[0]), whole(p[1], point[1])];
        x * x + y * y <= 1 << 28
    };
    // The point is near itself.
    points.chunks(2).filter(is_near).count() as u32 - 1
}

/// The two kernels, with the buffers of a session.
struct Search {
    stir: wgpu::ComputePipeline,
    count: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    counts: wgpu::Buffer,
}

impl Search {
    fn new(gpu: &GpuBuffers, points: u32, radius: f32) -> Result<Self, Box<dyn Error>> {
        let text = format!("const RADIUS: f32 = {radius:?};\n{SHADER}{}", include_str!("neighbours.wgsl"));
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("neighbours"),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let entry = |binding: u32| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: (1..4).contains(&binding) },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[0, 1, 2, 3, 4].map(entry),
        });
        let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let [stir, count] = ["stir", "count"].map(|name| {
            gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(name),
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(name),
                compilation_options: Default::default(),
                cache: None,
            })
        });
        let counts = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("counts"),
            size: 4 * u64::from(points),
            usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let (Some(twins), Some(half_edges)) = (&gpu.twins, &gpu.vertex_half_edges) else {
            return Err("the session gives no adjacency".into());
        };
        let buffers = [&gpu.positions, &gpu.triangles, twins, half_edges, &counts];
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries };
        let bindings = gpu.device.create_bind_group(&descriptor);
        Ok(Self { stir, count, bindings, counts })
    }

    /// Submits a kernel for all points.
    fn submit(&self, gpu: &GpuBuffers, kernel: &wgpu::ComputePipeline) {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(kernel);
            pass.set_bind_group(0, &self.bindings, &[]);
            pass.dispatch_workgroups((self.counts.size() as u32 / 4).div_ceil(64), 1, 1);
        }
        gpu.queue.submit([encoder.finish()]);
    }
}

/// The words of a buffer.
fn read(gpu: &GpuBuffers, buffer: &wgpu::Buffer) -> Result<Vec<u32>, Box<dyn Error>> {
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: buffer.size(),
        usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
    gpu.queue.submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |_| ());
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    let view = staging.get_mapped_range(..)?;
    Ok(view.as_chunks().0.iter().map(|&bytes| u32::from_le_bytes(bytes)).collect())
}
