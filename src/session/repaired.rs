//! What a repair of triangles that have turned over gives a session.

/// A mesh after a repair.
pub(crate) struct Repaired {
    pub(crate) triangles: Vec<u32>,
    /// Their twins, with the flags of locked edges.
    pub(crate) twins: Vec<u32>,
    /// The locked edges that it has: first locks, then edges of constraints.
    pub(crate) locked_edges: Vec<[u32; 2]>,
    /// The number of these locks.
    pub(crate) locks: usize,
    /// The others, each with the smaller vertex first. Sorted.
    pub(crate) lost: Vec<[u32; 2]>,
}

/// In the npm package, one module gives it to another as words: the triangles, their twins, the locked edges, those that
/// are lost, then the numbers of locks and of words of lost edges. None if nothing changes.
#[cfg(all(target_arch = "wasm32", any(feature = "js-session", feature = "js-untangle")))]
impl Repaired {
    #[cfg(feature = "js-untangle")]
    pub(crate) fn words(&self) -> Vec<u32> {
        let (locked, lost) = (self.locked_edges.as_flattened(), self.lost.as_flattened());
        let numbers = [self.locks as u32, lost.len() as u32];
        [&self.triangles, &self.twins, locked, lost, &numbers].concat()
    }

    /// `corners`: the number of corners of the triangles.
    #[cfg(feature = "js-session")]
    pub(super) fn of_words(mut words: Vec<u32>, corners: usize) -> Option<Self> {
        let (lost, locks) = (words.pop()?, words.pop()?);
        let end = words.len() - lost as usize;
        let lost = pairs_after(&mut words, end);
        let locked_edges = pairs_after(&mut words, 2 * corners);
        let twins = words.split_off(corners);
        Some(Self { triangles: words, twins, locked_edges, locks: locks as usize, lost })
    }
}

/// Takes pairs from the end of words.
#[cfg(all(target_arch = "wasm32", feature = "js-session"))]
#[inline(never)] // else the module is larger
fn pairs_after(words: &mut Vec<u32>, start: usize) -> Vec<[u32; 2]> {
    let pairs = words[start..].as_chunks().0.to_vec();
    words.truncate(start);
    pairs
}
