//! Select: an edge flips if it is the best of both its triangles and no better one makes the same new edge.

use super::{BLOCKED, Topology, key};
use crate::NONE;
use crate::adjacency::{next, prev};
use crate::star::{Star, any_in_either};

/// Writes `selected[t]` for each active triangle t: the twin of its edge that flips, or [`NONE`].
///
/// `best` of an inactive triangle must be [`NONE`].
pub(crate) fn select(
    mesh: Topology,
    iteration: u32,
    active: impl Iterator<Item = u32>,
    best: &[u32],
    selected: &mut [u32],
) {
    for t in active {
        selected[t as usize] = match mutual(best, t) {
            Some((h, g)) if !yields(mesh, iteration, best, h, g) => g,
            _ => NONE,
        };
    }
}

/// The half-edge of triangle `t`, and its twin, that is the best of both its triangles. Where two triangles
/// share two edges both take the same one, since keys do not tie.
fn mutual(best: &[u32], t: u32) -> Option<(u32, u32)> {
    let g = best[t as usize];
    if g >= BLOCKED {
        return None;
    }
    let h = best[g as usize / 3];
    (h < BLOCKED && h / 3 == t).then_some((h, g))
}

/// Whether another selected edge with a smaller key would join the same two vertices c and d. One of its
/// triangles has a corner at c, the other one at d, and it lies opposite to both.
fn yields(mesh: Topology, iteration: u32, best: &[u32], h: u32, g: u32) -> bool {
    let [c, d] = [h, g].map(|x| mesh.triangles[prev(x) as usize]);
    let mine = key(h.min(g), iteration);
    let star = |corner| Star::new(mesh.triangles, mesh.twins, mesh.fans, corner);
    let wins = |corner: u32, far: u32| {
        mutual(best, corner / 3).is_some_and(|(x, y)| {
            x == next(corner) && mesh.triangles[prev(y) as usize] == far && key(x.min(y), iteration) < mine
        })
    };
    any_in_either((star(prev(h)), |corner| wins(corner, d)), (star(prev(g)), |corner| wins(corner, c)))
}
