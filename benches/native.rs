//! One thread of the CPU: the phases and Lawson's algorithm beside the crate `delaunator`, which triangulates
//! the same points from scratch. `cargo bench --bench native -- [--runs N] [FAMILY…]`, a family being what
//! `edgeflip::families::by_name` takes, in the plane: `cargo bench --bench native -- "random 300"`.
//!
//! The runs are interleaved, so that a busy machine disturbs all of them alike; the figures are medians.

use delaunator::Point;
use edgeflip::{Backend, Dimension, Mesh, Options, Order, Outcome, families, make_delaunay};
use std::{error::Error, hint::black_box, ops::ControlFlow, time::Instant};

#[path = "arguments/mod.rs"]
mod arguments;
use arguments::{Arguments, median};

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &["random 1000", "shear 1000"])?;
    println!(
        "Medians of {runs} interleaved runs on one thread, ns an edge of the mesh; ratios are adjacency and"
    );
    println!(
        "flips together by `delaunator` (below 1: faster). The final count of what remains is not included."
    );
    println!();
    println!(
        "| mesh | phases : delaunator | Lawson : delaunator | phases: adjacency | flips | Lawson: adjacency | \
         flips | delaunator | edges | phases: flips | Lawson: flips |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for spec in specs {
        println!("{}", row(&spec, runs)?);
    }
    Ok(())
}

fn row(spec: &str, runs: usize) -> Result<String, Box<dyn Error>> {
    let mesh = families::by_name(spec)?;
    if mesh.dimension() != Dimension::Two {
        return Err(format!("{spec} is no mesh in the plane, which is all that delaunator takes").into());
    }
    let positions: Vec<f64> = mesh.positions().iter().collect();
    let points: Vec<Point> = positions.chunks_exact(2).map(|p| Point { x: p[0], y: p[1] }).collect();
    let (mut phases, mut lawson, mut scratch) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..runs {
        phases.push(flip(&mesh, Order::Reproducible)?);
        lawson.push(flip(&mesh, Order::Any)?);
        let start = Instant::now();
        black_box(delaunator::triangulate(black_box(&points)));
        scratch.push(start.elapsed().as_secs_f64() * 1e3);
    }
    let edges = phases[0].edges;
    let ns_an_edge = |ms: f64| ms * 1e6 / edges as f64;
    let times = |outcomes: &[Outcome]| {
        let part = |of: fn(&Outcome) -> f64| ns_an_edge(median(outcomes.iter().map(of).collect()));
        (part(|o| o.timings.adjacency), part(|o| o.timings.flip))
    };
    let (phases_adjacency, phases_flips) = times(&phases);
    let (lawson_adjacency, lawson_flips) = times(&lawson);
    let peer = ns_an_edge(median(scratch));
    Ok(format!(
        "| {spec} | {:.2} | {:.2} | {phases_adjacency:.1} | {phases_flips:.1} | {lawson_adjacency:.1} | \
         {lawson_flips:.1} | {peer:.1} | {edges} | {} | {} |",
        (phases_adjacency + phases_flips) / peer,
        (lawson_adjacency + lawson_flips) / peer,
        phases[0].flips,
        lawson[0].flips,
    ))
}

fn flip(mesh: &Mesh, order: Order) -> Result<Outcome, edgeflip::Error> {
    let options = Options { backend: Backend::Cpu, order, ..Options::default() };
    make_delaunay(mesh, &options, |_, _| ControlFlow::Continue(()))
}
