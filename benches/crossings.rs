//! Measures lines that come in with a vertex where they cross, next to the crate `spade`, on one thread:
//! `cargo bench -p benches --bench crossings -- [--runs N] LINES…`. The lines are as long that half as many pairs of them
//! cross.
//!
//! The runs are interleaved; the figures are medians. `spade` keeps its triangulation Delaunay while lines come in, and
//! edgeflip makes the result Delaunay by a run.

use benches::arguments::{Arguments, median};
use edgeflip::{
    Backend, Dimension, Mesh, Options, Order, Positions, SplitCrossings, make_delaunay, split_crossings,
    triangulate_with,
};
use edgeflip::{PointOptions, Triangulation as Triangles};
use oorandom::Rand64;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};
use std::error::Error;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::time::Instant;

/// A point with its index.
#[derive(Clone, Copy)]
struct Numbered(Point2<f64>, u32);

impl HasPosition for Numbered {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.0
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &["100000"])?;
    println!(
        "Lines that cross, natively on one thread, in milliseconds; medians of {runs} interleaved runs.\n"
    );
    println!(
        "| lines | crossings | : spade | with points and run : spade | to bring them in | points | run | spade | points |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for spec in &specs {
        let count: u32 = spec.parse()?;
        let numbers = lines(count);
        let pairs: Vec<[u32; 2]> = (0..count).map(|i| [2 * i, 2 * i + 1]).collect();
        let (mut ms, mut crossings) = (vec![Vec::new(); 5], 0);
        for _ in 0..runs {
            let (ours, added) = edgeflip(&numbers, &pairs)?;
            let theirs = spade(&numbers, &pairs)?;
            crossings = added;
            ours.into_iter().chain(theirs).zip(&mut ms).for_each(|(time, ms)| ms.push(time));
        }
        let ms: Vec<f64> = ms.into_iter().map(median).collect();
        let [points, split, run, their_points, their_lines] = [ms[0], ms[1], ms[2], ms[3], ms[4]];
        let ratio = split / their_lines;
        let all = (points + split + run) / (their_points + their_lines);
        println!(
            "| {count} | {crossings} | {ratio:.2} | {all:.2} | {split:.0} | {points:.0} | {run:.0} | {their_lines:.0} | {their_points:.0} |"
        );
    }
    Ok(())
}

/// The ends of lines in a square. Of n lines of length l in a square of 1, about n² l² / π pairs cross.
fn lines(count: u32) -> Vec<f64> {
    let mut random = Rand64::new(5);
    let length = (0.5 * std::f64::consts::PI / f64::from(count)).sqrt();
    let mut numbers = Vec::new();
    for _ in 0..count {
        let [x, y, turn] = [(); 3].map(|()| random.rand_float());
        let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
        numbers.extend([x, y, x + length * cos, y + length * sin]);
    }
    numbers
}

/// The times for the points, the lines and the run, and the number of crossings.
fn edgeflip(numbers: &[f64], lines: &[[u32; 2]]) -> Result<([f64; 3], usize), Box<dyn Error>> {
    let one = NonZeroUsize::new(1);
    let (numbers, mut clock) = (numbers.to_vec(), Clock(Instant::now()));
    let options = PointOptions { threads: one, ..PointOptions::default() };
    let Triangles { triangles, .. } = triangulate_with(&Positions::from(numbers.clone()), &options)?;
    let mesh = Mesh::new(Dimension::Two, numbers, triangles)?;
    let points = clock.lap();
    let split = split_crossings(&mesh, lines, &[], false)?;
    let brought = clock.lap();
    let locked_edges = split.constraint_edges();
    let options = Options {
        backend: Backend::Cpu,
        order: Order::Any,
        threads: one,
        locked_edges,
        ..Options::default()
    };
    let SplitCrossings { mesh, crossings, .. } = split;
    make_delaunay(mesh, &options, |_, _| ControlFlow::Continue(()))?;
    Ok(([points, brought, clock.lap()], crossings.len()))
}

/// The times for the points and the lines.
fn spade(numbers: &[f64], lines: &[[u32; 2]]) -> Result<[f64; 2], Box<dyn Error>> {
    let mut clock = Clock(Instant::now());
    let (points, _) = numbers.as_chunks::<2>();
    let points = (0..).zip(points).map(|(i, &[x, y])| Numbered(Point2::new(x, y), i)).collect();
    let mut made = ConstrainedDelaunayTriangulation::<Numbered>::bulk_load(points)?;
    let mut handles = vec![FixedVertexHandle::from_index(0); numbers.len() / 2];
    made.vertices().for_each(|vertex| handles[vertex.data().1 as usize] = vertex.fix());
    let loaded = clock.lap();
    for line in lines {
        let [from, to] = line.map(|v| handles[v as usize]);
        made.add_constraint_and_split(from, to, |point| Numbered(point, u32::MAX));
    }
    Ok([loaded, clock.lap()])
}

/// Milliseconds since the last lap.
struct Clock(Instant);

impl Clock {
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let ms = (now - self.0).as_secs_f64() * 1e3;
        self.0 = now;
        ms
    }
}
