//! The CPU engine on several threads gives the same bits after every iteration on any number of threads. In debug
//! builds, even loops over small meshes have several pieces.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

mod meshes;
mod runs;
mod simulation;

use edgeflip::{Adjacency, Backend, Options, Order, families};
use runs::{unwatched, watched};
use simulation::{expected, simulate};
use std::num::NonZeroUsize;

const COUNTS: [usize; 4] = [1, 2, 3, 8];

#[test]
fn every_mesh_of_the_matrix_flips_as_on_one() {
    for (case, want) in meshes::all().into_iter().zip(expected()) {
        for threads in COUNTS {
            let options = Options { threads: NonZeroUsize::new(threads), ..case.options(Backend::Cpu) };
            let run = watched(&case.mesh, &options).unwrap();
            let found = simulation::Expected::new(&case.name, case.beta, &run);
            assert_eq!(found, want, "{threads} threads");
        }
    }
}

/// The same with Lawson's algorithm, which divides the mesh into regions for its threads.
#[test]
fn every_mesh_of_the_matrix_flips_in_any_order_as_on_one() {
    for case in meshes::all() {
        let run = |threads| {
            let options = Options {
                threads: NonZeroUsize::new(threads),
                order: Order::Any,
                ..case.options(Backend::Cpu)
            };
            let outcome = unwatched(&case.mesh, &options).unwrap();
            (outcome.triangles, outcome.flips, outcome.remaining)
        };
        let want = run(1);
        for threads in &COUNTS[1..] {
            assert!(run(*threads) == want, "{}, {threads} threads", case.name);
        }
    }
}

#[test]
fn random_dirty_meshes_flip_as_simulated() {
    for seed in 0..20 {
        let (flat, bent) = meshes::soup(seed, 5 + seed as usize % 5, 20);
        for (mesh, beta) in [(flat, 10.0), (bent, 90.0)] {
            let want = simulate(&mesh, beta, None);
            for threads in COUNTS {
                let options =
                    Options { threads: NonZeroUsize::new(threads), ..runs::options(Backend::Cpu, beta) };
                assert_eq!(watched(&mesh, &options).unwrap(), want, "soup {seed}, {threads} threads");
            }
        }
    }
}

/// The meshes are so large that release builds use several threads too.
#[test]
fn large_meshes_end_alike_with_the_same_flips_and_twins() {
    for spec in ["shear 150", "random 150", "uvsphere 150"] {
        let mesh = families::by_name(spec).unwrap();
        let run = |threads| {
            let options =
                Options { threads: NonZeroUsize::new(threads), ..runs::options(Backend::Cpu, 10.0) };
            let outcome = unwatched(&mesh, &options).unwrap();
            let twins = Adjacency::new(&mesh.with_triangles(outcome.triangles.clone()).unwrap());
            (outcome.triangles, outcome.flips_per_iteration, outcome.remaining, twins)
        };
        let want = run(1);
        for threads in &COUNTS[1..] {
            assert!(run(*threads) == want, "{spec}, {threads} threads");
        }
    }
}
