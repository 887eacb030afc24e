//! Lattices of spacing 0.1 on every native engine: every edge is a tie, or a tie up to rounding.
//!
//! `EDGEFLIP_SIDE` is the number of vertices along a side. The compiled test reads no file, so it can be copied to
//! another machine.
#![cfg(feature = "gpu")]

use crate::meshes;
use edgeflip::quality::audit;
use edgeflip::{Backend, Mesh, Options, Order, Outcome, Status, families, make_delaunay};
use std::ops::ControlFlow;
use std::time::Instant;

fn side() -> usize {
    std::env::var("EDGEFLIP_SIDE").map_or(200, |side| side.parse().unwrap())
}

/// The outcomes on the CPU, on the GPU and with Lawson's algorithm. Asserts that CPU and GPU agree.
fn run(name: &str, mesh: &Mesh) -> [Outcome; 3] {
    let flipped = |backend, order| {
        let options = Options { backend, order, ..Options::default() };
        let start = Instant::now();
        let outcome = make_delaunay(mesh, &options, |_, _| ControlFlow::Continue(())).unwrap();
        let (on, seconds) = (outcome.adapter.as_deref().unwrap_or("cpu"), start.elapsed().as_secs_f64());
        println!(
            "{name}, {order:?}, {on}: {} flips, {} iterations, {seconds:.1} s",
            outcome.flips, outcome.iterations
        );
        assert_eq!((outcome.status, outcome.remaining.total()), (Status::Done, 0), "{name} on {on}");
        outcome
    };
    let cpu = flipped(Backend::Cpu, Order::Reproducible);
    let gpu = flipped(Backend::Gpu, Order::Reproducible);
    assert_eq!(cpu.triangles, gpu.triangles, "{name}");
    assert_eq!(cpu.flips_per_iteration, gpu.flips_per_iteration, "{name}");
    [cpu, gpu, flipped(Backend::Cpu, Order::Any)]
}

fn lattices() -> [(String, Mesh); 2] {
    ["", " 100000"].map(|offset| {
        let name = format!("regular {}{offset}", side());
        let mesh = families::by_name(&name).unwrap();
        (name, mesh)
    })
}

#[test]
fn ties_never_flip() {
    for (name, mesh) in lattices() {
        for outcome in run(&name, &mesh) {
            assert_eq!(outcome.flips, 0, "{name}");
            assert_eq!(outcome.triangles, mesh.triangles(), "{name}");
        }
    }
}

#[test]
fn noise_of_one_ulp_ends_with_no_edge_left() {
    for (name, lattice) in lattices() {
        let mesh = meshes::off_by_one_ulp(&lattice);
        for outcome in run(&format!("{name}, off by one ulp"), &mesh) {
            assert!(outcome.flips > 1000, "{name}");
            let audit = audit(&mesh, &outcome.triangles, &Options::default());
            assert!(audit.is_clean(), "{name}: {:?}", audit.violations);
            assert_eq!(audit.remaining.total(), 0, "{name}");
        }
    }
}
