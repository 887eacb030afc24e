//! Reads every mesh file in the given folders, makes it Delaunay on the CPU and on the GPU, compares the results,
//! audits them, and prints a table: `npm run corpus`.

use edgeflip::io::{self, Format, ReadOptions};
use edgeflip::quality::{angles, audit};
use edgeflip::{Backend, Error, Mesh, Options, Outcome, make_delaunay};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Parts of the paths of malformed files: a parser should refuse these files.
const MALFORMED: [&str; 8] = [
    "/models/invalid/",
    "/SchemaFailures/",
    "/wrongTypes/badArray",
    "/IndexOutOfRange/",
    "/MissingBin/",
    "/BoxWithInfinites",
    "/OFF/invalid.off",
    "/OBJ/number_formats.obj",
];

/// The folder of files in glTF 1.0, a different format.
const OTHER_FORMAT: &str = "/models/glTF/";

/// The outcome for a file.
enum Row {
    /// `only_cpu` says why the GPU refused the mesh. That is no fault.
    Done {
        cells: String,
        only_cpu: Option<String>,
        faults: Vec<String>,
    },
    Refused(Error),
}

fn main() -> ExitCode {
    let folders: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let mut files = Vec::new();
    folders.iter().for_each(|folder| collect(folder, &mut files));
    files.sort();
    println!(
        "| file | triangles | non-manifold | inconsistent | flips | iterations | left | smallest angle | mean smallest angle | CPU = GPU, audit |"
    );
    println!("|---|---:|---:|---:|---:|---:|---|---|---|---|");
    let (mut on_cpu, mut wrong) = (0, 0);
    let mut refused: [Vec<String>; 3] = Default::default();
    for file in &files {
        let name = folders.iter().find_map(|folder| file.strip_prefix(folder).ok()).unwrap_or(file).display();
        match row(file) {
            Row::Done { cells, only_cpu, faults } => {
                wrong += usize::from(!faults.is_empty());
                on_cpu += usize::from(only_cpu.is_some());
                let clean = only_cpu.map_or("yes, clean".into(), |why| format!("CPU alone, clean: {why}"));
                let faults = if faults.is_empty() { clean } else { faults.join("; ") };
                println!("| {name} | {cells} | {faults} |");
            }
            Row::Refused(error) => {
                let path = file.to_string_lossy();
                let is_malformed = MALFORMED.iter().any(|part| path.contains(part));
                let kind = if path.contains(OTHER_FORMAT) { 2 } else { usize::from(is_malformed) };
                refused[kind].push(format!("{name}: {error}"));
            }
        }
    }
    let [others, malformed, version_1] = &refused;
    let counted = files.len() - malformed.len() - version_1.len();
    let percent = 100.0 * others.len() as f64 / counted.max(1) as f64;
    println!(
        "\n{} files; of {counted} {} refused ({percent:.1} %), {on_cpu} on the CPU alone, {wrong} wrong",
        files.len(),
        others.len()
    );
    others.iter().for_each(|line| println!("- {line}"));
    println!("\nMade to be refused: {}; in glTF 1.0: {}", malformed.len(), version_1.len());
    malformed.iter().chain(version_1).for_each(|line| println!("- {line}"));
    ExitCode::from(u8::from(wrong > 0))
}

/// Collects the files below a folder that have the extension of a format.
fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if let Ok(entries) = fs::read_dir(path) {
        entries.flatten().for_each(|entry| collect(&entry.path(), files));
    } else if Format::of(path).is_ok() {
        files.push(path.to_path_buf());
    }
}

fn row(file: &Path) -> Row {
    let mesh = match io::read(file, &ReadOptions { external_files: true, ..ReadOptions::default() }) {
        Ok(mesh) => mesh,
        Err(error) => return Row::Refused(error),
    };
    let run = |backend| {
        let options = Options { backend, ..Options::default() };
        make_delaunay(&mesh, &options, |_, _| ControlFlow::Continue(()))
    };
    let outcome = match run(Backend::Cpu) {
        Ok(outcome) => outcome,
        Err(error) => return Row::Refused(error),
    };
    let (mut only_cpu, mut faults) = (None, Vec::new());
    match run(Backend::Gpu) {
        Ok(gpu)
            if gpu.triangles == outcome.triangles
                && gpu.remaining == outcome.remaining
                && [gpu.inverted, gpu.flat] == [outcome.inverted, outcome.flat] => {}
        Ok(_) => faults.push("the GPU's result differs".to_owned()),
        Err(Error::BackendLimit { message, .. }) => only_cpu = Some(message),
        Err(error) => faults.push(error.to_string()),
    }
    let audit = audit(&mesh, &outcome.triangles, &Options::default());
    faults.extend(audit.violations.iter().map(ToString::to_string));
    if audit.remaining != outcome.remaining {
        faults.push(format!("the audit counts {:?}", audit.remaining));
    }
    let areas = [audit.inverted.len(), audit.flat.len()];
    if areas != [outcome.inverted, outcome.flat].map(|count| count as usize) {
        faults.push(format!("the audit counts {areas:?} inverted and flat triangles"));
    }
    Row::Done { cells: cells(&mesh, &outcome), only_cpu, faults }
}

fn cells(mesh: &Mesh, outcome: &Outcome) -> String {
    let left: Vec<String> =
        outcome.remaining.iter().map(|(reason, count)| format!("{} {count}", reason.name())).collect();
    let before = angles(mesh, 1);
    let after = mesh.with_triangles(outcome.triangles.clone()).map(|mesh| angles(&mesh, 1));
    let [min, mean] = match &after {
        Ok(after) => [(before.min, after.min), (before.mean_min, after.mean_min)],
        Err(_) => [(before.min, f64::NAN), (before.mean_min, f64::NAN)],
    }
    .map(|(before, after)| format!("{before:.3}° → {after:.3}°"));
    format!(
        "{} | {} | {} | {} | {} | {} | {min} | {mean}",
        mesh.triangle_count(),
        outcome.non_manifold_edges,
        outcome.inconsistent_edges,
        outcome.flips,
        outcome.iterations,
        if left.is_empty() { "–".to_owned() } else { left.join(", ") },
    )
}
