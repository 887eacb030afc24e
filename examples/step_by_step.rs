//! A session runs step by step, then to its end with progress: `cargo run --release --example step_by_step`.

use edgeflip::{Error, Options, Session, families};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// Watches two iterations one by one, and the others batch by batch, for at most a minute.
pub fn main() -> Result<(), Error> {
    let mesh = families::by_name("random 60")?;
    // `pollster` is a small executor; any other works too.
    pollster::block_on(async {
        let mut session = Session::new(&mesh, Options::default()).await?;
        for _ in 0..2 {
            let Some(iteration) = session.step().await? else { break };
            println!(
                "iteration {}: {} edges may flip, {} flip",
                iteration.index, iteration.labelled, iteration.flips
            );
        }

        let begun = Instant::now();
        let watch = |iterations, flips| {
            println!("{flips} flips in {iterations} iterations");
            if begun.elapsed() < Duration::from_secs(60) {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        session.run(watch).await?;

        let outcome = session.outcome().await?;
        println!("{:?}: {} edges are still not Delaunay", outcome.status, outcome.remaining.total());
        Ok(())
    })
}
