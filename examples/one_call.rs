//! One call makes a mesh Delaunay: `cargo run --release --example one_call`.

use edgeflip::{Dimension, Error, Mesh, Options, make_delaunay};
use std::ops::ControlFlow;

/// Flips the long diagonal of a thin diamond.
pub fn main() -> Result<(), Error> {
    let positions = vec![-3.0, 0.0, 0.0, -1.0, 3.0, 0.0, 0.0, 1.0];
    let mesh = Mesh::new(Dimension::Two, positions, vec![0, 1, 2, 0, 2, 3])?;
    let outcome = make_delaunay(&mesh, &Options::default(), |_, _| ControlFlow::Continue(()))?;
    println!("{} flip on {}: {:?}", outcome.flips, outcome.backend, outcome.triangles);
    println!("{} edges are still not Delaunay", outcome.remaining.total());
    Ok(())
}
