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
//! The rooms: [`Mesh`] is checked input, in [`Positions`] of 32 or 64 bits; `adjacency` finds twins, `star` walks around
//! a vertex, `winding` and `frozen` know what a dirty mesh adds, `embedded` what a clean one spares, `locks` what the
//! user wants; `predicates` decide exactly; `phases` are the four phases of an iteration, `engine` runs them on the CPU,
//! on several `threads`, or through the shaders of the same names; `session` is the loop, `options` and `outcome` are what goes in and out.
//! Beside them: [`reoriented`] turns triangles towards one side, [`welded`] joins vertices at one place, [`Wedges`] keeps attributes of corners through flips, [`quality`] measures and audits, [`io`] reads and writes, [`families`] generates; [`Edges`] lists
//! the edges as the paper does, [`EdgeState`] is what each of them waits for; `js`, `js_webgl2`, `js_audit` and `js_files` are what the npm
//! package calls, each in a WebAssembly module of its own, and `js_values` is what they share.

mod adjacency;
mod edge_states;
mod edges;
mod embedded;
mod ends;
mod engine;
mod error;
pub mod families;
mod frozen;
pub mod io;
#[cfg(all(target_arch = "wasm32", feature = "js-session"))]
pub mod js;
#[cfg(all(target_arch = "wasm32", feature = "js-audit"))]
pub mod js_audit;
#[cfg(all(target_arch = "wasm32", feature = "js-files"))]
pub mod js_files;
#[cfg(all(target_arch = "wasm32", any(feature = "js-session", feature = "js-webgl2")))]
mod js_promise;
#[cfg(all(target_arch = "wasm32", feature = "js-threads"))]
pub mod js_threads;
#[cfg(all(target_arch = "wasm32", feature = "js-values"))]
mod js_values;
#[cfg(all(target_arch = "wasm32", feature = "js-webgl2"))]
pub mod js_webgl2;
mod locks;
mod memory;
mod mesh;
mod options;
mod outcome;
mod phases;
mod positions;
mod predicates;
pub mod quality;
mod reorient;
mod session;
mod star;
mod threads;
mod wedges;
mod weld;
mod winding;

pub use adjacency::Adjacency;
pub use edge_states::EdgeState;
pub use edges::Edges;
pub use error::Error;
pub use mesh::{Dimension, MAX_TRIANGLES, Mesh, NONE};
pub use options::{Backend, MOST_THREADS, Options, Order};
pub use outcome::{Iteration, Outcome, Reason, Reasons, Status, Timings};
pub use positions::Positions;
pub use predicates::cos_degrees;
pub use reorient::reoriented;
pub use session::Session;
#[cfg(not(target_arch = "wasm32"))]
pub use session::{EarlyGpu, close_gpu, make_delaunay};
pub use wedges::Wedges;
pub use weld::{Welded, welded};
