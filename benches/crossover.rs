//! Finds the size from which on the GPU is faster than the CPU, and checks the choice of `auto`:
//! `cargo bench -p benches --bench crossover -- [--runs N] [FAMILY…]`, with the meshes of a family from small to large.
//! `benches/crossover.html` does the same in a browser.
//!
//! The program needs only a GPU driver: build it with `cargo bench -p benches --bench crossover --no-run`, copy it to the
//! machine with the GPU and run it there.

use benches::arguments::{Arguments, median};
use benches::rule::{is_late, verdict};
use edgeflip::{Backend, Mesh, Options, Outcome, families, make_delaunay};
use std::{
    error::Error,
    ops::ControlFlow,
    time::{Duration, Instant},
};

/// About 200 to 20,000,000 triangles, with the same sizes in the plane and in space.
const MESHES: [&str; 20] = [
    "random 11",
    "random 20",
    "random 38",
    "random 73",
    "random 140",
    "random 269",
    "random 519",
    "random 1001",
    "random 2001",
    "random 3163",
    "uvsphere 10",
    "uvsphere 19",
    "uvsphere 37",
    "uvsphere 72",
    "uvsphere 139",
    "uvsphere 268",
    "uvsphere 518",
    "uvsphere 1000",
    "uvsphere 2000",
    "uvsphere 3162",
];

const ENGINES: [Backend; 3] = [Backend::Cpu, Backend::Gpu, Backend::Auto];

/// An engine that takes longer for a mesh skips the larger meshes of the family.
const SLOW: Duration = Duration::from_secs(5);
/// If an engine's first run of a mesh takes this many times as long as the fastest engine's, the engine runs the mesh
/// once.
const BEATEN: f64 = 10.0;
/// The time in which further runs of a mesh begin.
const ENOUGH: Duration = Duration::from_secs(5);

/// The times of one mesh.
struct Row {
    family: String,
    triangles: usize,
    /// Medians in milliseconds, in the order of [`ENGINES`]; `None` if the engine skipped the mesh.
    ms: [Option<f64>; 3],
    /// Whether `auto` took too long.
    is_late: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &MESHES)?;
    // Opens the device and compiles the kernels of both dimensions.
    run(families::by_name("random 10")?, Backend::Gpu)?;
    let opened = run(families::by_name("uvsphere 10")?, Backend::Gpu)?;
    println!("adapter and driver: {}", opened.adapter.as_deref().unwrap_or("unknown"));
    println!(
        "Milliseconds from host arrays to host arrays, medians of up to {runs} interleaved runs (one if that took {BEATEN} times the best); the device was open"
    );
    println!(
        "and its kernels compiled. –: skipped, because a smaller mesh took more than {} s.",
        SLOW.as_secs()
    );
    println!();
    println!("| mesh | triangles | runs | GPU : CPU | auto : best | CPU ms | GPU ms | auto ms | auto took |");
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---|");
    let mut rows: Vec<Row> = Vec::new();
    for spec in specs {
        let family = spec.split_whitespace().next().unwrap_or_default().to_owned();
        let smaller = rows.iter().rfind(|row| row.family == family);
        let is_slow = |ms: Option<f64>| ms.is_none_or(|ms| ms > SLOW.as_secs_f64() * 1e3);
        let skips = smaller.map_or([false; 3], |row| row.ms.map(is_slow));
        rows.push(measure(&spec, family, runs, skips)?);
    }
    println!();
    let late: Vec<String> = rows
        .iter()
        .filter(|row| row.is_late)
        .map(|row| format!("{} {}", row.family, row.triangles))
        .collect();
    println!("{}", verdict(&late));
    let mut families: Vec<&str> = rows.iter().map(|row| row.family.as_str()).collect();
    families.sort_unstable();
    families.dedup();
    for family in families {
        match crossover(rows.iter().filter(|row| row.family == family)) {
            Some(triangles) => println!("{family}: the GPU is faster from {triangles} triangles on."),
            None => println!("{family}: the GPU is not faster at the largest size."),
        }
    }
    Ok(())
}

/// Measures a mesh and prints its line. `skips`: the engines that skip it.
fn measure(spec: &str, family: String, runs: usize, skips: [bool; 3]) -> Result<Row, Box<dyn Error>> {
    let mesh = families::by_name(spec)?;
    let mut times = [const { Vec::new() }; 3];
    let mut took = "–";
    let mut begun = Instant::now();
    let mut left_out = skips;
    let mut rounds = 0;
    while rounds < runs && (rounds == 0 || begun.elapsed() < ENOUGH) {
        for (engine, times) in times.iter_mut().enumerate().filter(|&(engine, _)| !left_out[engine]) {
            let (positions, triangles) = (mesh.positions().clone(), mesh.triangles().to_vec());
            let start = Instant::now();
            took = run(Mesh::new(mesh.dimension(), positions, triangles)?, ENGINES[engine])?.backend.name();
            times.push(start.elapsed().as_secs_f64() * 1e3);
        }
        if rounds == 0 {
            let best = times.iter().filter_map(|times| times.first().copied()).fold(f64::INFINITY, f64::min);
            left_out = times.each_ref().map(|times| times.first().is_none_or(|&ms| ms > BEATEN * best));
            begun = Instant::now();
        }
        rounds += 1;
    }
    let ms = times.map(|times| (!times.is_empty()).then(|| median(times)));
    let cell = |number: Option<f64>| number.map_or("–".to_owned(), |number| format!("{number:.2}"));
    let [cpu, gpu, auto] = ms;
    let ratio = cell(cpu.zip(gpu).map(|(cpu, gpu)| gpu / cpu));
    let best = cpu.into_iter().chain(gpu).reduce(f64::min);
    let to_best = cell(auto.zip(best).map(|(auto, best)| auto / best));
    let is_late = auto.zip(best).is_some_and(|(auto, best)| is_late(auto, best));
    let triangles = mesh.triangle_count();
    let [cpu, gpu, auto] = ms.map(cell);
    println!("| {spec} | {triangles} | {rounds} | {ratio} | {to_best} | {cpu} | {gpu} | {auto} | {took} |");
    Ok(Row { family, triangles, ms, is_late })
}

/// The number of triangles from which on the GPU is faster at every size that both engines ran; `None` if the CPU is
/// faster at the largest.
fn crossover<'a>(rows: impl DoubleEndedIterator<Item = &'a Row>) -> Option<usize> {
    let compared = rows.rev().filter_map(|row| match row.ms {
        [Some(cpu), Some(gpu), _] => Some((row.triangles, gpu < cpu)),
        _ => None,
    });
    compared.take_while(|&(_, is_faster)| is_faster).last().map(|(triangles, _)| triangles)
}

fn run(mesh: Mesh, backend: Backend) -> Result<Outcome, edgeflip::Error> {
    let options = Options { backend, ..Options::default() };
    make_delaunay(mesh, &options, |_, _| ControlFlow::Continue(()))
}
