//! Measures what the paper measures, for `npm run paper`, and prints one JSON document. `cargo bench -p benches
//! --bench paper -- [--runs N] [SIZE…]`, where a size is `small`, `large` or both; without one it is `small`, and on a
//! hardware GPU both. `large`: meshes of up to 50 million edges.
//!
//! The program needs only a GPU driver: build it with `--no-run`, copy it to the machine with the GPU and run it there.

use benches::arguments::{Arguments, median};
use benches::commit::commit;
use benches::surfaces;
use benches::warm_up::WarmUp;
use edgeflip::{
    Backend, Error as MeshError, Mesh, Options, Order, Outcome, families, make_delaunay, quality,
};
use edgeflip::{Positions, select_on_cpu};
use serde_json::{Value, json};
use std::{
    error::Error,
    fs,
    num::NonZeroUsize,
    ops::ControlFlow,
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

/// The meshes of the paper's Table 2: the number, what it is, and β in degrees. With β of 10° no edge of so coarse a
/// mesh as the first two would flip.
const PAPER: [(&str, &str, f64); 5] = [
    ("1", "double torus of 3 × 5 and 4 × 5 vertices", 90.0),
    ("2", "double torus of 25 × 25 and 24 × 25 vertices", 30.0),
    ("3", "uvsphere 100", 10.0),
    ("4", "torus of 145 × 162 vertices with 6,152 holes", 10.0),
    ("5", "uvsphere 600", 10.0),
];
/// Larger spheres: 3, 12, 27 and 50 million edges.
const LARGE: [&str; 4] = ["uvsphere 1000", "uvsphere 2000", "uvsphere 3000", "uvsphere 4083"];
/// The worst case of figures 11 and 12.
const STRIPS: [&str; 4] = ["strips 8", "strips 12", "strips 16", "strips 1000"];
/// Points a side of the meshes for the size from which on the GPU is faster.
const SIDES: [usize; 14] = [10, 14, 20, 28, 40, 56, 80, 113, 160, 226, 320, 640, 1000, 2000];
/// On a software GPU.
const FEW_SIDES: usize = 9;

/// The time in which further runs of a mesh begin. A first run that takes longer is the only one, and counts.
const ENOUGH: Duration = Duration::from_secs(10);
/// The same on a software GPU.
const ENOUGH_FOR_SOFTWARE: Duration = Duration::from_secs(2);

/// A way to run a mesh.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Gpu,
    /// Selection on the CPU.
    Baseline,
    /// One thread.
    Cpu,
    /// One thread, Lawson's algorithm.
    Lawson,
    /// All cores.
    Cores,
}

/// Runs meshes; keeps the clock of a hardware GPU high.
struct Bench {
    runs: usize,
    enough: Duration,
    warm_up: Option<WarmUp>,
}

