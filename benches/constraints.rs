//! Measures constraints that come into the triangles of `delaunator`, next to the crate `spade`, which begins with the
//! points. `cargo bench -p benches --bench constraints -- [--runs N] FILE…`, after `node benches/constraints.mjs`, which
//! writes the files: `target/constraints/lines` stands for `lines.ply` and `lines.txt` in that folder.
//!
//! The runs are interleaved; the figures are medians.

use benches::arguments::{Arguments, median};
use edgeflip::{Backend, Mesh, Options, Order, constrained, io, make_delaunay};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::{error::Error, hint::black_box, num::NonZeroUsize, ops::ControlFlow, sync::Arc, time::Instant};

const FILES: [&str; 3] = [
    concat!(env!("CARGO_MANIFEST_DIR"), "/../target/constraints/coasts"),
    concat!(env!("CARGO_MANIFEST_DIR"), "/../target/constraints/lines"),
    concat!(env!("CARGO_MANIFEST_DIR"), "/../target/constraints/track"),
];

/// What is measured, with its name.
type Contender<'a> = (&'static str, Box<dyn Fn() -> Result<(), Box<dyn Error>> + 'a>);

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &FILES)?;
    println!(
        "From the triangles of delaunator to the constrained Delaunay triangulation, natively, in milliseconds;"
    );
    println!(
        "medians of {runs} interleaved runs. spade begins with the points. In brackets: that time divided by that of"
    );
    println!("order any on one thread.\n");
    for (i, file) in specs.iter().enumerate() {
        let mesh = Arc::new(io::read(format!("{file}.ply"), &io::ReadOptions::default())?);
        let edges = io::read_edges(format!("{file}.txt"), u64::MAX)?;
        let contenders = contenders(&mesh, &edges);
        if i == 0 {
            let names: Vec<_> = contenders.iter().map(|(name, _)| *name).collect();
            println!("| constraints | {} |\n|---|{}", names.join(" | "), "---:|".repeat(names.len()));
        }
        let mut ms = vec![Vec::new(); contenders.len()];
        for _ in 0..runs {
            for ((_, work), ms) in contenders.iter().zip(&mut ms) {
                let start = Instant::now();
                work()?;
                ms.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
        let ms: Vec<_> = ms.into_iter().map(median).collect();
        let cells: Vec<_> = ms.iter().map(|x| format!("{x:.0} ({:.2})", x / ms[0])).collect();
        let name = file.rsplit('/').next().unwrap_or(file);
        println!("| {} {name} | {} |", edges.len(), cells.join(" | "));
    }
    Ok(())
}

fn contenders<'a>(mesh: &'a Arc<Mesh>, edges: &'a [[u32; 2]]) -> Vec<Contender<'a>> {
    let ours = |order, threads| {
        Box::new(move || {
            let constraints = edges.to_vec();
            let options =
                Options { constraints, backend: Backend::Cpu, order, threads, ..Options::default() };
            black_box(make_delaunay(mesh.clone(), &options, |_, _| ControlFlow::Continue(()))?);
            Ok(())
        })
    };
    let one = NonZeroUsize::new(1);
    let step = |threads| {
        Box::new(move || {
            black_box(constrained(mesh, edges, &[], false, 0.0, threads)?);
            Ok(())
        })
    };
    vec![
        ("any, one thread", ours(Order::Any, one)),
        ("of it to bring them in", step(one)),
        ("reproducible, one thread", ours(Order::Reproducible, one)),
        ("any, all cores", ours(Order::Any, None)),
        ("of it to bring them in", step(None)),
        (
            "spade",
            Box::new(|| {
                let coordinates: Vec<f64> = mesh.positions().iter().collect();
                let points =
                    coordinates.chunks_exact(2).map(|point| Point2::new(point[0], point[1])).collect();
                let edges = edges.iter().map(|ends| ends.map(|v| v as usize)).collect();
                black_box(
                    ConstrainedDelaunayTriangulation::<_>::bulk_load_cdt(points, edges)?.num_vertices(),
                );
                Ok(())
            }),
        ),
    ]
}
