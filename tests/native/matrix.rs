//! The meshes of the parity matrix. A process makes each of them once, and simulates it once.

use crate::meshes::{self, Case};
use crate::runs::on_all_cores;
use crate::simulation::{Simulation, simulate_with};
use edgeflip::Backend;
use std::sync::{LazyLock, OnceLock};

/// All cases.
pub fn cases() -> &'static [Case] {
    static CASES: LazyLock<Vec<Case>> = LazyLock::new(meshes::all);
    &CASES
}

/// The first case of this name.
pub fn named(name: &str) -> &'static Case {
    cases().iter().find(|case| case.name == name).unwrap()
}

/// All cases, each with the run that every engine must reproduce.
pub fn simulated() -> impl Iterator<Item = (&'static Case, &'static Simulation)> {
    static RUNS: LazyLock<Vec<OnceLock<Simulation>>> = LazyLock::new(|| {
        let runs = vec![OnceLock::new(); cases().len()];
        on_all_cores(runs.len(), |index| {
            let case = &cases()[index];
            runs[index].get_or_init(|| simulate_with(&case.mesh, &case.options(Backend::Cpu)));
        });
        runs
    });
    cases().iter().zip(RUNS.iter().map(|run| run.get().unwrap()))
}
