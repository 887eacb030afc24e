//! The GPU, measured and checked: every result is audited and compared with the CPU's, triangle by triangle.
//! `cargo bench --bench gpu -- [--runs N] [FAMILY…]`, for example `-- "uvsphere 600" "random 1000"`.
//!
//! The program needs nothing beside it but a GPU driver: build it with `cargo bench --bench gpu --no-run`, copy
//! it to the machine with the GPU and run it there. `EDGEFLIP_COMMIT`, when it is built or when it is run, says
//! of which commit it is; without it, git is asked where it runs.

use edgeflip::{Backend, Mesh, Options, Outcome, Reasons, families, make_delaunay, quality};
use std::{
    error::Error,
    ops::ControlFlow,
    process::Command,
    sync::Arc,
    time::{Duration, Instant},
};

#[path = "arguments/mod.rs"]
mod arguments;
use arguments::{Arguments, median};

/// The paper's mesh 5, far from Delaunay, large, long runs, ties, and nearly collinear points.
const MESHES: [&str; 10] = [
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
];

/// A GPU raises its clock once it is busy.
const WARM_UP: Duration = Duration::from_secs(1);

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &MESHES)?;
    let [spec] = &specs[..] else { return one_by_one(runs, &specs) };
    let (adapter, row, is_right) = row(spec, runs)?;
    println!("adapter and driver: {adapter}");
    println!("commit: {}", commit());
    println!("medians of {runs} runs after others for a second; times as the caller sees them");
    println!();
    println!(
        "| mesh | edges | iterations | flips | upload ms | adjacency ms | flips ms | total ms | bytes a triangle | dispatches | clock MHz | remaining | \
         same as CPU | audit |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|---|---|");
    println!("{row}");
    if is_right { Ok(()) } else { Err("a result is not the CPU's, or not what the audit says".into()) }
}

/// Each mesh in a process of its own: a GPU that has waited for the host for some seconds lowers its clock, and
/// raises it for a new device.
fn one_by_one(runs: usize, specs: &[String]) -> Result<(), Box<dyn Error>> {
    let mut wrong = 0;
    for (i, spec) in specs.iter().enumerate() {
        let output =
            Command::new(std::env::current_exe()?).args(["--runs", &runs.to_string(), spec]).output()?;
        let text = String::from_utf8_lossy(&output.stdout);
        match text.lines().last() {
            Some(_) if i == 0 => print!("{text}"),
            Some(row) => println!("{row}"),
            None => println!("| {spec} | {} |", String::from_utf8_lossy(&output.stderr).trim()),
        }
        wrong += usize::from(!output.status.success());
    }
    if wrong > 0 { Err(format!("{wrong} meshes failed, or have a wrong result").into()) } else { Ok(()) }
}

/// The adapter, the mesh's line of the table, and whether all its results are right.
fn row(spec: &str, runs: usize) -> Result<(String, String, bool), edgeflip::Error> {
    let mesh = Arc::new(families::by_name(spec)?);
    let cpu = run(&mesh, Backend::Cpu)?;
    // Makes the device, and compiles for it.
    let first = run(&mesh, Backend::Gpu)?;
    let start = Instant::now();
    while start.elapsed() < WARM_UP {
        run(&mesh, Backend::Gpu)?;
    }
    let [mut upload, mut adjacency, mut flip, mut total] = [const { Vec::new() }; 4];
    let mut differing_runs = 0;
    for _ in 0..runs {
        let outcome = run(&mesh, Backend::Gpu)?;
        upload.push(outcome.timings.upload);
        adjacency.push(outcome.timings.adjacency);
        flip.push(outcome.timings.flip);
        total.push(outcome.timings.total);
        differing_runs += usize::from(outcome.triangles != first.triangles);
    }
    let clock = clock();
    let is_same = differing_runs == 0
        && first.triangles == cpu.triangles
        && first.flips_per_iteration == cpu.flips_per_iteration
        && first.remaining == cpu.remaining;
    let audit = quality::audit(&mesh, &first.triangles, &Options::default());
    // The audit counts what remains by itself.
    let is_honest = audit.remaining == first.remaining;
    let verdict = match audit.violations.first() {
        Some(violation) => violation.to_string(),
        None if is_honest => "clean".to_owned(),
        None => format!("counts as remaining: {}", by_reason(audit.remaining)),
    };
    let line = format!(
        "| {spec} | {} | {} | {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.1} | {} | {clock} | {} | {} | {verdict} |",
        first.edges,
        first.iterations,
        first.flips,
        median(upload),
        median(adjacency),
        median(flip),
        median(total),
        first.device_bytes as f64 / mesh.triangle_count() as f64,
        first.dispatches,
        by_reason(first.remaining),
        if is_same { "yes" } else { "NO" },
    );
    let adapter = first.adapter.unwrap_or_else(|| "unknown".to_owned());
    Ok((adapter, line, is_same && is_honest && audit.is_clean()))
}

/// The clock of the first NVIDIA GPU as it is now; where there is no such thing, a dash.
fn clock() -> String {
    let query = ["--query-gpu=clocks.sm", "--format=csv,noheader,nounits"];
    let output =
        Command::new("nvidia-smi").args(query).output().ok().filter(|output| output.status.success());
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().next().map_or("–", str::trim).to_owned()
}

/// `angle 12, fold 3`, or 0.
fn by_reason(remaining: Reasons) -> String {
    let words: Vec<String> = remaining.iter().map(|(reason, n)| format!("{} {n}", reason.name())).collect();
    if words.is_empty() { "0".to_owned() } else { words.join(", ") }
}

fn run(mesh: &Arc<Mesh>, backend: Backend) -> Result<Outcome, edgeflip::Error> {
    let options = Options { backend, ..Options::default() };
    make_delaunay(mesh.clone(), &options, |_, _| ControlFlow::Continue(()))
}

/// The commit this was built from, as far as anyone knows.
fn commit() -> String {
    let named = std::env::var("EDGEFLIP_COMMIT").ok().or(option_env!("EDGEFLIP_COMMIT").map(str::to_owned));
    let asked = || {
        let git = Command::new("git").args(["describe", "--always", "--dirty"]).output().ok()?;
        git.status.success().then(|| String::from_utf8_lossy(&git.stdout).trim().to_owned())
    };
    named.or_else(asked).unwrap_or_else(|| "unknown".to_owned())
}
