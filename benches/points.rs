//! Measures `triangulate`, on one thread and on one per core, next to the crates `delaunator` and `spade`, which have one
//! thread: from an array of points to the triangles and their twins.
//! `cargo bench -p benches --bench points -- [--runs N] [KIND…]`; `uniform 100000` is a kind with another number of points
//! than a million.
//!
//! The runs are interleaved; the figures are medians.

#[path = "../tests/points/mod.rs"]
mod points;

use benches::arguments::{Arguments, median};
use delaunator::Point;
use edgeflip::{PointOptions, Positions, triangulate_with};
use points::KINDS;
use spade::{DelaunayTriangulation, Point2, Triangulation};
use std::{error::Error, hint::black_box, num::NonZeroUsize, thread::available_parallelism, time::Instant};

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

/// For so many points of these kinds, the crates take minutes or hours.
const SLOW_IN_DELAUNATOR: [&str; 3] = ["circle", "parabola", "few values of x"];
const SLOW_IN_SPADE: [&str; 1] = ["parabola"];

type Work<'a> = Box<dyn Fn() -> Result<(), Box<dyn Error>> + 'a>;

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &SETS)?;
    let cores = available_parallelism()?;
    println!(
        "Milliseconds, medians of {runs} interleaved runs, on one thread where the column does not say {cores}. The crates get 64-bit floats."
    );
    println!();
    println!(
        "| points | : delaunator | : spade | {cores} threads : one | 64-bit floats | {cores} threads | 32-bit floats | delaunator | spade |"
    );
    println!("|---|{}", "---:|".repeat(8));
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
        let ours = |positions, threads| -> Work {
            let options = PointOptions { threads: Some(threads), ..PointOptions::default() };
            Box::new(move || {
                black_box(triangulate_with(positions, &options)?);
                Ok(())
            })
        };
        let delaunator: Work = Box::new(|| {
            black_box(delaunator::triangulate(&theirs));
            Ok(())
        });
        let spade: Work = Box::new(|| {
            black_box(DelaunayTriangulation::<Point2<f64>>::bulk_load(vertices.clone())?.num_vertices());
            Ok(())
        });
        let quick = |work, slow: &[&str]| Some(work).filter(|_| count <= 100_000 || !slow.contains(&name));
        let contenders = [
            Some(ours(&wide, NonZeroUsize::MIN)),
            Some(ours(&wide, cores)),
            Some(ours(&narrow, NonZeroUsize::MIN)),
            quick(delaunator, &SLOW_IN_DELAUNATOR),
            quick(spade, &SLOW_IN_SPADE),
        ];
        let mut ms = vec![Vec::new(); contenders.len()];
        for _ in 0..runs {
            for (work, ms) in contenders.iter().zip(&mut ms) {
                if let Some(work) = work {
                    let start = Instant::now();
                    work()?;
                    ms.push(start.elapsed().as_secs_f64() * 1e3);
                }
            }
        }
        let [wide, fast, narrow, delaunator, spade] =
            [0, 1, 2, 3, 4].map(|i| median(std::mem::take(&mut ms[i])));
        let cell = |x: f64| if x.is_nan() { "–".to_owned() } else { format!("{x:.2}") };
        let ratios = [wide / delaunator, wide / spade, fast / wide];
        let cells = ratios.into_iter().chain([wide, fast, narrow, delaunator, spade]).map(cell);
        println!("| {count} {name} | {} |", cells.collect::<Vec<_>>().join(" | "));
    }
    Ok(())
}
