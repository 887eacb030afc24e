//! Measures the tiers of the predicates: one sweep over Delaunay meshes, which tests every edge and flips none.
//! `cargo bench -p benches --bench tiers -- [--runs N] [SIZE]`, with about SIZE x SIZE points per mesh.
//!
//! `cargo test --lib tiers -- --nocapture` counts the edges that each tier decides.

use benches::arguments::{Arguments, median};
use benches::kinds::kinds;
use edgeflip::{Backend, Error, Mesh, Options, Outcome, make_delaunay};
use std::ops::ControlFlow;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Arguments { runs, specs } = Arguments::read(5, &["300"])?;
    let [size] = specs.as_slice() else { return Err("one SIZE is enough".into()) };
    println!(
        "Nanoseconds per edge of one sweep, which tests each edge from both sides; medians of {runs} interleaved runs after an uncounted run."
    );
    println!();
    println!("| mesh | edges | CPU | GPU |");
    println!("|---|---:|---:|---:|");
    for (name, mesh) in kinds(size.parse()?)? {
        let (mut cpu, mut gpu) = (Vec::new(), Vec::new());
        let mut edges = 0;
        for round in 0..=runs {
            for (backend, times) in [(Backend::Cpu, &mut cpu), (Backend::Gpu, &mut gpu)] {
                let outcome = match sweep(&mesh, backend) {
                    Err(Error::BackendLimit { .. }) => continue,
                    outcome => outcome?,
                };
                edges = outcome.edges;
                if round > 0 {
                    times.push(outcome.timings.flip * 1e6 / edges as f64);
                }
            }
        }
        let cell = |times: Vec<f64>| {
            if times.is_empty() { "refused".to_owned() } else { format!("{:.1}", median(times)) }
        };
        println!("| {name} | {edges} | {} | {} |", cell(cpu), cell(gpu));
    }
    Ok(())
}

fn sweep(mesh: &Mesh, backend: Backend) -> Result<Outcome, Error> {
    let options = Options { backend, ..Options::default() };
    make_delaunay(mesh, &options, |_, _| ControlFlow::Continue(()))
}
