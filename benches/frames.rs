//! Measures meshes that move: in every frame a compute pass moves the vertices, and an update flips edges, up to 4
//! iterations; nothing is read back. `cargo bench -p benches --bench frames -- [--runs FRAMES] [FAMILY SPEED…]`; with
//! `EDGEFLIP_CHECK=1` it reads the positions of every frame, gives them to the CPU engine, and compares and audits
//! every 60th frame.
//!
//! GPU time is between timestamps before the motion and after the flips, wall time from the first frame to the last.

use benches::arguments::{Arguments, median};
use benches::warm_up::WarmUp;
use edgeflip::{
    Backend, Dimension, GpuBuffers, Mesh, Options, Session, families, make_delaunay, quality, wgpu,
};
use pollster::block_on;
use std::{collections::VecDeque, env, error::Error, ops::ControlFlow, sync::Arc, time::Instant};

#[path = "../examples/motion/mod.rs"]
mod motion;
use motion::{Motion, Moving};

const ITERATIONS: u32 = 4;

/// The most frames that the host is ahead of the GPU, as in a program that draws them.
const AHEAD: usize = 3;

/// Each mesh, and radians of the wave per frame; or, in percent, the longest steps of a random walk, for the family random
/// relative to its spacing.
const MOTIONS: [&str; 10] = [
    "random 71:0.02",
    "random 224:0.02",
    "random 708:0.0002",
    "random 708:0.02",
    "random 708:0.1",
    "random 708:1.0",
    "random 708:5%",
    "random 708:20%",
    "random 2237:0.02",
    "uvsphere 700:0.02",
];

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(600, &MOTIONS)?;
    let frames = u32::try_from(runs)?;
    let checks = env::var_os("EDGEFLIP_CHECK").is_some();
    let gpu = motion::open()?;
    let mut warm_up = WarmUp::new()?;
    println!("adapter: {}, {} {}", gpu.adapter.name, gpu.adapter.driver, gpu.adapter.driver_info);
    println!("{frames} frames, {ITERATIONS} iterations each{}", if checks { ", checked" } else { "" });
    println!();
    println!(
        "| mesh | speed | triangles | flips a frame | % of edges | GPU ms a frame, median | with `untangle: false` | mean | wall ms a frame | \
         left at the end | turned over | a whole job from arrays, ms | checked |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|");
    for spec in &specs {
        let (name, speed) = spec.split_once(':').ok_or("write FAMILY:SPEED")?;
        let mesh = Arc::new(families::by_name(name)?);
        let motion = match (speed.strip_suffix('%'), mesh.dimension()) {
            (Some(percent), _) => {
                Motion::Walk { step: 0.01 * percent.parse::<f32>()? / (mesh.vertex_count() as f32).sqrt() }
            }
            (None, Dimension::Two) => Motion::Wave { speed: speed.parse()?, number: 30.0, height: 0.0133 },
            (None, Dimension::Three) => Motion::Wave { speed: speed.parse()?, number: 6.0, height: 0.1 },
        };
        let mut moving = Moving::new(&gpu, &mesh, motion, None)?;
        let row = if checks {
            check(&mut moving, &mesh, frames)?
        } else {
            measure(&mut moving, frames, &mut warm_up)?
        };
        let flips_alone = if checks || mesh.dimension() == Dimension::Three {
            "–".to_owned()
        } else {
            measure(&mut Moving::new(&gpu, &mesh, motion, Some(false))?, frames, &mut warm_up)?.gpu_median
        };
        let counters = block_on(moving.session.counters())?;
        let edges = 1.5 * mesh.triangle_count() as f64;
        let flips = counters.flips as f64 / counters.updates as f64;
        println!(
            "| {name} | {speed} | {} | {flips:.0} | {:.3} | {} | {flips_alone} | {} | {} | {} | {} | {:.2} | {} |",
            mesh.triangle_count(),
            100.0 * flips / edges,
            row.gpu_median,
            row.gpu_mean,
            row.wall,
            counters.remaining.total(),
            counters.inverted,
            whole_job(&moving, &mesh)?,
            row.checked,
        );
    }
    Ok(())
}

struct Row {
    gpu_median: String,
    gpu_mean: String,
    wall: String,
    checked: String,
}

