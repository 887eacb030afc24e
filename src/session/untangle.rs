//! Triangles that have turned over become positive again, where the option `untangle` holds.

use crate::mesh::adjacency::Adjacency;
use crate::mesh::half_edge;
use crate::mesh::named_edges::{half_edges, ordered};
use crate::session::locks;
use crate::system::threads::Threads;
use crate::untangle::{Constant, Untangled, may_be_tangled, untangled};
use crate::{Dimension, Error, Mesh, Options};
use std::sync::Arc;

/// The locked edges of a session whose triangles other triangles have replaced.
#[derive(Clone, Default)]
pub(super) struct Held {
    /// All of them, and how many of them are locks, not constraints. `None` as long as the mesh has them all.
    all: Option<(Vec<[u32; 2]>, usize)>,
    /// Those that the mesh does not have at present, each with the smaller vertex first. Sorted.
    pub(super) lost: Vec<[u32; 2]>,
    /// Filled in when it is needed.
    constant: Option<Arc<Constant>>,
}

impl Held {
    /// Other triangles for a mesh with these twins, which have the flags of locked edges; `None` if it keeps its own.
    pub(super) fn untangled(&mut self, mesh: &Mesh, twins: Vec<u32>) -> Option<Untangled> {
        let constant = self.constant.get_or_insert_with(|| Arc::new(Constant::new(mesh, &twins)));
        untangled(mesh, twins, constant, self.lost.clone())
    }

    /// Lets the options name the edges that are locked in a mesh with other triangles. `locks` is the number of them
    /// that are locks; the others are edges of constraints.
    pub(super) fn take_over(&mut self, lost: Vec<[u32; 2]>, options: &mut Options, locks: &mut usize) {
        // The triangles have moved, so these lists name others now. Their edges are locked by name.
        (options.locked_triangles, options.groups) = (Vec::new(), Vec::new());
        if lost == self.lost {
            return;
        }
        let (all, count) = self.all.get_or_insert_with(|| {
            // Only locks can have been lost before.
            let (held, constraints) = options.locked_edges.split_at(*locks);
            ([held, &self.lost, constraints].concat(), held.len() + self.lost.len())
        });
        let is_kept = |edge: &&[u32; 2]| lost.binary_search(&ordered(**edge)).is_err();
        *locks = all[..*count].iter().filter(is_kept).count();
        options.locked_edges = all.iter().filter(is_kept).copied().collect();
        self.lost = lost;
    }
}

/// Untangles a mesh before its first run, if the options say so.
///
/// # Errors
/// [`Error::Option`] for a mesh in space, and those of [`locks::edges`].
pub(super) fn at_start(mesh: &mut Arc<Mesh>, options: &mut Options) -> Result<Held, Error> {
    let mut held = Held::default();
    if options.untangle != Some(true) {
        return Ok(held);
    }
    if mesh.dimension() == Dimension::Three {
        let message = "only a mesh of dimension 2 can be untangled".to_owned();
        return Err(Error::Option { option: "untangle", message });
    }
    if !may_be_tangled(mesh) {
        return Ok(held);
    }
    options.locked_edges = locks::edges(mesh, options)?;
    let mut twins = Adjacency::of_triangles(mesh.vertex_count(), mesh.triangles(), &Threads::one()).twins;
    half_edge::lock(&mut twins, &half_edges(mesh, &options.locked_edges)?);
    if let Some(Untangled { triangles, lost, .. }) = held.untangled(mesh, twins) {
        *mesh = Arc::new(mesh.flipped(triangles));
        // The triangles have moved, so these lists name others now. Their edges are locked by name.
        (options.locked_triangles, options.groups) = (Vec::new(), Vec::new());
        options.locked_edges.retain(|&edge| lost.binary_search(&ordered(edge)).is_err());
        held.lost = lost;
    }
    Ok(held)
}
