//! Creases, flagged before the first iteration: edges of the input over β. They never flip, even if flips around them
//! lower their angle.

use crate::mesh::half_edge::{CREASE, LOCKED, next, prev, unflagged};
use crate::predicates::Quad;
use crate::system::threads::{Threads, Word, shared};
use crate::{NONE, Positions};

/// Sets [`CREASE`] in both entries of `twins` for each interior edge whose triangles' normals differ by more than β,
/// and clears it for all other edges. Keeps [`LOCKED`]. `cos` is cos β; `positions` are 3D. No crease has a number that
/// is not finite; `has_infinite`: whether there may be one.
pub(crate) fn flag_creases(
    positions: &Positions,
    triangles: &[u32],
    twins: &mut [u32],
    cos: f64,
    has_infinite: bool,
    threads: &Threads,
) {
    let twins = shared(twins);
    threads.map(twins.len(), |piece| {
        for h in piece.start as u32..piece.end as u32 {
            let entry = twins[h as usize].get();
            let g = unflagged(entry);
            if g == NONE || g < h {
                continue;
            }
            let vertex = |x: u32| triangles[x as usize];
            let vertices = [vertex(h), vertex(next(h)), vertex(prev(h)), vertex(prev(g))];
            let points @ [a, b, c, d] = positions.points3(vertices);
            let is_left = has_infinite && !points.iter().all(|point| point.is_finite());
            let crease = if !is_left && Quad::new(a, b, c, d).is_over_angle(cos) { CREASE } else { 0 };
            let flags = entry & LOCKED | crease;
            twins[h as usize].set(g | flags);
            twins[g as usize].set(h | flags);
        }
    });
}
