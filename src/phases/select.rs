//! Select: an edge flips if it is the best of both its triangles, and no better edge would make the same new edge.

use super::state::{BLOCKED, Topology, key};
use crate::NONE;
use crate::mesh::half_edge::{next, prev};
use crate::mesh::star::{Star, any_in_either};

/// For each triangle, the twin of its half-edge that flips, or [`NONE`]. `best` is the result of
/// [`label`](super::label()).
pub(crate) fn select(mesh: Topology, iteration: u32, best: &[u32]) -> Vec<u32> {
    let key = |[h, g]: [u32; 2]| key(h.min(g), iteration);
    let selected = |t: u32| match mutual(best, t) {
        Some((h, g)) if !yields(mesh, key, [h, g], |t| mutual(best, t)) => g,
        _ => NONE,
    };
    (0..best.len() as u32).map(selected).collect()
}

/// The half-edge of triangle `t` whose edge is the best of both triangles of the edge, and the twin of this half-edge.
/// Two triangles that share two edges both keep the same one, because no two keys are equal.
fn mutual(best: &[u32], t: u32) -> Option<(u32, u32)> {
    let g = best[t as usize];
    if g >= BLOCKED {
        return None;
    }
    let h = best[g as usize / 3];
    (h < BLOCKED && h / 3 == t).then_some((h, g))
}

/// Whether an edge has to yield to another edge whose flip would join the same vertices c and d. The other edge is the
/// best of both its triangles, has a smaller key, and is opposite to a corner at c and to one at d. `mutual` returns
/// the half-edge of a triangle whose edge is the best of both triangles of the edge, and the twin of this half-edge.
pub(crate) fn yields(
    mesh: Topology,
    key: impl Fn([u32; 2]) -> u32,
    [h, g]: [u32; 2],
    mutual: impl Fn(u32) -> Option<(u32, u32)>,
) -> bool {
    let [c, d] = [h, g].map(|x| mesh.triangles[prev(x) as usize]);
    let mine = key([h, g]);
    let star = |corner| Star::new(mesh.triangles, mesh.twins, mesh.fans, corner);
    let wins = |corner: u32, far: u32| {
        mutual(corner / 3).is_some_and(|(x, y)| {
            x == next(corner) && mesh.triangles[prev(y) as usize] == far && key([x, y]) < mine
        })
    };
    any_in_either((star(prev(h)), |corner| wins(corner, d)), (star(prev(g)), |corner| wins(corner, c)))
}
