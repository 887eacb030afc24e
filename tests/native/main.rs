//! The native tests that share a process. Each module is a level of `npm test`, described by the first sentence of its
//! file; `cargo test --test native -- families::` runs one. A module names the features that it needs in a line
//! `#![cfg(…)]`: without the GPU engine and the command line, the others compile in a fraction of the time.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![cfg_attr(
    not(all(target_os = "linux", feature = "cli", feature = "gpu", feature = "threads")),
    allow(dead_code, unused_imports, reason = "the modules that are left do not use all of the shared ones")
)]

// Shared by the levels.
mod command;
mod matrix;
#[path = "../meshes/mod.rs"]
mod meshes;
#[path = "../points/mod.rs"]
mod points_of;
mod runs;
mod simulation;

// The levels.
mod adjacency;
mod areas;
mod audit;
mod cli;
mod cli_input;
mod cli_output;
mod cli_points;
mod cli_quiet;
mod cli_signals;
mod constraint_paths;
mod constraints;
mod crossings;
mod delaunator;
mod digests;
mod dirty;
mod edge_states;
mod engines;
mod examples;
mod families;
mod folds;
mod fuzz_seeds;
mod lattices;
mod locks;
mod memory;
mod moving;
mod parity;
mod points;
mod positions;
mod quads;
mod threads;
mod untangle;
mod wedges;
mod worst_cases;
