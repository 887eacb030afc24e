//! The parity matrix: meshes by engines, every cell equal to the simulation after every iteration.
//!
//! This test makes the columns of the native engines. `EDGEFLIP_PARITY=FILE` writes these columns, the meshes and the
//! expected results to a file. `tests/parity/matrix.mjs` reads the file and adds the columns of the engines in
//! browsers. The compiled test reads no file: with `--nocapture` it prints its columns on any machine that has a GPU.
#![cfg(feature = "gpu")]

use crate::matrix;
use crate::meshes::Case;
use crate::runs::{options, unwatched, watched};
use crate::simulation::{Digest, Expected, Simulation, expected};
use edgeflip::quality::audit;
use edgeflip::{Backend, Error, Outcome, Positions, Reasons, Status};
use serde_json::{Value, json};
use std::time::Instant;

/// Meshes whose coordinates span more bits than the GPU engines decide.
const REFUSED_BY_GPUS: [&str; 6] = [
    "magnitudes",
    "magnitudes-3d",
    "f64-magnitudes",
    "f64-magnitudes-3d",
    "f64-magnitudes-mixed",
    "f64-magnitudes-mixed-3d",
];

/// A mesh, and what every engine must give.
type Simulated = (&'static Case, &'static Simulation);

struct Column {
    title: String,
    cells: Vec<&'static str>,
    /// A line for each cell that is `WRONG`.
    wrong: Vec<String>,
    seconds: f64,
}

impl Column {
    fn run(backend: Backend, cases: &[Simulated]) -> Self {
        let start = Instant::now();
        let title = title(&unwatched(&cases[0].0.mesh, &options(backend, 0.0)).unwrap());
        let mut wrong = Vec::new();
        let mut judge = |&(case, want): &Simulated| {
            cell(backend, case, want).unwrap_or_else(|why| {
                wrong.push(format!("{title}: {} at β = {}: {why}", case.name, case.beta));
                "WRONG"
            })
        };
        let cells = cases.iter().map(&mut judge).collect();
        Self { title, cells, wrong, seconds: start.elapsed().as_secs_f64() }
    }
}

fn title(outcome: &Outcome) -> String {
    match outcome.adapter.as_deref() {
        None => "CPU native".to_owned(),
        Some(adapter) if adapter.starts_with("llvmpipe") => "WebGPU lavapipe".to_owned(),
        Some(adapter) => format!("WebGPU {adapter}"),
    }
}

/// Runs the mesh one iteration at a time, and again to the end in batches.
fn cell(backend: Backend, case: &Case, want: &Simulation) -> Result<&'static str, String> {
    let options = case.options(backend);
    let is_refused = backend == Backend::Gpu && REFUSED_BY_GPUS.contains(&case.name.as_str());
    let run = match watched(&case.mesh, &options) {
        Err(Error::BackendLimit { .. }) if is_refused => return Ok("refused"),
        Ok(_) if is_refused => return Err("was not refused".to_owned()),
        run => run.map_err(|error| error.to_string())?,
    };
    for index in 0..run.iterations.len().max(want.iterations.len()) {
        let (found, wanted) = (run.iterations.get(index), want.iterations.get(index));
        if found != wanted {
            return Err(format!("iteration {index} is {found:?}, not {wanted:?}"));
        }
    }
    if run != *want {
        return Err("the triangles before the first iteration or the remaining edges are wrong".to_owned());
    }
    let whole = unwatched(&case.mesh, &options).map_err(|error| error.to_string())?;
    compare_end(backend, &whole, want, areas(case, want)).map(|()| "=")
}

/// The inverted and the flat triangles of the end, as the audit counts them.
fn areas(case: &Case, want: &Simulation) -> [u32; 2] {
    let audit = audit(&case.mesh, &want.triangles, &case.options(Backend::Cpu));
    [audit.inverted, audit.flat].map(|list| list.len() as u32)
}