/// The outcome of the first run, and medians in milliseconds: from arrays to arrays, and of the flips.
struct Measured {
    outcome: Outcome,
    runs: usize,
    total: f64,
    flips: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &["auto"])?;
    let opened = once(&families::by_name("random 10")?.into(), Way::Gpu, 10.0)?.0;
    let adapter = opened.adapter.unwrap_or_default();
    let is_software = ["llvmpipe", "SwiftShader", "Basic Render"].iter().any(|name| adapter.contains(name));
    let is_large = specs.iter().any(|spec| spec == "large") || (specs == ["auto"] && !is_software);
    let enough = if is_software { ENOUGH_FOR_SOFTWARE } else { ENOUGH };
    let mut bench = Bench { runs, enough, warm_up: if is_software { None } else { Some(WarmUp::new()?) } };

    let mut meshes = Vec::new();
    for (id, name, beta) in PAPER {
        let mesh = match id {
            "1" => surfaces::mesh_1(),
            "2" => surfaces::mesh_2(),
            "4" => surfaces::mesh_4(),
            _ => families::by_name(name),
        };
        meshes.push(bench.compare(id, name, mesh?, beta)?);
    }
    for name in LARGE.iter().take(if is_large { LARGE.len() } else { 0 }) {
        meshes.push(bench.compare("", name, families::by_name(name)?, 10.0)?);
    }
    let strips = STRIPS.map(|name| {
        let (outcome, _) = once(&families::by_name(name)?.into(), Way::Cpu, 10.0)?;
        Ok::<_, MeshError>(json!({ "name": name, "flips": outcome.flips_per_iteration }))
    });
    let sides = if is_software { &SIDES[..FEW_SIDES] } else { &SIDES };
    let crossover = bench.crossover(sides)?;
    let document = json!({
        "commit": commit(),
        "machine": {
            "cpu": cpu_name(),
            "threads": thread::available_parallelism().map_or(1, NonZeroUsize::get),
            "adapter": adapter,
            "software": is_software,
        },
        "runs": runs,
        "enough_s": enough.as_secs(),
        "meshes": meshes,
        "strips": strips.into_iter().collect::<Result<Vec<_>, _>>()?,
        "figure11": figure_11()?,
        "crossover": crossover,
    });
    println!("{}", serde_json::to_string(&document)?);
    Ok(())
}

impl Bench {
    /// Runs a mesh in each way, and audits the results.
    fn compare(&mut self, id: &str, name: &str, mesh: Mesh, beta: f64) -> Result<Value, Box<dyn Error>> {
        let mesh = Arc::new(mesh);
        let [gpu, baseline, cpu, lawson] =
            [Way::Gpu, Way::Baseline, Way::Cpu, Way::Lawson].map(|way| self.measure(&mesh, way, beta));
        let (gpu, baseline, cpu, lawson) = (gpu?, baseline?, cpu?, lawson?);
        let found = &gpu.outcome;
        if found.triangles != cpu.outcome.triangles {
            return Err(format!("{name}: the GPU differs from the CPU").into());
        }
        let audit = |measured: &Measured| {
            let audit = quality::audit(&mesh, &measured.outcome.triangles, &options(Way::Gpu, beta));
            let is_honest = audit.remaining == measured.outcome.remaining;
            let miscounted = (!is_honest).then(|| "the remaining edges are miscounted".to_owned());
            audit.violations.first().map(ToString::to_string).or(miscounted)
        };
        if let Some(fault) = audit(&gpu) {
            return Err(format!("{name}: {fault}").into());
        }
        let mut of_baseline = baseline.json();
        of_baseline["fault"] = audit(&baseline).into();
        eprintln!("{name}: {} edges, GPU {:.2} ms, CPU {:.2} ms", found.edges, gpu.total, cpu.total);
        Ok(json!({
            "id": id,
            "name": name,
            "beta": beta,
            "vertices": mesh.vertex_count(),
            "edges": found.edges,
            "triangles": mesh.triangle_count(),
            "boundary": found.boundary_edges,
            "iterations": found.iterations,
            "flips": found.flips,
            "remaining": found.remaining.total(),
            "flips_per_iteration": found.flips_per_iteration,
            "gpu": gpu.json(),
            "baseline": of_baseline,
            "cpu": cpu.json(),
            "lawson": lawson.json(),
        }))
    }

    /// The times of meshes of growing size with many flips, few and none.
    fn crossover(&mut self, sides: &[usize]) -> Result<Vec<Value>, Box<dyn Error>> {
        let mut rows = Vec::new();
        for family in ["random", "uvsphere", "delaunay"] {
            for side in sides {
                let spec = format!("{} {side}", if family == "delaunay" { "random" } else { family });
                let mut mesh = Arc::new(families::by_name(&spec)?);
                if family == "delaunay" {
                    mesh = Arc::new(mesh.with_triangles(once(&mesh, Way::Cores, 10.0)?.0.triangles)?);
                }
                let gpu = self.measure(&mesh, Way::Gpu, 10.0)?;
                let [cpu, cores] = [Way::Cpu, Way::Cores].map(|way| self.measure(&mesh, way, 10.0));
                let (edges, flips) = (gpu.outcome.edges, gpu.outcome.flips);
                let (cpu, cores) = (cpu?.total, cores?.total);
                rows.push(json!({
                    "family": family, "edges": edges, "flips": flips,
                    "gpu": gpu.total, "cpu": cpu, "cores": cores,
                }));
            }
            eprintln!("{family}: {} sizes", sides.len());
        }
        Ok(rows)
    }

