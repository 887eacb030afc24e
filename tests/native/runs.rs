//! Runs of the engines: one iteration at a time, or to the end at once; on random meshes; on all cores.

use crate::simulation::{Digest, IterationRecord, Simulation};
use edgeflip::{Backend, Error, Mesh, Options, Outcome, Session};
use pollster::block_on;
use std::num::NonZero;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

pub fn options(backend: Backend, beta: f64) -> Options {
    Options { backend, max_normal_angle: beta, ..Options::default() }
}

/// Steps through a run, and returns the same data as the simulation.
pub fn watched(mesh: &Mesh, options: &Options) -> Result<Simulation, Error> {
    block_on(async {
        let mut session = Session::new(mesh.clone(), options.clone()).await?;
        let mut digest = Digest::default();
        let mut iterations = Vec::new();
        digest.feed(&session.triangles().await?);
        while let Some(step) = session.step().await? {
            digest.feed(&session.triangles().await?);
            let (labelled, flips, blocked) = (step.labelled, step.flips, step.blocked);
            iterations.push(IterationRecord { labelled, flips, blocked, digest });
        }
        let Outcome { triangles, remaining, .. } = session.outcome().await?;
        Ok(Simulation { iterations, triangles, remaining, digest })
    })
}

/// A run to the end, as most callers use it.
pub fn unwatched(mesh: &Mesh, options: &Options) -> Result<Outcome, Error> {
    edgeflip::make_delaunay(mesh, options, |_, _| ControlFlow::Continue(()))
}

/// The number of random meshes to try: `EDGEFLIP_ROUNDS`, or `usual`.
pub fn rounds(usual: u64) -> u64 {
    std::env::var("EDGEFLIP_ROUNDS").map_or(usual, |rounds| rounds.parse().unwrap())
}

/// Calls `work` with each number below `count`, on all cores.
pub fn on_all_cores(count: usize, work: impl Fn(usize) + Sync) {
    let next = AtomicUsize::new(0);
    let work_through = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                break;
            }
            work(index);
        }
    };
    std::thread::scope(|scope| {
        let cores = std::thread::available_parallelism().map_or(1, NonZero::get);
        (0..cores).for_each(|_| drop(scope.spawn(work_through)));
    });
}
