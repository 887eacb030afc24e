//! Makes an existing triangle mesh Delaunay by flipping edges, without touching a vertex.
//!
//! ```
//! use edgeflip::{Dimension, Mesh, Options, make_delaunay};
//! use std::ops::ControlFlow;
//!
//! // A thin diamond, split along its long diagonal.
//! let positions = vec![-3.0, 0.0, 0.0, -1.0, 3.0, 0.0, 0.0, 1.0];
//! let mesh = Mesh::new(Dimension::Two, positions, vec![0, 1, 2, 0, 2, 3])?;
//! let outcome = make_delaunay(&mesh, &Options::default(), |_, _| ControlFlow::Continue(()))?;
//! assert_eq!((outcome.flips, outcome.remaining.total()), (1, 0));
//! # Ok::<(), edgeflip::Error>(())
//! ```
//!
//! `docs/architecture.md` lists the rooms of the crate, which are the folders of `src/`, from top to bottom. A room
//! imports only rooms below it.

mod engine;
mod engine_kind;
mod error;
pub mod families;
#[cfg(feature = "files")]
pub mod io;
mod mesh;
mod phases;
mod points;
mod predicates;
mod prepare;
pub mod quality;
mod session;
mod system;
#[cfg_attr(
    all(target_arch = "wasm32", feature = "js-session"),
    expect(dead_code, unused_imports, reason = "the engines call the rounds of an update only")
)]
mod untangle;
#[cfg(all(target_arch = "wasm32", feature = "js-values"))]
pub mod wasm;

#[cfg(feature = "baseline")]
pub use engine::select_on_cpu;
#[cfg(all(not(target_arch = "wasm32"), feature = "gpu"))]
pub use engine::{GpuBuffers, GpuDevice};
pub use engine_kind::EngineKind;
pub use error::Error;
pub use mesh::adjacency::Adjacency;
pub use mesh::dimension::Dimension;
pub use mesh::edges::Edges;
pub use mesh::half_edge::NONE;
pub use mesh::named_edges::LeftOut;
pub use mesh::plane::Plane;
pub use mesh::positions::Positions;
pub use mesh::{MAX_TRIANGLES, Mesh};
pub use phases::reason::{Reason, Reasons};
pub use points::options::PointOptions;
pub use points::session::PointSession;
pub use points::triangulation::{Triangulation, triangulate, triangulate_with};
pub use points::voronoi::Voronoi;
pub use predicates::cos_degrees;
pub use prepare::constraints::crossings::{Crossing, SplitCrossings, split_crossings};
pub use prepare::constraints::{Constrained, constrained};
pub use prepare::regions::{Regions, regions};
pub use prepare::reorient::reoriented;
pub use prepare::wedges::Wedges;
pub use prepare::weld::{Welded, welded};
pub use session::Session;
pub use session::edge_states::EdgeState;
#[cfg(not(target_arch = "wasm32"))]
pub use session::one_call::make_delaunay;
pub use session::options::{Backend, Options, Order};
pub use session::outcome::{Counters, Iteration, Outcome, Status, Timings};
#[cfg(not(target_arch = "wasm32"))]
pub use session::{EarlyGpu, close_gpu};
pub use system::threads::MOST_THREADS;
#[cfg(all(target_arch = "wasm32", feature = "js-session"))]
pub use wasm::session as js;
/// The version of wgpu that [`GpuDevice`] and [`GpuBuffers`] are of.
#[cfg(all(not(target_arch = "wasm32"), feature = "gpu"))]
pub use wgpu;