fn measure(moving: &mut Moving, frames: u32, warm_up: &mut WarmUp) -> Result<Row, Box<dyn Error>> {
    let options = Options { backend: Backend::Gpu, ..Options::default() };
    warm_up.before(|mesh| make_delaunay(mesh.clone(), &options, |_, _| ControlFlow::Continue(())))?;
    // The mesh is in motion.
    for frame in 0..60 {
        moving.frame(frame, ITERATIONS, |_| (), |_| ())?;
    }
    moving.wait()?;
    let (device, queue) = (moving.gpu.device.clone(), moving.gpu.queue.clone());
    let inside = wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    let queries = device.features().contains(inside).then(|| {
        let count = 2 * frames;
        let ty = wgpu::QueryType::Timestamp;
        device.create_query_set(&wgpu::QuerySetDescriptor { label: None, ty, count })
    });
    let mut submitted = VecDeque::new();
    let start = Instant::now();
    for frame in 0..frames {
        if submitted.len() == AHEAD {
            let submission_index = submitted.pop_front();
            device.poll(wgpu::PollType::Wait { submission_index, timeout: None })?;
        }
        let stamp = |index| {
            let queries = queries.as_ref();
            move |encoder: &mut wgpu::CommandEncoder| {
                if let Some(queries) = queries {
                    encoder.write_timestamp(queries, index);
                }
            }
        };
        moving.frame(60 + frame, ITERATIONS, stamp(2 * frame), stamp(2 * frame + 1))?;
        submitted.push_back(queue.submit([]));
    }
    moving.wait()?;
    let wall = start.elapsed().as_secs_f64() * 1e3 / f64::from(frames);
    let mut times = Vec::new();
    if let Some(queries) = &queries {
        let size = 16 * u64::from(frames);
        let usage = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        let buffer = device.create_buffer(&descriptor);
        let mut encoder = device.create_command_encoder(&Default::default());
        encoder.resolve_query_set(queries, 0..2 * frames, &buffer, 0);
        queue.submit([encoder.finish()]);
        let words = read(&moving.gpu, &buffer)?;
        let ticks: Vec<u64> =
            words.chunks_exact(2).map(|pair| u64::from(pair[0]) | u64::from(pair[1]) << 32).collect();
        let period = f64::from(queue.get_timestamp_period()) / 1e6;
        times = ticks.chunks_exact(2).map(|pair| (pair[1] - pair[0]) as f64 * period).collect();
    }
    let mean = times.iter().sum::<f64>() / times.len() as f64;
    Ok(Row {
        gpu_median: format!("{:.3}", median(times)),
        gpu_mean: format!("{mean:.3}"),
        wall: format!("{wall:.3}"),
        checked: "–".to_owned(),
    })
}

/// Gives the positions of each frame to the CPU engine.
fn check(moving: &mut Moving, mesh: &Arc<Mesh>, frames: u32) -> Result<Row, Box<dyn Error>> {
    let options = Options { backend: Backend::Cpu, ..Options::default() };
    let mut cpu = block_on(Session::new(mesh.clone(), options.clone()))?;
    block_on(cpu.run(|_, _| ControlFlow::Continue(())))?;
    let mut compared = 0;
    for frame in 0..=frames {
        let last = if frame % 60 == 0 { read(&moving.gpu, &moving.gpu.triangles)? } else { Vec::new() };
        moving.frame(frame, ITERATIONS, |_| (), |_| ())?;
        let words = read(&moving.gpu, &moving.gpu.positions)?;
        let positions: Vec<f32> =
            words.into_iter().take(mesh.positions().len()).map(f32::from_bits).collect();
        cpu.update(Some(positions.clone().into()), ITERATIONS)?;
        if frame % 60 > 0 {
            continue;
        }
        let triangles = read(&moving.gpu, &moving.gpu.triangles)?;
        if triangles != block_on(cpu.triangles())? {
            return Err(format!("frame {frame}: the GPU differs from the CPU").into());
        }
        let (found, expected) = (block_on(moving.session.counters())?, block_on(cpu.counters())?);
        if found != expected {
            return Err(format!("frame {frame}: the GPU counts {found:?}, the CPU {expected:?}").into());
        }
        let before = Mesh::new(mesh.dimension(), positions, last)?;
        let audit = quality::audit(&before, &triangles, &options);
        if !audit.violations.is_empty() {
            return Err(format!("frame {frame}: {:?}", audit.violations.first()).into());
        }
        if audit.remaining.total() != found.remaining.total() {
            return Err(format!("frame {frame}: the audit finds {:?}, not {found:?}", audit.remaining).into());
        }
        compared += 1;
    }
    let none = || "–".to_owned();
    let checked = format!("{compared} frames clean, as the CPU");
    Ok(Row { gpu_median: none(), gpu_mean: none(), wall: none(), checked })
}

/// The time of a new session for the present positions and triangles, from arrays to arrays; the faster of two.
fn whole_job(moving: &Moving, mesh: &Mesh) -> Result<f64, Box<dyn Error>> {
    let words = read(&moving.gpu, &moving.gpu.positions)?;
    let positions: Vec<f32> = words.into_iter().take(mesh.positions().len()).map(f32::from_bits).collect();
    let mesh = Arc::new(Mesh::new(mesh.dimension(), positions, read(&moving.gpu, &moving.gpu.triangles)?)?);
    let options = Options { backend: Backend::Gpu, ..Options::default() };
    let mut best = f64::INFINITY;
    for _ in 0..2 {
        let start = Instant::now();
        make_delaunay(mesh.clone(), &options, |_, _| ControlFlow::Continue(()))?;
        best = best.min(start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(best)
}

/// The words of a buffer.
fn read(gpu: &GpuBuffers, buffer: &wgpu::Buffer) -> Result<Vec<u32>, Box<dyn Error>> {
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: buffer.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
    gpu.queue.submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |_| ());
    gpu.device.poll(wgpu::PollType::wait_indefinitely())?;
    let view = staging.get_mapped_range(..)?;
    Ok(view
        .chunks_exact(4)
        .map(|bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
        .collect())
}
