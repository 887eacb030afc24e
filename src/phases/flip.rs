//! Flip with Update: rotate the two triangles of each selected edge in place and repair the twins around.

use crate::NONE;
use crate::adjacency::{FLAGS, next, prev, unflagged};
use crate::star::Fans;

/// For each triangle its half-edge that flips, and the twin of that, or [`NONE`] twice.
pub(crate) type Selected = [u32; 2];

/// Flips the edges of these half-edges, those of `selected` once each, and moves the anchors of the fans with them.
pub(crate) fn flip(
    triangles: &mut [u32],
    twins: &mut [u32],
    fans: &mut Fans,
    selected: &[Selected],
    half_edges: &[u32],
) {
    for &h in half_edges {
        let [_, g] = selected[h as usize / 3];
        if !fans.table.is_empty() {
            for moved in [next(h), next(g)] {
                fans.move_anchor(triangles[moved as usize], moved, slot(selected, moved));
            }
        }
        flip_edge(triangles, twins, selected, h, g);
    }
}

/// Where the half-edge that an entry of `twins` names will be after the iteration: the half-edge after a
/// selected one moves into the place of the selected one's twin. A function of the state before the phase.
#[inline]
fn slot(selected: &[Selected], entry: u32) -> u32 {
    let x = unflagged(entry);
    if x == NONE {
        return NONE;
    }
    let [own, twin] = selected[x as usize / 3];
    if prev(x) == own { twin | (entry & FLAGS) } else { entry }
}

/// Flips one selected edge. Reads the twins of its own two triangles only; writes those, and the entries of
/// the neighbours that are not selected themselves.
fn flip_edge(triangles: &mut [u32], twins: &mut [u32], selected: &[Selected], h: u32, g: u32) {
    let [hn, hp, gn, gp] = [next(h), prev(h), next(g), prev(g)];
    let [c, d] = [triangles[hp as usize], triangles[gp as usize]];
    let outer = [
        (h, twins[gn as usize]),
        (hp, twins[hp as usize]),
        (g, twins[hn as usize]),
        (gp, twins[gp as usize]),
    ];
    for (inner, outer) in outer {
        twins[inner as usize] = slot(selected, outer);
        let x = unflagged(outer);
        if x != NONE {
            // Where there is nothing to write, a word that is written below; nothing could predict a branch.
            let place = if selected[x as usize / 3][0] == NONE { x } else { hn };
            twins[place as usize] = inner | (outer & FLAGS);
        }
    }
    triangles[hn as usize] = d;
    triangles[gn as usize] = c;
    twins[hn as usize] = gn;
    twins[gn as usize] = hn;
}