fn compare_end(
    backend: Backend,
    outcome: &Outcome,
    want: &Simulation,
    areas: [u32; 2],
) -> Result<(), String> {
    let flips: Vec<u32> = want.iterations.iter().map(|record| record.flips).collect();
    let on_gpu = outcome.adapter.is_some() && outcome.dispatches > 0;
    let as_wanted = [
        ("engine", on_gpu == (backend == Backend::Gpu)),
        ("status", outcome.status == Status::Done),
        ("flips of an iteration", outcome.flips_per_iteration == flips),
        ("triangles", outcome.triangles == want.triangles),
        ("remaining edges", outcome.remaining == want.remaining),
        ("inverted and flat triangles", [outcome.inverted, outcome.flat] == areas),
    ];
    as_wanted.iter().try_for_each(|(what, is)| {
        if *is { Ok(()) } else { Err(format!("the whole run has the wrong {what}")) }
    })
}

/// The table in Markdown, line by line.
fn table(cases: &[Simulated], columns: &[Column]) -> Vec<String> {
    let titles: String = columns.iter().map(|column| format!(" {} |", column.title)).collect();
    let mut lines = vec![
        format!("| mesh | β | triangles | iterations |{titles}"),
        format!("|---|---:|---:|---:|{}", "---|".repeat(columns.len())),
    ];
    for (row, (Case { name, beta, mesh, .. }, want)) in cases.iter().enumerate() {
        let cells: String = columns.iter().map(|column| format!(" {} |", column.cells[row])).collect();
        let (triangles, iterations) = (mesh.triangle_count(), want.iterations.len());
        lines.push(format!("| {name} | {beta} | {triangles} | {iterations} |{cells}"));
    }
    lines
}

/// A mesh and its expected results, as JSON. Positions are the 32-bit words of f32 or f64.
fn exported(&(case, want): &Simulated) -> Value {
    let reasons = |reasons: &Reasons| -> Value { reasons.iter().map(|(r, n)| (r.name(), n)).collect() };
    let [inverted, flat] = areas(case, want);
    let mut end = Digest::default();
    end.feed(&want.triangles);
    let words = |x: f64| [x.to_bits() as u32, (x.to_bits() >> 32) as u32];
    let (is_wide, positions) = match case.mesh.positions() {
        Positions::F32(numbers) => (false, numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>()),
        Positions::F64(numbers) => (true, numbers.iter().copied().flat_map(words).collect()),
    };
    let iterations = want.iterations.iter().map(|record| {
        json!({
            "labelled": record.labelled,
            "flips": record.flips,
            "blocked": reasons(&record.blocked),
            "digest": record.digest.to_string(),
        })
    });
    json!({
        "name": case.name,
        "beta": case.beta,
        "deviation": case.deviation.is_finite().then_some(case.deviation),
        "locked": case.locked.concat(),
        "dimension": case.mesh.dimension().stride(),
        "isRefusedByGpus": REFUSED_BY_GPUS.contains(&case.name.as_str()),
        "isWide": is_wide,
        "positions": positions,
        "indices": case.mesh.triangles(),
        "iterations": iterations.collect::<Vec<_>>(),
        "end": end.to_string(),
        "remaining": reasons(&want.remaining),
        "inverted": inverted,
        "flat": flat,
    })
}

#[test]
fn engines_give_what_the_simulation_does() {
    let cases: Vec<_> = matrix::simulated().collect();
    for ((case, run), line) in cases.iter().zip(expected()) {
        assert_eq!(Expected::new(&case.name, case.beta, run), line, "digests.txt has something else");
    }
    let columns = [Backend::Cpu, Backend::Gpu].map(|backend| Column::run(backend, &cases));
    let table = table(&cases, &columns);
    let seconds: Vec<_> =
        columns.iter().map(|column| format!("{}: {:.1} s", column.title, column.seconds)).collect();
    println!("{}\n\n{}", table.join("\n"), seconds.join(", "));
    if let Some(file) = std::env::var_os("EDGEFLIP_PARITY") {
        let cases: Vec<_> = cases.iter().map(exported).collect();
        let text = json!({ "cases": cases, "table": table, "seconds": seconds }).to_string();
        std::fs::write(file, text).unwrap();
    }
    let wrong: Vec<_> = columns.iter().flat_map(|column| &column.wrong).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    for column in &columns {
        let equal = column.cells.iter().filter(|&&cell| cell == "=").count();
        assert!(equal >= 40, "{}: only {equal} after every iteration", column.title);
    }
}
