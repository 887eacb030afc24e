//! What a repair of triangles that have turned over gives a session.

use crate::mesh::Slot;

/// A mesh after a repair.
pub(crate) struct Repaired {
    /// Each slot whose triangle is new or has other neighbours. The twins have the flags of locked edges.
    pub(crate) slots: Vec<Slot>,
    /// The locked edges that it has: first locks, then edges of constraints.
    pub(crate) locked_edges: Vec<[u32; 2]>,
    /// The number of these locks.
    pub(crate) locks: usize,
    /// The others, each with the smaller vertex first. Sorted.
    pub(crate) lost: Vec<[u32; 2]>,
}

/// In the npm package, one module gives it to another as words: the slots, the locked edges, those that are lost, then the
/// numbers of slots, of locks and of words of lost edges. None if nothing changes.
#[cfg(all(target_arch = "wasm32", any(feature = "js-session", feature = "js-untangle")))]
impl Repaired {
    #[cfg(feature = "js-untangle")]
    pub(crate) fn words(&self) -> Vec<u32> {
        let (locked, lost) = (self.locked_edges.as_flattened(), self.lost.as_flattened());
        let numbers = [self.slots.len() as u32, self.locks as u32, lost.len() as u32];
        [self.slots.as_flattened(), locked, lost, &numbers].concat()
    }

    #[cfg(feature = "js-session")]
    pub(super) fn of_words(mut words: Vec<u32>) -> Option<Self> {
        let (lost, locks, slots) = (words.pop()?, words.pop()?, words.pop()?);
        let end = words.len() - lost as usize;
        let lost = tuples_after(&mut words, end);
        let locked_edges = tuples_after(&mut words, 7 * slots as usize);
        Some(Self { slots: tuples_after(&mut words, 0), locked_edges, locks: locks as usize, lost })
    }
}

/// Takes tuples from the end of words.
#[cfg(all(target_arch = "wasm32", feature = "js-session"))]
fn tuples_after<const N: usize>(words: &mut Vec<u32>, start: usize) -> Vec<[u32; N]> {
    let tuples = words[start..].as_chunks().0.to_vec();
    words.truncate(start);
    tuples
}
