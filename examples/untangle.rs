//! Vertices that go anywhere: `cargo run --example untangle`. A vertex leaves a square and comes back; whenever its place
//! allows it, the triangles are right again.

use edgeflip::{Dimension, Error, Mesh, Options, Session};
use std::ops::ControlFlow;

/// Prints what becomes of each place.
pub fn main() -> Result<(), Error> {
    pollster::block_on(run()).map(|lines| lines.iter().for_each(|line| println!("{line}")))
}

/// A line for each place.
pub async fn run() -> Result<Vec<String>, Error> {
    let at = |x: f32, y: f32| vec![0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, x, y];
    let mesh = Mesh::new(Dimension::Two, at(1.0, 1.0), vec![0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4])?;
    let mut session = Session::new(mesh, Options::default()).await?;
    let mut lines = Vec::new();
    for (x, y) in [(3.0, 2.0), (9.0, 2.0), (4.0, 4.0), (2.0, 3.0)] {
        session.set_positions(at(x, y)).await?;
        session.run(|_, _| ControlFlow::Continue(())).await?;
        let outcome = session.outcome().await?;
        let problems = session.problems().await?;
        lines.push(format!(
            "at {x}, {y}: {} turned over, {} flat; outside: {:?}, at one point: {:?}",
            outcome.inverted, outcome.flat, problems.outside, problems.coincident
        ));
    }
    Ok(lines)
}