    /// The first run does not count, unless it takes too long for another one.
    fn measure(&mut self, mesh: &Arc<Mesh>, way: Way, beta: f64) -> Result<Measured, MeshError> {
        let (outcome, total) = once(mesh, way, beta)?;
        if total > self.enough.as_secs_f64() * 1e3 {
            let flips = outcome.timings.flip;
            return Ok(Measured { outcome, runs: 1, total, flips });
        }
        let (mut totals, mut flips) = (Vec::new(), Vec::new());
        let begun = Instant::now();
        while totals.len() < self.runs && (totals.is_empty() || begun.elapsed() < self.enough) {
            if let (Way::Gpu | Way::Baseline, Some(warm_up)) = (way, &mut self.warm_up) {
                warm_up.before(|mesh| once(mesh, Way::Gpu, 10.0))?;
            }
            let (outcome, ms) = once(mesh, way, beta)?;
            totals.push(ms);
            flips.push(outcome.timings.flip);
        }
        Ok(Measured { outcome, runs: totals.len(), total: median(totals), flips: median(flips) })
    }
}

impl Measured {
    fn json(&self) -> Value {
        let iterations = self.outcome.iterations;
        json!({ "iterations": iterations, "total": self.total, "flips": self.flips, "runs": self.runs })
    }
}

/// Runs a mesh. Returns the outcome, and the milliseconds from arrays to arrays.
fn once(mesh: &Arc<Mesh>, way: Way, beta: f64) -> Result<(Outcome, f64), MeshError> {
    select_on_cpu(way == Way::Baseline);
    let (dimension, positions, triangles): (_, Positions, _) =
        (mesh.dimension(), mesh.positions().clone(), mesh.triangles().to_vec());
    let start = Instant::now();
    let mesh = Mesh::new(dimension, positions, triangles)?;
    let outcome = make_delaunay(mesh, &options(way, beta), |_, _| ControlFlow::Continue(()))?;
    Ok((outcome, start.elapsed().as_secs_f64() * 1e3))
}

fn options(way: Way, beta: f64) -> Options {
    let is_gpu = matches!(way, Way::Gpu | Way::Baseline);
    Options {
        backend: if is_gpu { Backend::Gpu } else { Backend::Cpu },
        order: if way == Way::Lawson { Order::Any } else { Order::Reproducible },
        threads: if way == Way::Cores { None } else { NonZeroUsize::new(1) },
        max_normal_angle: beta,
        ..Options::default()
    }
}

/// The worst case with 8 nodes, before each iteration and at the end.
fn figure_11() -> Result<Value, MeshError> {
    let mesh = families::by_name("strips 8")?;
    let mut states = vec![mesh.triangles().to_vec()];
    loop {
        let most = Some(states.len() as u32);
        let options = Options { max_iterations: most, ..options(Way::Cpu, 10.0) };
        let outcome = make_delaunay(&mesh, &options, |_, _| ControlFlow::Continue(()))?;
        if outcome.iterations < states.len() as u32 {
            return Ok(json!({ "positions": mesh.positions().to_f32().to_vec(), "triangles": states }));
        }
        states.push(outcome.triangles);
    }
}

fn cpu_name() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with("model name"));
    line.and_then(|line| line.split_once(": ")).map_or("unknown", |(_, name)| name).trim().to_owned()
}
