//! Half-edges, and the flags that an engine sets in its twins.
//!
//! Half-edge h belongs to triangle h / 3 and goes from `triangles[h]` to `triangles[next(h)]`.

/// "No half-edge": the twin of a half-edge on the boundary or on a frozen edge.
pub const NONE: u32 = u32::MAX;

/// The half-edge after `h` in its triangle.
#[inline]
pub fn next(h: u32) -> u32 {
    if is_first(h.wrapping_add(1)) { h - 2 } else { h + 1 }
}

/// The half-edge before `h` in its triangle.
#[inline]
pub fn prev(h: u32) -> u32 {
    if is_first(h) { h + 2 } else { h - 1 }
}

/// Whether a half-edge is the first of its triangle: whether its index is a multiple of 3. In WebAssembly, a product
/// with the inverse of 3 is several times as fast as a remainder.
#[inline(always)]
fn is_first(h: u32) -> bool {
    h.wrapping_mul(0xaaaa_aaab) <= u32::MAX / 3
}

/// The triangle of a half-edge: `h / 3`, in a form that is faster in WebAssembly.
#[inline(always)]
pub(crate) fn triangle_of(h: u32) -> u32 {
    ((u64::from(h) * 0xaaaa_aaab) >> 33) as u32
}

/// Flag in both entries of an engine's twins, for an edge that was over β in the input: it never flips, whatever its
/// angle becomes. The flag moves with the half-edges.
pub(crate) const CREASE: u32 = 1 << 31;

/// The same for an edge that the user has locked.
pub(crate) const LOCKED: u32 = 1 << 30;

/// All flags. Half-edges are smaller than the lowest flag.
pub(crate) const FLAGS: u32 = CREASE | LOCKED;

/// The half-edge in an entry of an engine's twins, without the flags.
#[inline]
pub(crate) fn unflagged(entry: u32) -> u32 {
    if entry == NONE { NONE } else { entry & !FLAGS }
}

/// Sets [`LOCKED`] in the entries of these half-edges, unless they have no twin.
pub(crate) fn lock(twins: &mut [u32], half_edges: &[u32]) {
    for &h in half_edges {
        let entry = &mut twins[h as usize];
        if *entry != NONE {
            *entry |= LOCKED;
        }
    }
}

/// The half-edges whose entries have [`LOCKED`].
pub(crate) fn locked(twins: &[u32]) -> Vec<u32> {
    let is_locked = |entry: u32| entry != NONE && entry & LOCKED != 0;
    (0..).zip(twins).filter(|&(_, &entry)| is_locked(entry)).map(|(h, _)| h).collect()
}
