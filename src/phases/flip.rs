//! Flip with Update: rotate the two triangles of each selected edge in place and repair the twins around.

use crate::NONE;
use crate::adjacency::{FLAGS, next, prev, unflagged};
use crate::star::Fans;

/// Flips the selected edges of the active triangles, and moves the anchors of the fans with them.
pub(crate) fn flip(
    triangles: &mut [u32],
    twins: &mut [u32],
    fans: &mut Fans,
    selected: &[u32],
    active: impl Iterator<Item = u32>,
) {
    for t in active {
        let g = selected[t as usize];
        if g != NONE {
            let h = selected[g as usize / 3];
            if h < g {
                for moved in [next(h), next(g)] {
                    fans.move_anchor(triangles[moved as usize], moved, slot(selected, moved));
                }
                flip_edge(triangles, twins, selected, h, g);
            }
        }
    }
}

/// Where the half-edge that an entry of `twins` names will be after the iteration: the half-edge after a
/// selected one moves into the place of the selected one's twin. A function of the state before the phase.
fn slot(selected: &[u32], entry: u32) -> u32 {
    let x = unflagged(entry);
    if x == NONE {
        return NONE;
    }
    let g = selected[x as usize / 3];
    if g != NONE && x == next(selected[g as usize / 3]) { g | (entry & FLAGS) } else { entry }
}

/// Flips one selected edge. Reads the twins of its own two triangles only; writes those, and the entries of
/// the neighbours that are not selected themselves.
fn flip_edge(triangles: &mut [u32], twins: &mut [u32], selected: &[u32], h: u32, g: u32) {
    let [hn, hp, gn, gp] = [next(h), prev(h), next(g), prev(g)];
    let [outer_hn, outer_hp, outer_gn, outer_gp] = [hn, hp, gn, gp].map(|x| twins[x as usize]);
    let [c, d] = [hp, gp].map(|x| triangles[x as usize]);
    triangles[hn as usize] = d;
    triangles[gn as usize] = c;
    twins[hn as usize] = gn;
    twins[gn as usize] = hn;
    for (inner, outer) in [(h, outer_gn), (hp, outer_hp), (g, outer_hn), (gp, outer_gp)] {
        twins[inner as usize] = slot(selected, outer);
        let x = unflagged(outer);
        if x != NONE && selected[x as usize / 3] == NONE {
            twins[x as usize] = inner | (outer & FLAGS);
        }
    }
}
