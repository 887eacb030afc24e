//! Makes an existing triangle mesh Delaunay by flipping edges, without touching a vertex.
pub mod error;
pub mod families;
pub mod io;
pub mod mesh;
pub mod quality;
mod session;

pub use error::Error;
pub use mesh::{Dimension, Mesh, NONE};
pub use session::*;
