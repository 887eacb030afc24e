//! The GPU, measured and checked: every result is audited and compared with the CPU's, triangle by triangle.
//! `cargo bench --bench gpu -- [--runs N] [FAMILY…]`, for example `-- "uvsphere 600" "random 1000"`.
//!
//! The program needs nothing beside it but a GPU driver: build it with `cargo bench --bench gpu --no-run`, copy
//! it to the machine with the GPU and run it there. `EDGEFLIP_COMMIT`, when it is built or when it is run, says
//! of which commit it is; without it, git is asked where it runs.

use edgeflip::{Backend, Mesh, Options, Outcome, Reasons, families, make_delaunay, quality};
use std::{error::Error, ops::ControlFlow, process::Command};

#[path = "arguments/mod.rs"]
mod arguments;
use arguments::{Arguments, median};

/// The paper's mesh 5, far from Delaunay, large, long runs, ties, and nearly collinear points.
const MESHES: [&str; 9] = [
    "uvsphere 600",
    "random 1000",
    "shear 1000",
    "random 3000",
    "shear 4000",
    "uvsphere 3000",
    "sweep 1000000",
    "regular 2000",
    "fan2 1000",
];

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &MESHES)?;
    // Makes the device too, which no measured run shall pay for.
    let first = run(&families::by_name("random 10")?, Backend::Gpu)?;
    println!("adapter and driver: {}", first.adapter.as_deref().unwrap_or("unknown"));
    println!("commit: {}", commit());
    println!("medians of {runs} runs after one that is not counted; times as the caller sees them");
    println!();
    println!(
        "| mesh | edges | iterations | flips | adjacency ms | flips ms | total ms | dispatches | remaining | \
         same as CPU | audit |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---|---|---|");
    let mut wrong = 0;
    for spec in specs {
        let (row, is_right) =
            row(&spec, runs).unwrap_or_else(|error| (format!("| {spec} | {error} |"), false));
        println!("{row}");
        wrong += usize::from(!is_right);
    }
    if wrong > 0 {
        return Err(
            format!("{wrong} meshes failed, or differ from the CPU's result, or from the audit's").into()
        );
    }
    Ok(())
}

/// The mesh's line of the table, and whether all its results are right.
fn row(spec: &str, runs: usize) -> Result<(String, bool), edgeflip::Error> {
    let mesh = families::by_name(spec)?;
    let first = run(&mesh, Backend::Gpu)?;
    let (mut adjacency, mut flip, mut total) = (Vec::new(), Vec::new(), Vec::new());
    let mut differing_runs = 0;
    for _ in 0..runs {
        let outcome = run(&mesh, Backend::Gpu)?;
        adjacency.push(outcome.timings.adjacency);
        flip.push(outcome.timings.flip);
        total.push(outcome.timings.total);
        differing_runs += usize::from(outcome.triangles != first.triangles);
    }
    let cpu = run(&mesh, Backend::Cpu)?;
    let is_same = differing_runs == 0
        && first.triangles == cpu.triangles
        && first.flips_per_iteration == cpu.flips_per_iteration
        && first.remaining == cpu.remaining;
    let audit = quality::audit(&mesh, &first.triangles, Options::default().max_normal_angle, &[]);
    // The audit counts what remains by itself.
    let is_honest = audit.remaining == first.remaining;
    let verdict = match audit.violations.first() {
        Some(violation) => violation.to_string(),
        None if is_honest => "clean".to_owned(),
        None => format!("counts as remaining: {}", by_reason(audit.remaining)),
    };
    let line = format!(
        "| {spec} | {} | {} | {} | {:.2} | {:.2} | {:.2} | {} | {} | {} | {verdict} |",
        first.edges,
        first.iterations,
        first.flips,
        median(adjacency),
        median(flip),
        median(total),
        first.dispatches,
        by_reason(first.remaining),
        if is_same { "yes" } else { "NO" },
    );
    Ok((line, is_same && is_honest && audit.is_clean()))
}

/// `angle 12, fold 3`, or 0.
fn by_reason(remaining: Reasons) -> String {
    let words: Vec<String> = remaining.iter().map(|(reason, n)| format!("{} {n}", reason.name())).collect();
    if words.is_empty() { "0".to_owned() } else { words.join(", ") }
}

fn run(mesh: &Mesh, backend: Backend) -> Result<Outcome, edgeflip::Error> {
    let options = Options { backend, ..Options::default() };
    make_delaunay(mesh, &options, |_, _| ControlFlow::Continue(()))
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
