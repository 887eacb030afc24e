//! Measures meshes with many iterations or many flips. The time must grow with the flips, not with iterations times the
//! size of the mesh. `cargo bench -p benches --bench worst_cases -- [--runs N] [FAMILY…]`

use benches::arguments::{Arguments, median};
use benches::warm_up::WarmUp;
use edgeflip::{Backend, Mesh, Options, Outcome, families, make_delaunay};
use std::{error::Error, num::NonZeroUsize, ops::ControlFlow, sync::Arc};

/// Strips take n²/4 flips in n iterations. Sweep triangulations of random points take about ten flips per point.
const MESHES: [&str; 4] = ["strips 1000", "strips 4000", "sweep 100000", "sweep 1000000"];

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(3, &MESHES)?;
    println!("The iterations alone, the CPU on one thread; medians of {runs} runs after an uncounted run.");
    println!();
    println!(
        "| mesh | edges | iterations | flips | CPU ns a flip | GPU ns a flip | CPU ms | GPU ms | same result |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---|");
    let mut are_same = true;
    for spec in &specs {
        let mesh = Arc::new(families::by_name(spec)?);
        let (cpu, cpu_ms) = measure(&mesh, Backend::Cpu, runs)?;
        let (gpu, gpu_ms) = measure(&mesh, Backend::Gpu, runs)?;
        let is_same = cpu.triangles == gpu.triangles && cpu.flips_per_iteration == gpu.flips_per_iteration;
        let each = |ms: f64| ms * 1e6 / cpu.flips as f64;
        println!(
            "| {spec} | {} | {} | {} | {:.1} | {:.1} | {cpu_ms:.1} | {gpu_ms:.1} | {} |",
            cpu.edges,
            cpu.iterations,
            cpu.flips,
            each(cpu_ms),
            each(gpu_ms),
            if is_same { "yes" } else { "NO" },
        );
        are_same &= is_same;
    }
    if are_same { Ok(()) } else { Err("the GPU's result differs from the CPU's".into()) }
}

/// The result of the first run, and the median time of the iterations of the others.
fn measure(mesh: &Arc<Mesh>, backend: Backend, runs: usize) -> Result<(Outcome, f64), edgeflip::Error> {
    let options = Options { backend, threads: NonZeroUsize::new(1), ..Options::default() };
    let run = |mesh: &Arc<Mesh>| make_delaunay(mesh.clone(), &options, |_, _| ControlFlow::Continue(()));
    let first = run(mesh)?;
    let mut warm_up = WarmUp::new()?;
    let mut times = Vec::new();
    for _ in 0..runs {
        if backend == Backend::Gpu {
            warm_up.before(run)?;
        }
        times.push(run(mesh)?.timings.flip);
    }
    Ok((first, median(times)))
}
