//! Untangles a mesh in the plane: makes triangles that have turned over positive again, whatever way the vertices went.
//! The vertices stay where they are, and so does the boundary.
//!
//! Flips alone cannot do it. So vertices of turned triangles are lifted out until all triangles are positive, and put
//! back where their points are. If all triangles of a component are positive and its boundary does not cross itself,
//! they cover each point inside once: then nothing overlaps, whatever came before.
//!
//! Nothing is added or removed: a vertex that is out keeps two slots for triangles.

mod constant;
mod divide;
mod frame;
mod lift;
mod locks;
mod put_back;
mod region;
mod repair;
mod sheet;
mod status;
mod sweep;
#[cfg(test)]
mod tests;

pub(crate) use constant::Constant;
#[cfg(test)]
pub(crate) use frame::CONSTANTS;
pub(crate) use frame::Frame;
pub(crate) use repair::{Untangled, may_be_tangled, untangled};
