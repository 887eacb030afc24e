//! Measures `triangulate` next to the crates `delaunator` and `spade`, from an array of points to the triangles and their
//! twins, on one thread. `cargo bench -p benches --bench points -- [--runs N] [KIND…]`; `uniform 100000` is a kind with
//! another number of points than a million.
//!
//! The runs are interleaved; the figures are medians.

#[path = "../tests/points/mod.rs"]
mod points;

use benches::arguments::{Arguments, median};
use delaunator::Point;
use edgeflip::{Positions, triangulate};
use points::KINDS;
use spade::{DelaunayTriangulation, Point2, Triangulation};
use std::{error::Error, hint::black_box, time::Instant};

const SETS: [&str; 14] = [
    "uniform",
    "uniform 100000",
    "uniform 10000",
    "uniform 1000",
    "normal",
    "clusters",
    "tight clusters",
    "circle",
    "parabola",
    "spiral",
    "two lines",
    "few values of x",
    "lattice",
    "sorted",
];

/// For these the crate `delaunator` takes more than ten seconds.
const SLOW: [&str; 2] = ["parabola", "few values of x"];

type Work<'a> = Box<dyn Fn() -> Result<(), Box<dyn Error>> + 'a>;

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &SETS)?;
    println!(
        "Times in milliseconds, medians of {runs} interleaved runs; ratios are to the first column, 64-bit floats."
    );
    println!();
    println!(
        "| points | of f64 | of f32 | delaunator | spade | f32 : f64 | f64 : delaunator | f64 : spade |"
    );
    println!("|---|{}", "---:|".repeat(7));
    for spec in &specs {
        let (name, count) = match spec.rsplit_once(' ').map(|(name, count)| (name, count.parse())) {
            Some((name, Ok(count))) => (name, count),
            _ => (spec.as_str(), 1_000_000),
        };
        let (_, kind) = KINDS.iter().find(|(known, _)| *known == name).ok_or("no such kind")?;
        let pairs = points::points(*kind, count, 1);
        let wide = Positions::from(pairs.as_flattened().to_vec());
        let narrow = Positions::from(wide.to_f32());
        let theirs: Vec<Point> = pairs.iter().map(|&[x, y]| Point { x, y }).collect();
        let vertices: Vec<Point2<f64>> = pairs.iter().map(|&[x, y]| Point2::new(x, y)).collect();
        let ours = |positions| -> Work {
            Box::new(move || {
                black_box(triangulate(positions)?);
                Ok(())
            })
        };
        let mut contenders = vec![ours(&wide), ours(&narrow)];
        if !SLOW.contains(&name) || count < 20_000 {
            contenders.push(Box::new(|| {
                black_box(delaunator::triangulate(&theirs));
                Ok(())
            }));
        } else {
            contenders.push(Box::new(|| Ok(())));
        }
        contenders.push(Box::new(|| {
            black_box(DelaunayTriangulation::<Point2<f64>>::bulk_load(vertices.clone())?.num_vertices());
            Ok(())
        }));
        let mut ms = vec![Vec::new(); contenders.len()];
        for _ in 0..runs {
            for (work, ms) in contenders.iter().zip(&mut ms) {
                let start = Instant::now();
                work()?;
                ms.push(start.elapsed().as_secs_f64() * 1e3);
            }
        }
        let ms: Vec<f64> = ms.into_iter().map(median).collect();
        let of = |i: usize| if ms[i] > 1e-3 { format!("{:.2}", ms[0] / ms[i]) } else { "–".to_owned() };
        let times: Vec<String> = ms.iter().map(|ms| format!("{ms:.2}")).collect();
        println!("| {count} {name} | {} | {:.2} | {} | {} |", times.join(" | "), ms[1] / ms[0], of(2), of(3));
    }
    Ok(())
}
