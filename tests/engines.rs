//! Every engine against the digests that the simulation has produced: the same triangles after every iteration.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod meshes;
mod simulation;

use edgeflip::quality::audit;
use edgeflip::{Backend, Error, Mesh, Options, Order, Outcome, Positions, Reason, Session, Status};
use pollster::block_on;
use simulation::{Digest, Expected, expected, simulate};
use std::ops::ControlFlow;

fn cases() -> Vec<(meshes::Case, Expected)> {
    meshes::all().into_iter().zip(expected()).collect()
}

fn options(backend: Backend, beta: f64) -> Options {
    Options { backend, max_normal_angle: beta, ..Options::default() }
}

/// Steps through a run; returns the number of labelled edges in all, and the digest.
fn watched(mesh: &Mesh, options: Options) -> Result<(u64, Digest, Outcome), Error> {
    block_on(async {
        let mut session = Session::new(mesh.clone(), options).await?;
        let mut digest = Digest::default();
        let mut labelled = 0;
        digest.feed(&session.triangles().await?);
        while let Some(iteration) = session.step().await? {
            labelled += u64::from(iteration.labelled);
            digest.feed(&session.triangles().await?);
        }
        Ok((labelled, digest, session.outcome().await?))
    })
}

/// A run from end to end, as most callers want it.
fn unwatched(mesh: &Mesh, options: &Options) -> Outcome {
    edgeflip::make_delaunay(mesh, options, |_, _| ControlFlow::Continue(())).unwrap()
}

fn assert_expected(
    case: &meshes::Case,
    want: &Expected,
    (labelled, digest, outcome): &(u64, Digest, Outcome),
) {
    let name = format!("{} at β = {}, {}", case.name, case.beta, outcome.backend);
    assert_eq!(outcome.status, Status::Done, "{name}");
    assert_eq!((outcome.iterations as usize, outcome.flips), (want.iterations, want.flips), "{name}");
    assert_eq!(*labelled, want.labelled, "{name}");
    assert_eq!(*digest, want.digest, "{name}");
    assert_eq!(outcome.remaining, want.remaining, "{name}");
}

#[test]
fn cpu_gives_the_digests_of_the_simulation() {
    for (case, want) in cases() {
        let options = options(Backend::Cpu, case.beta);
        let watched = watched(&case.mesh, options.clone()).unwrap();
        assert_expected(&case, &want, &watched);
        assert_eq!(unwatched(&case.mesh, &options).triangles, watched.2.triangles, "{}", case.name);
    }
}

#[test]
fn gpu_gives_the_digests_of_the_simulation() {
    let mut refused = Vec::new();
    for (case, want) in cases() {
        let options = options(Backend::Gpu, case.beta);
        // One submission and read-back an iteration: the long runs are compared from end to end below.
        if want.iterations < 50 {
            match watched(&case.mesh, options.clone()) {
                Ok(watched) => assert_expected(&case, &want, &watched),
                Err(Error::BackendLimit { .. }) => {
                    refused.push(case.name);
                    continue;
                }
                Err(error) => panic!("{}: {error}", case.name),
            }
        }
        let outcome = unwatched(&case.mesh, &options);
        let cpu = unwatched(&case.mesh, &Options { backend: Backend::Cpu, ..options });
        assert_eq!(outcome.triangles, cpu.triangles, "{}", case.name);
        assert_eq!(outcome.flips_per_iteration, cpu.flips_per_iteration, "{}", case.name);
        assert_eq!(outcome.remaining, cpu.remaining, "{}", case.name);
        assert!(outcome.adapter.is_some() && outcome.dispatches > 0);
    }
    refused.dedup();
    // Coordinates outside the span that it decides exactly, or near the largest float; and all doubles.
    let mut expected: Vec<String> =
        ["scale-3e38", "scale-3e38-3d", "magnitudes", "magnitudes-3d"].map(String::from).to_vec();
    let all = meshes::all().into_iter();
    expected
        .extend(all.filter(|case| matches!(case.mesh.positions(), Positions::F64(_))).map(|case| case.name));
    assert_eq!(refused, expected);
}

#[test]
fn any_order_ends_where_nothing_is_left_to_flip() {
    for (case, want) in cases() {
        let options = Options { order: Order::Any, ..options(Backend::Cpu, case.beta) };
        let outcome = unwatched(&case.mesh, &options);
        let audit = audit(&case.mesh, &outcome.triangles, case.beta);
        assert!(audit.is_clean(), "{}: {:?}", case.name, audit.violations);
        assert_eq!(audit.remaining, outcome.remaining, "{}", case.name);
        assert_eq!(outcome.remaining[Reason::Stopped], 0, "{}", case.name);
        if want.remaining.total() == 0 && case.mesh.dimension() == edgeflip::Dimension::Two {
            assert_eq!(outcome.remaining.total(), 0, "{}", case.name);
        }
    }
}

/// Random meshes to try; `EDGEFLIP_ROUNDS` asks for more.
fn rounds() -> u64 {
    std::env::var("EDGEFLIP_ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(200)
}

fn assert_simulated(name: &str, mesh: &Mesh, beta: f64, backends: &[Backend]) {
    let want = simulate(mesh, beta, None);
    for &backend in backends {
        let (_, digest, outcome) = watched(mesh, options(backend, beta)).unwrap();
        assert_eq!(digest, want.digest, "{name} at β = {beta}, {}", outcome.backend);
        assert_eq!(outcome.remaining, want.remaining, "{name} at β = {beta}, {}", outcome.backend);
    }
}

#[test]
fn soups_flip_as_simulated() {
    for seed in 0..rounds() {
        let (flat, bent) = meshes::soup(seed, 3 + seed as usize % 5, seed as usize / 5 % 23);
        // The software GPU takes a tenth of them.
        let backends = [Backend::Cpu, Backend::Gpu];
        let backends = &backends[..1 + usize::from(seed % 10 == 0)];
        assert_simulated(&format!("soup {seed}"), &flat, 10.0, backends);
        for beta in [0.0, 40.0, 180.0] {
            assert_simulated(&format!("bent soup {seed}"), &bent, beta, backends);
        }
    }
}

#[test]
fn a_capped_run_stops_after_a_complete_iteration() {
    let mesh = edgeflip::families::by_name("random 12").unwrap();
    let want = simulate(&mesh, 10.0, Some(2));
    for backend in [Backend::Cpu, Backend::Gpu] {
        let capped = Options { max_iterations: Some(2), ..options(backend, 10.0) };
        let outcome = unwatched(&mesh, &capped);
        assert_eq!((outcome.status, outcome.iterations), (Status::Stopped, 2));
        assert_eq!((&outcome.triangles, outcome.remaining), (&want.triangles, want.remaining));
        let stopped =
            edgeflip::make_delaunay(&mesh, &options(Backend::Cpu, 10.0), |_, _| ControlFlow::Break(()));
        assert_eq!(stopped.unwrap().status, Status::Stopped);
    }
}
