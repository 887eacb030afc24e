//! The CPU engine on several threads gives the same bits after every iteration on any number of threads. In debug
//! builds, even loops over small meshes have several pieces.
#![cfg(feature = "threads")]

use crate::runs::{options, unwatched, watched};
use crate::simulation::{Expected, expected, simulate};
use crate::{matrix, meshes};
use edgeflip::quality::audit;
use edgeflip::{Adjacency, Backend, Dimension, Options, Order, Reason, families};
use std::num::NonZeroUsize;

const COUNTS: [usize; 4] = [1, 2, 3, 8];

#[test]
fn every_mesh_of_the_matrix_flips_as_on_one() {
    for (case, want) in matrix::cases().iter().zip(expected()) {
        for threads in COUNTS {
            let options = Options { threads: NonZeroUsize::new(threads), ..case.options(Backend::Cpu) };
            let run = watched(&case.mesh, &options).unwrap();
            let found = Expected::new(&case.name, case.beta, &run);
            assert_eq!(found, want, "{threads} threads");
        }
    }
}

/// The same with Lawson's algorithm, which divides the mesh into regions for its threads. At its end, nothing is left to
/// flip.
#[test]
fn every_mesh_of_the_matrix_flips_in_any_order_as_on_one() {
    for (case, simulated) in matrix::cases().iter().zip(expected()) {
        let run = |threads| {
            let options = Options {
                threads: NonZeroUsize::new(threads),
                order: Order::Any,
                ..case.options(Backend::Cpu)
            };
            let outcome = unwatched(&case.mesh, &options).unwrap();
            (outcome.triangles, outcome.flips, outcome.remaining, [outcome.inverted, outcome.flat])
        };
        let want = run(1);
        for threads in &COUNTS[1..] {
            assert!(run(*threads) == want, "{}, {threads} threads", case.name);
        }
        let (triangles, _, remaining, areas) = want;
        let audit = audit(&case.mesh, &triangles, &case.options(Backend::Cpu));
        assert!(audit.violations.is_empty(), "{}: {:?}", case.name, audit.violations);
        assert_eq!(audit.remaining, remaining, "{}", case.name);
        assert_eq!(
            [audit.inverted.len(), audit.flat.len()],
            areas.map(|count| count as usize),
            "{}",
            case.name
        );
        assert_eq!(remaining[Reason::Stopped], 0, "{}", case.name);
        if simulated.remaining.total() == 0 && case.mesh.dimension() == Dimension::Two {
            assert_eq!(remaining.total(), 0, "{}", case.name);
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
                let options = Options { threads: NonZeroUsize::new(threads), ..options(Backend::Cpu, beta) };
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
            let options = Options { threads: NonZeroUsize::new(threads), ..options(Backend::Cpu, 10.0) };
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
