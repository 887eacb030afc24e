//! Measures the GPU, audits every result, and compares it with the CPU's, triangle by triangle.
//! `cargo bench -p benches --bench gpu -- [--runs N] [FAMILY…]`, for example `-- "uvsphere 600" "random 1000"`.
//!
//! The program needs only a GPU driver: build it with `cargo bench -p benches --bench gpu --no-run`, copy it to the
//! machine with the GPU and run it there. Set `EDGEFLIP_COMMIT` to the commit when you build or run it; otherwise the
//! program asks git.

use benches::arguments::{Arguments, median};
use benches::bandwidth::{self, Fewest, with_rate, with_share};
use benches::clock::Clock;
use benches::commit::commit;
use benches::warm_up::WarmUp;
use edgeflip::{Backend, Mesh, Options, Outcome, Reasons, families, make_delaunay, quality};
use std::{error::Error, ops::ControlFlow, sync::Arc};

/// Mesh 5 of the paper; meshes far from Delaunay; large meshes; long runs; ties; nearly collinear points; the same mesh
/// in order and in random order.
const MESHES: [&str; 13] = [
    "uvsphere 600",
    "random 1000",
    "shear 1000",
    "random 3000",
    "shear 4000",
    "uvsphere 3000",
    "sweep 1000000",
    "regular 2000",
    "fan2 1000",
    "strips 1000",
    "random 2000",
    "shuffled random 2000",
    "shuffled uvsphere 600",
];

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &MESHES)?;
    let opened = run(&Arc::new(families::by_name("random 10")?), Backend::Gpu, || ())?;
    println!("adapter and driver: {}", opened.adapter.as_deref().unwrap_or("unknown"));
    println!("commit: {}", commit());
    let bandwidth = bandwidth::of_device()?;
    println!("bandwidth of a kernel that copies: {:.0} GB/s", bandwidth / 1e9);
    println!(
        "in brackets: the fewest bytes that the work moves, and their share of this bandwidth or their rate"
    );
    println!(
        "medians of {runs} runs; other runs raise the clock rate before each; times as the caller sees them"
    );
    println!();
    println!(
        "| mesh | edges | iterations | flips | upload ms | adjacency ms | flips ms | total ms | bytes a triangle | dispatches | clock MHz | remaining | \
         same as CPU | audit |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|---|---|");
    let clock = Clock::watch();
    let mut wrong = 0;
    for spec in &specs {
        let (row, is_right) = row(spec, runs, &clock, bandwidth)
            .unwrap_or_else(|error| (format!("| {spec} | {error} |"), false));
        println!("{row}");
        wrong += usize::from(!is_right);
    }
    if wrong > 0 { Err(format!("{wrong} meshes failed, or have a wrong result").into()) } else { Ok(()) }
}

/// The mesh's line of the table, and whether all its results are correct.
fn row(spec: &str, runs: usize, clock: &Clock, bandwidth: f64) -> Result<(String, bool), edgeflip::Error> {
    let mesh = Arc::new(families::by_name(spec)?);
    let cpu = run(&mesh, Backend::Cpu, || ())?;
    let first = run(&mesh, Backend::Gpu, || ())?;
    let mut warm_up = WarmUp::new()?;
    let [mut upload, mut adjacency, mut flip, mut total, mut clocks] = [const { Vec::new() }; 5];
    let mut differing_runs = 0;
    for _ in 0..runs {
        warm_up.before(|mesh| run(mesh, Backend::Gpu, || ()))?;
        let mut mhz = 0;
        let outcome = run(&mesh, Backend::Gpu, || mhz = clock.mhz())?;
        upload.push(outcome.timings.upload);
        adjacency.push(outcome.timings.adjacency);
        flip.push(outcome.timings.flip);
        total.push(outcome.timings.total);
        clocks.push(f64::from(mhz));
        differing_runs += usize::from(outcome.triangles != first.triangles);
    }
    let is_same = differing_runs == 0
        && first.triangles == cpu.triangles
        && first.flips_per_iteration == cpu.flips_per_iteration
        && first.remaining == cpu.remaining
        && [first.inverted, first.flat] == [cpu.inverted, cpu.flat];
    let audit = quality::audit(&mesh, &first.triangles, &Options::default());
    // The audit counts the remaining edges independently.
    let is_honest = audit.remaining == first.remaining;
    let verdict = match audit.violations.first() {
        Some(violation) => violation.to_string(),
        None if is_honest => "clean".to_owned(),
        None => format!("counts as remaining: {}", by_reason(audit.remaining)),
    };
    let clock = median(clocks);
    let fewest = Fewest::of(&mesh, &first);
    let line = format!(
        "| {spec} | {} | {} | {} | {} | {} | {} | {} | {:.1} | {} | {} | {} | {} | {verdict} |",
        first.edges,
        first.iterations,
        first.flips,
        with_rate(median(upload), fewest.upload),
        with_share(median(adjacency), fewest.adjacency, bandwidth),
        with_share(median(flip), fewest.flips, bandwidth),
        with_rate(median(total), fewest.total),
        first.device_bytes as f64 / mesh.triangle_count() as f64,
        first.dispatches,
        if clock > 0.0 { clock.to_string() } else { "–".to_owned() },
        by_reason(first.remaining),
        if is_same { "yes" } else { "NO" },
    );
    Ok((line, is_same && is_honest && audit.violations.is_empty()))
}

/// `angle 12, fold 3`, or 0.
fn by_reason(remaining: Reasons) -> String {
    let words: Vec<String> = remaining.iter().map(|(reason, n)| format!("{} {n}", reason.name())).collect();
    if words.is_empty() { "0".to_owned() } else { words.join(", ") }
}

/// `watch` is called after every batch of iterations; the last call is after all flips, before the triangles are read
/// back.
fn run(mesh: &Arc<Mesh>, backend: Backend, mut watch: impl FnMut()) -> Result<Outcome, edgeflip::Error> {
    let options = Options { backend, ..Options::default() };
    make_delaunay(mesh.clone(), &options, |_, _| {
        watch();
        ControlFlow::Continue(())
    })
}
