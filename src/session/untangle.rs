//! Triangles that have turned over become positive again, where the option `untangle` holds.

use super::untangler::Untangler;
use crate::{Dimension, Error, Mesh, Options};
use std::sync::Arc;
#[cfg(not(all(target_arch = "wasm32", feature = "js-session")))]
use {
    crate::mesh::adjacency::Adjacency, crate::mesh::half_edge, crate::mesh::named_edges::half_edges,
    crate::session::locks, crate::system::threads::Threads, crate::untangle::may_be_tangled,
};

/// What a session needs to repair its mesh.
#[derive(Default)]
pub(super) struct Held {
    /// Locked edges that the mesh does not have at present, each with the smaller vertex first. Sorted.
    pub(super) lost: Vec<[u32; 2]>,
    pub(super) untangler: Untangler,
    /// Whether the last positions needed a repair.
    pub(super) was_tangled: bool,
}

/// Untangles a mesh before its first run, if the options say so. In the npm package, the module of the repair has done
/// it, by [`begin`].
///
/// # Errors
/// [`Error::Option`] for a mesh in space, and those of [`begin`].
pub(super) fn at_start(mesh: &mut Arc<Mesh>, options: &mut Options) -> Result<Held, Error> {
    if options.untangle != Some(true) {
        return Ok(Held::default());
    }
    if mesh.dimension() == Dimension::Three {
        let message = "only a mesh of dimension 2 can be untangled".to_owned();
        return Err(Error::Option { option: "untangle", message });
    }
    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    let lost = std::mem::take(&mut options.lost_edges);
    #[cfg(not(all(target_arch = "wasm32", feature = "js-session")))]
    let lost = begin(mesh, options)?;
    Ok(Held { lost, ..Held::default() })
}

/// Untangles a mesh in the plane. Then `options.locked_edges` are all locks that it still has. Returns those that it has
/// lost, each with the smaller vertex first, sorted.
///
/// # Errors
/// Those of [`locks::edges`], and [`Error::Option`] for an edge to lock that the mesh does not have.
#[cfg(not(all(target_arch = "wasm32", feature = "js-session")))]
pub(crate) fn begin(mesh: &mut Arc<Mesh>, options: &mut Options) -> Result<Vec<[u32; 2]>, Error> {
    if !may_be_tangled(mesh) {
        return Ok(Vec::new());
    }
    options.locked_edges = locks::edges(mesh, options)?;
    let mut twins = Adjacency::of_triangles(mesh.vertex_count(), mesh.triangles(), &Threads::one()).twins;
    half_edge::lock(&mut twins, &half_edges(mesh, &options.locked_edges)?);
    let locks = (&*options.locked_edges, options.locked_edges.len());
    let Some(repaired) = Untangler::default().repaired(mesh, &twins, locks, &[])? else {
        return Ok(Vec::new());
    };
    *mesh = Arc::new(Mesh::clone(mesh).with_slots(&repaired.slots, &mut twins));
    // The triangles have moved, so these lists name others now. Their edges are locked by name.
    (options.locked_triangles, options.groups) = (Vec::new(), Vec::new());
    options.locked_edges = repaired.locked_edges;
    Ok(repaired.lost)
}
