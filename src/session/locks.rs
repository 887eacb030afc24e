//! Locked edges never flip. The user names them one by one, by their triangles, by groups of triangles, or as
//! constraints, which come in first.

use crate::mesh::Mesh;
use crate::mesh::buckets::for_each_edge;
use crate::mesh::half_edge::next;
use crate::session::memory_bounds;
use crate::system::memory;
use crate::{Error, LeftOut, Options, SplitCrossings, Welded, constrained, split_crossings};
use std::mem;
use std::sync::Arc;

/// The edges that `options` lock, each by its two vertices: `locked_edges` first, then the edges of `locked_triangles`
/// and those between `groups`. [`half_edges`](crate::mesh::named_edges::half_edges) finds them in the mesh.
///
/// # Errors
/// [`Error::Option`] for a triangle that does not exist, and for `groups` of the wrong length.
pub(crate) fn edges(mesh: &Mesh, options: &Options) -> Result<Vec<[u32; 2]>, Error> {
    let Options { locked_edges, locked_triangles, groups, .. } = options;
    let (triangles, _) = mesh.triangles().as_chunks::<3>();
    let mut edges = locked_edges.clone();
    for &triangle in locked_triangles {
        let Some(&[a, b, c]) = triangles.get(triangle as usize) else {
            let message = format!("there is no triangle {triangle}; the mesh has {}", triangles.len());
            return Err(Error::Option { option: "locked_triangles", message });
        };
        edges.extend([[a, b], [b, c], [c, a]]);
    }
    if !groups.is_empty() && groups.len() != triangles.len() {
        let message = format!("it has {} numbers, the mesh has {} triangles", groups.len(), triangles.len());
        return Err(Error::Option { option: "groups", message });
    }
    if groups.iter().any(|group| *group != groups[0]) {
        for_each_edge(mesh.vertex_count(), mesh.triangles(), |half_edges| {
            let group = |h: u32| groups[h as usize / 3];
            if half_edges.iter().any(|&h| group(h) != group(half_edges[0])) {
                edges.push([half_edges[0], next(half_edges[0])].map(|h| mesh.triangles()[h as usize]));
            }
        });
    }
    Ok(edges)
}

/// What constraints have changed before a run.
#[derive(Default)]
pub(crate) struct BroughtIn {
    /// The mesh before, and the options with the constraints: what the audit compares with, until vertices move.
    pub(crate) before: Option<(Arc<Mesh>, Options)>,
    /// How many of the locked edges are locks; the others are edges of constraints.
    pub(crate) locks: usize,
    pub(crate) crossed_edges: u64,
    pub(crate) deviation: f64,
    pub(crate) left_out: Vec<LeftOut>,
}

/// Brings the constraints of `options` into the mesh. Then, or without constraints, `options.locked_edges` are all locks.
///
/// # Errors
/// Those of [`edges`] and [`constrained`].
pub(crate) fn bring_in(mesh: &mut Arc<Mesh>, options: &mut Options) -> Result<BroughtIn, Error> {
    // In the npm package, the module of `edgeflip/files` has brought them in.
    if cfg!(all(target_arch = "wasm32", feature = "js-session")) || options.constraints.is_empty() {
        options.locked_edges = edges(mesh, options)?;
        // Their edges are locked by name. Later, these lists may name other triangles.
        (options.locked_triangles, options.groups) = (Vec::new(), Vec::new());
        return Ok(BroughtIn { locks: options.locked_edges.len(), ..BroughtIn::default() });
    }
    memory::check(memory_bounds::bytes(mesh, options))?;
    let locks = edges(mesh, options)?;
    let Options { skips_constraints, constraint_tolerance, threads, .. } = *options;
    let made =
        constrained(mesh, &options.constraints, &locks, skips_constraints, constraint_tolerance, threads)?;
    let before = (mem::replace(mesh, Arc::new(made.mesh)), mem::take(options));
    // The flips have moved triangles, and their locks are edges by now.
    *options = Options {
        locked_edges: made.locked_edges,
        locked_triangles: Vec::new(),
        groups: Vec::new(),
        constraints: Vec::new(),
        ..before.1.clone()
    };
    Ok(BroughtIn {
        before: Some(before),
        locks: made.locks,
        crossed_edges: made.crossed_edges,
        deviation: made.deviation,
        left_out: made.left_out,
    })
}

impl Options {
    /// Brings the constraints in, with a vertex where two of them cross, for a run of [`SplitCrossings::mesh`]: then the
    /// locked edges of these options are all their locks and the edges of the chains.
    ///
    /// # Errors
    /// Those of [`split_crossings`]; [`Error::Option`] for locks that the mesh does not have. Then nothing has changed.
    pub fn split_crossings(&mut self, mesh: &Mesh) -> Result<SplitCrossings, Error> {
        let mut locked_edges = edges(mesh, self)?;
        let split = split_crossings(mesh, &self.constraints, &locked_edges, self.skips_constraints)?;
        locked_edges.extend(split.constraint_edges());
        (self.locked_edges, self.constraints) = (locked_edges, Vec::new());
        // Triangles have changed, and their locks are edges by now.
        (self.locked_triangles, self.groups) = (Vec::new(), Vec::new());
        Ok(split)
    }
}

impl Welded {
    /// Adds to the locks of `options` the edges and triangles that have to stay. On entry, the locked edges and
    /// the constraints of `options` name vertices of the mesh before the weld; this call renumbers these vertices.
    pub fn constrain(&self, options: &mut Options) {
        for edges in [&mut options.locked_edges, &mut options.constraints] {
            for vertex in edges.as_flattened_mut() {
                *vertex = self.places.get(*vertex as usize).copied().unwrap_or(*vertex);
            }
        }
        options.locked_edges.extend_from_slice(self.wedges.locked_edges());
        options.locked_triangles.extend_from_slice(self.wedges.locked_triangles());
    }
}
