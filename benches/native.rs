//! Measures the phases and Lawson's algorithm on the CPU, on one thread and on all cores. In the plane, it also measures
//! crates that triangulate the same points from scratch on one thread. `cargo bench -p benches -- [--runs N] [FAMILY…]`,
//! for example `-- "random 300" "uvsphere 1000"`; a family is an argument of `edgeflip::families::by_name`.
//!
//! The runs are interleaved, so that a busy machine disturbs all of them equally; the figures are medians.

use benches::arguments::{Arguments, median};
use delaunator::Point;
use edgeflip::{Backend, Dimension, Mesh, Options, Order, Timings, families, make_delaunay};
use i_triangle::float::triangulatable::Triangulatable;
use peakmem_alloc::{PeakMemAlloc, PeakMemAllocTrait};
use spade::{DelaunayTriangulation, Point2, Triangulation};
use std::{
    alloc::System, error::Error, hint::black_box, num::NonZeroUsize, ops::ControlFlow, sync::Arc, thread,
    time::Instant,
};

#[global_allocator]
static ALLOCATOR: PeakMemAlloc<System> = PeakMemAlloc::system();

/// From 2,000 to 2,000,000 triangles, and twice as many flips.
const MESHES: [&str; 8] = [
    "random 33",
    "random 76",
    "random 179",
    "random 423",
    "random 1001",
    "shuffled random 1001",
    "shear 1000",
    "uvsphere 1000",
];

/// A whole job. Returns the times of its parts, which are 0 for other crates.
type Job<'a> = dyn Fn() -> Result<Timings, Box<dyn Error>> + 'a;

type Part = fn(&Timings) -> f64;

/// A measured algorithm. Its job holds the input in the form that it needs.
struct Contender<'a> {
    name: String,
    job: Box<Job<'a>>,
    timings: Vec<Timings>,
    ms: Vec<f64>,
    bytes: Vec<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &MESHES)?;
    println!(
        "On one thread unless the column says otherwise, from arrays to arrays, medians of {runs} interleaved runs."
    );
    println!(
        "Other crates triangulate the points from scratch; i_triangle gets the inner points and the corners of a grid."
    );
    println!(
        "Ratios are the time of the first divided by that of the second: above 1, the second is faster. Memory is the peak"
    );
    println!("in addition to the input.");
    let mut last = None;
    for spec in &specs {
        let [head, ruler, row] = table(spec, runs)?;
        if last.as_ref() != Some(&head) {
            println!("\n{head}\n{ruler}");
            last = Some(head);
        }
        println!("{row}");
    }
    Ok(())
}

