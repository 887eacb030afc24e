//! Divides a triangle around a vertex that comes back, in a repair and in the rounds of an update.

use crate::NONE;
use crate::mesh::half_edge::{FLAGS, unflagged};

/// Lets a half-edge and an entry meet. A locked edge stays locked.
pub(super) fn join(twins: &mut [u32], h: u32, entry: u32) {
    twins[h as usize] = entry;
    if entry != NONE {
        twins[unflagged(entry) as usize] = h | entry & FLAGS;
    }
}

/// Divides the triangle in the first slot around a vertex. The edge from its corner i then belongs to the i-th slot, and
/// is its first half-edge. Returns its corners.
pub(super) fn divide(
    triangles: &mut [u32],
    twins: &mut [u32],
    slots @ [t, ..]: [u32; 3],
    vertex: u32,
) -> [u32; 3] {
    let [corners, outer] = [&*triangles, &*twins].map(|words| [0, 1, 2].map(|i| words[3 * t as usize + i]));
    for i in 0..3 {
        let h = 3 * slots[i];
        triangles[h as usize..][..3].copy_from_slice(&[corners[i], corners[(i + 1) % 3], vertex]);
        join(twins, h, outer[i]);
        join(twins, h + 1, 3 * slots[(i + 1) % 3] + 2);
    }
    corners
}
