//! A repair, from the triangles that have turned over to others.

use super::constant::Constant;
use super::lift::FREE;
use super::region::Search;
use super::sheet::Sheet;
use crate::mesh::Slot;
use crate::predicates::area_sign;
use crate::{Mesh, NONE};

/// Other triangles for a mesh.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Untangled {
    /// Each slot whose triangle is new or has other neighbours. The twins have the flags of locked edges.
    pub(crate) slots: Vec<Slot>,
    /// Locked edges that the mesh does not have any more, because no triangulation with them was found. Sorted.
    pub(crate) lost: Vec<[u32; 2]>,
}

/// Whether triangles of a mesh in the plane may have turned over: whether their signs differ, or one is zero.
pub(crate) fn may_be_tangled(mesh: &Mesh) -> bool {
    let (triangles, _) = mesh.triangles().as_chunks();
    let sign = |&corners: &[u32; 3]| {
        let [a, b, c] = mesh.positions().points2(corners);
        area_sign(a, b, c)
    };
    let mut signs = triangles.iter().map(sign);
    signs.next().is_some_and(|first| first.is_eq() || signs.any(|sign| sign != first))
}

/// Makes the triangles of a mesh in the plane positive, those of a component of negative area negative. `twins` are its
/// twins, with the flags of locked edges; `lost` are locked edges that it lost earlier. `None` if nothing changes.
///
/// Where the positions have no triangulation, few triangles stay turned over or flat. A component whose boundary overlaps
/// itself in such a way that two edges would join the same vertices keeps its triangles.
pub(crate) fn untangled(
    mesh: &Mesh,
    twins: &[u32],
    constant: &Constant,
    lost: Vec<[u32; 2]>,
) -> Option<Untangled> {
    let winding = constant.outline.winding(mesh);
    let (triangles, _) = mesh.triangles().as_chunks();
    let mut turned = Vec::new();
    // A filter would be a call for each triangle in the npm package.
    for (t, &corners) in (0..).zip(triangles) {
        let [a, b, c] = mesh.positions().points2(corners);
        if winding.relative(t, area_sign(a, b, c)).is_le() {
            turned.push(t);
        }
    }
    if turned.is_empty() && lost.is_empty() {
        return None;
    }
    let mut sheet = Sheet::new(mesh, constant, &winding, twins, lost);
    let mut claims = vec![FREE; triangles.len()];
    let anew = sheet.fill_anew(&turned);
    sheet.lift(&mut turned, &mut claims);
    if !turned.is_empty() {
        let mut search = Search::new(triangles.len());
        for t in turned {
            if !sheet.is_right(t) {
                sheet.grow(t, &mut search);
            }
        }
    }
    sheet.flip_all(anew.iter().flat_map(|t| 3 * t..3 * t + 3).filter(|&h| sheet.vertex(h) != NONE).collect());
    sheet.put_back(&mut claims, !anew.is_empty());
    sheet.undo_doubled(twins);
    sheet.bring_back();
    let slot = |&slot: &u32| {
        let ([a, b, c], first) = (sheet.corners(slot), 3 * slot as usize);
        [slot, a, b, c, sheet.twins[first], sheet.twins[first + 1], sheet.twins[first + 2]]
    };
    let slots = sheet.touched.iter().map(slot).collect();
    let lost = sheet.lost.into_iter().map(|lost| lost.edge).collect();
    Some(Untangled { slots, lost })
}