/// The two lines of the table's head, and the line of the mesh.
fn table(spec: &str, runs: usize) -> Result<[String; 3], Box<dyn Error>> {
    let mesh = Arc::new(families::by_name(spec)?);
    let positions: Vec<f64> = mesh.positions().iter().collect();
    let size = positions.len() / mesh.vertex_count();
    let pairs: Vec<[f64; 2]> = positions.chunks_exact(size).map(|p| [p[0], p[1]]).collect();
    let points: Vec<Point> = pairs.iter().map(|&[x, y]| Point { x, y }).collect();
    let vertices: Vec<Point2<f64>> = pairs.iter().map(|&[x, y]| Point2::new(x, y)).collect();
    let n = mesh.vertex_count().isqrt();
    let is_plane = mesh.dimension() == Dimension::Two;
    let is_grid = is_plane && n * n == mesh.vertex_count() && !spec.starts_with("shuffled");
    let corners = [0, n - 1, n * n - 1, n * n - n].map(|i| pairs[i]);
    let is_inside = |i: usize| [i % n, i / n].iter().all(|k| (1..n - 1).contains(k));
    let inside: Vec<[f64; 2]> = (0..n * n).filter(|&i| is_inside(i)).map(|i| pairs[i]).collect();
    let one = NonZeroUsize::new(1);
    let edges = flip(&mesh, Order::Reproducible, one)?.0;
    let cores = thread::available_parallelism()?.get();
    let mut contenders = vec![
        contender("phases", || Ok(flip(&mesh, Order::Reproducible, one)?.1)),
        contender("Lawson", || Ok(flip(&mesh, Order::Any, one)?.1)),
        contender(&format!("phases on {cores} threads"), || Ok(flip(&mesh, Order::Reproducible, None)?.1)),
        contender(&format!("Lawson on {cores} threads"), || Ok(flip(&mesh, Order::Any, None)?.1)),
    ];
    if is_plane {
        contenders.push(contender("delaunator", || {
            black_box(delaunator::triangulate(black_box(&points)));
            Ok(Timings::default())
        }));
        contenders.push(contender("spade", || {
            black_box(DelaunayTriangulation::<_>::bulk_load(vertices.clone())?.num_vertices());
            Ok(Timings::default())
        }));
    }
    if is_grid {
        contenders.push(contender("i_triangle", || {
            let delaunay = corners.triangulate_with_steiner_points(&inside).into_delaunay();
            black_box(delaunay.to_triangulation::<u32>());
            Ok(Timings::default())
        }));
    }
    for _ in 0..runs {
        for contender in &mut contenders {
            measure(contender)?;
        }
    }
    let per_edge = |x: f64| x / f64::from(edges);
    let ns: Vec<f64> =
        contenders.iter().map(|contender| per_edge(median(contender.ms.clone()) * 1e6)).collect();
    let mut head = vec!["mesh".to_owned(), "edges".to_owned()];
    let mut row = vec![spec.to_owned(), edges.to_string()];
    let others = 4..contenders.len();
    for (our, others) in [(0, others.clone()), (1, others), (2, 0..1), (3, 1..2)] {
        for other in others {
            head.push(format!("{} : {}", contenders[other].name, contenders[our].name));
            row.push(format!("{:.2}", ns[other] / ns[our]));
        }
    }
    for (i, contender) in contenders.iter().enumerate() {
        head.push(format!("{}, ns an edge", contender.name));
        row.push(format!("{:.1}", ns[i]));
    }
    for Contender { name, timings, .. } in &contenders[..4] {
        let parts: [(&str, Part); 2] = [("adjacency", |t| t.adjacency), ("flips", |t| t.flip)];
        for (part, of) in parts {
            head.push(format!("{name}: {part}"));
            row.push(format!("{:.1}", per_edge(median(timings.iter().map(of).collect()) * 1e6)));
        }
    }
    for contender in &contenders {
        head.push(format!("{}, bytes an edge", contender.name));
        row.push(format!("{:.0}", per_edge(median(contender.bytes.clone()))));
    }
    let ruler = format!("|---|{}", "---:|".repeat(head.len() - 1));
    Ok([format!("| {} |", head.join(" | ")), ruler, format!("| {} |", row.join(" | "))])
}

fn contender<'a>(name: &str, job: impl Fn() -> Result<Timings, Box<dyn Error>> + 'a) -> Contender<'a> {
    Contender {
        name: name.to_owned(),
        job: Box::new(job),
        timings: Vec::new(),
        ms: Vec::new(),
        bytes: Vec::new(),
    }
}

fn measure(contender: &mut Contender) -> Result<(), Box<dyn Error>> {
    ALLOCATOR.reset_peak_memory();
    let start = Instant::now();
    let timings = (contender.job)()?;
    contender.ms.push(start.elapsed().as_secs_f64() * 1e3);
    contender.timings.push(timings);
    contender.bytes.push(ALLOCATOR.get_peak_memory() as f64);
    Ok(())
}

/// The number of edges, and the times of the parts.
fn flip(
    mesh: &Arc<Mesh>,
    order: Order,
    threads: Option<NonZeroUsize>,
) -> Result<(u32, Timings), edgeflip::Error> {
    let options = Options { backend: Backend::Cpu, order, threads, ..Options::default() };
    let outcome = make_delaunay(mesh.clone(), &options, |_, _| ControlFlow::Continue(()))?;
    Ok((outcome.edges as u32, black_box(outcome).timings))
}
