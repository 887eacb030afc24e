//! Loops on several threads. What they give does not depend on how many there are: each word is written by one piece of
//! a loop, and the lists of the pieces are joined in order.

use crate::Error;
#[cfg(feature = "threads")]
use rayon::prelude::*;
use std::num::NonZeroUsize;
use std::ops::Range;
#[cfg(feature = "threads")]
use std::sync::Arc;
use std::sync::atomic::AtomicU32;
#[cfg(not(all(target_arch = "wasm32", target_feature = "atomics")))]
use std::sync::atomic::Ordering::Relaxed;

/// A piece has so many items at least: fewer are done before another thread has woken up. Without optimisation it has
/// few, so that small meshes test the threads.
pub(crate) const FEWEST: usize = if cfg!(debug_assertions) { 4 } else { 4096 };

/// A mesh on several threads has so many triangles at least, for the same reason.
#[cfg(feature = "threads")]
const FEWEST_TRIANGLES: usize = 16 * FEWEST;

/// Pieces for each thread, so that none waits long for another.
const PIECES: usize = 8;

/// How many threads there are; by default one for each core. Without the feature `threads` it is one, and the compiler
/// knows.
#[derive(Clone, Default)]
pub(crate) struct Threads {
    /// Those of the process, where there is none.
    #[cfg(feature = "threads")]
    pool: Option<Arc<rayon::ThreadPool>>,
    #[cfg(feature = "threads")]
    is_one: bool,
}

impl Threads {
    /// As many as an option says, but no more than there are pieces of so many triangles; or one for each core. In a
    /// browser JavaScript has started as many as the option says.
    ///
    /// # Errors
    /// [`Error::Option`] where the system has not as many as the option says.
    #[cfg_attr(
        any(not(feature = "threads"), target_arch = "wasm32"),
        expect(unused_variables, reason = "they are there already, or it is one")
    )]
    pub(crate) fn new(option: Option<NonZeroUsize>, triangles: usize) -> Result<Self, Error> {
        #[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
        if let Some(count) = option
            && triangles >= FEWEST_TRIANGLES
        {
            let count = count.get().min(triangles / FEWEST);
            if count == 1 {
                return Ok(Self::one());
            }
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().map_err(|error| {
                let message = format!("{count} could not be started: {error}");
                Error::Option { option: "threads", message }
            })?;
            return Ok(Self { pool: Some(Arc::new(pool)), is_one: false });
        }
        Ok(Self::default().for_triangles(triangles))
    }

    /// How many [`Threads::new`] gives.
    #[cfg_attr(not(feature = "threads"), expect(unused_variables, reason = "it is one, whatever it says"))]
    pub(crate) fn count_for(option: Option<NonZeroUsize>, triangles: usize) -> usize {
        #[cfg(feature = "threads")]
        if let Some(count) = option.filter(|_| triangles >= FEWEST_TRIANGLES) {
            return count.get().min(triangles / FEWEST);
        }
        Self::default().for_triangles(triangles).count()
    }

    /// One, without any of a pool.
    pub(crate) fn one() -> Self {
        Self::default().for_triangles(0)
    }

    /// Those that are worth while for so many triangles: one of them, where it has done before others have woken up.
    #[cfg_attr(not(feature = "threads"), expect(unused_variables, reason = "it is one, for any"))]
    pub(crate) fn for_triangles(self, count: usize) -> Self {
        #[cfg(feature = "threads")]
        return Self { is_one: self.is_one || count < FEWEST_TRIANGLES, ..self };
        #[cfg(not(feature = "threads"))]
        self
    }

    pub(crate) fn is_one(&self) -> bool {
        self.count() == 1
    }

    fn count(&self) -> usize {
        #[cfg(feature = "threads")]
        if self.is_one {
            return 1;
        }
        #[cfg(feature = "threads")]
        return self.pool.as_ref().map_or_else(count_of_process, |pool| pool.current_num_threads());
        #[cfg(not(feature = "threads"))]
        1
    }

    /// Does `work`, which has loops, on one of the threads: they find the others awake.
    pub(crate) fn enter<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        #[cfg(feature = "threads")]
        if self.count() > 1 {
            return self.install(|| rayon::scope(|_| work()));
        }
        work()
    }

    /// Does `work`, the loops of which are rayon's: they run on the threads of the pool.
    #[cfg(feature = "threads")]
    fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// What `work` gives for each piece of a loop over `0..len`, in order.
    pub(crate) fn map<T: Send>(&self, len: usize, work: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
        if len < 2 * FEWEST || self.count() == 1 {
            return vec![work(0..len)];
        }
        self.map_each(self.pieces(len, FEWEST), work)
    }

    /// The pieces of a loop over `0..len`, at least one, of so many items at least.
    pub(crate) fn pieces(&self, len: usize, fewest: usize) -> Vec<Range<usize>> {
        // Threads that there are none of yet are not started for one piece.
        let count = if len < 2 * fewest { 1 } else { self.count() };
        cut(len, if count == 1 { 1 } else { PIECES * count }, fewest)
    }

    /// What `work` gives for each item, in order.
    pub(crate) fn map_each<I: Send, T: Send>(&self, items: Vec<I>, work: impl Fn(I) -> T + Sync) -> Vec<T> {
        #[cfg(feature = "threads")]
        if items.len() > 1 && self.count() > 1 {
            return self.install(|| items.into_par_iter().with_max_len(1).map(&work).collect());
        }
        items.into_iter().map(work).collect()
    }

    /// As [`Threads::map_each`], for items that stay where they are.
    pub(crate) fn each<I: Send, T: Send>(
        &self,
        items: &mut [I],
        work: impl Fn(&mut I) -> T + Sync,
    ) -> Vec<T> {
        self.map_each(items.iter_mut().collect(), work)
    }

    /// What `item` gives for each of `0..len`, in order, in memory that the threads touch for the first time together.
    pub(crate) fn collect<T: Send>(&self, len: usize, item: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        #[cfg(feature = "threads")]
        if len >= 2 * FEWEST && self.count() > 1 {
            return self.install(|| (0..len).into_par_iter().with_min_len(FEWEST).map(item).collect());
        }
        (0..len).map(item).collect()
    }

    /// So many words. One thread has the system give them as zeros, when they are touched first.
    pub(crate) fn zeros(&self, len: usize) -> Vec<u32> {
        if self.is_one() { vec![0; len] } else { self.collect(len, |_| 0) }
    }

    /// Appends a copy of `items` to `all`, whose memory the threads touch for the first time together: that takes several
    /// times as long as the copying.
    pub(crate) fn append<T: Copy + Send + Sync>(&self, all: &mut Vec<T>, items: &[T]) {
        #[cfg(feature = "threads")]
        if items.len() >= 2 * FEWEST && self.count() > 1 {
            return self.install(|| all.par_extend(items.par_iter().with_min_len(FEWEST)));
        }
        all.extend_from_slice(items);
    }

    /// Appends some lists to `all`, in order.
    pub(crate) fn append_all<T: Copy + Send + Sync>(&self, all: &mut Vec<T>, lists: Vec<Vec<T>>) {
        all.reserve_exact(lists.iter().map(Vec::len).sum());
        lists.into_iter().for_each(|list| self.append(all, &list));
    }
}

/// Whether the threads of the process could be started, once that has been tried.
#[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
static HAS_STARTED: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

/// The threads of the process, or of the pool that this is a thread of. They are started if there are none; where that
/// fails, rayon would panic, and it is one.
#[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
fn count_of_process() -> usize {
    use std::error::Error;
    let start = || match rayon::ThreadPoolBuilder::new().build_global() {
        Ok(()) => true,
        // Without a source it says that there are some.
        Err(error) => error.source().is_none(),
    };
    let is_there = rayon::current_thread_index().is_some() || *HAS_STARTED.get_or_init(start);
    if is_there { rayon::current_num_threads() } else { 1 }
}

/// JavaScript has started them.
#[cfg(all(feature = "threads", target_arch = "wasm32"))]
fn count_of_process() -> usize {
    rayon::current_num_threads()
}

/// `0..len` in up to `most` pieces of `fewest` items at least, but at least one.
#[inline]
fn cut(len: usize, most: usize, fewest: usize) -> Vec<Range<usize>> {
    // So that the compiler leaves out the rest where there are no threads.
    if most == 1 {
        return std::iter::once(0..len).collect();
    }
    let pieces = most.min(len / fewest).max(1);
    let size = len.div_ceil(pieces);
    (0..pieces).map(|i| len.min(i * size)..len.min((i + 1) * size)).collect()
}

/// A word that several threads may read and write. What one has written the others see after the loop at the latest.
pub(crate) trait Word {
    fn get(&self) -> u32;
    fn set(&self, word: u32);
}

#[cfg(not(all(target_arch = "wasm32", target_feature = "atomics")))]
impl Word for AtomicU32 {
    #[inline(always)]
    fn get(&self) -> u32 {
        self.load(Relaxed)
    }

    #[inline(always)]
    fn set(&self, word: u32) {
        self.store(word, Relaxed);
    }
}

/// WebAssembly has no relaxed accesses but its plain ones: the others are sequentially consistent, and take several times
/// as long.
#[cfg(all(target_arch = "wasm32", target_feature = "atomics"))]
#[expect(unsafe_code, reason = "Rust has no other way to a plain access")]
impl Word for AtomicU32 {
    #[inline(always)]
    fn get(&self) -> u32 {
        // SAFETY: the place is valid and aligned. WebAssembly defines plain accesses that race, and those of aligned words
        // do not tear; volatile ones are those that are written here.
        unsafe { self.as_ptr().read_volatile() }
    }

    #[inline(always)]
    fn set(&self, word: u32) {
        // SAFETY: as above.
        unsafe { self.as_ptr().write_volatile(word) }
    }
}

/// Words that several threads may write.
pub(crate) fn shared(words: &mut [u32]) -> &[AtomicU32] {
    zerocopy::transmute_mut!(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_the_whole_in_order() {
        for len in [0, 1, 7, 8, 1000] {
            for most in [1, 2, 3, 64] {
                let pieces = cut(len, most, 4);
                assert!((1..=most).contains(&pieces.len()));
                assert!(pieces.into_iter().flatten().eq(0..len));
            }
        }
    }

    /// No thread is started that has no work.
    #[test]
    fn no_more_threads_than_pieces() {
        for (count, triangles, want) in [
            (256, 2, 1),
            (256, FEWEST_TRIANGLES - 1, 1),
            (256, FEWEST_TRIANGLES, 16),
            (3, FEWEST_TRIANGLES, 3),
            (1, usize::MAX, 1),
            (40, 32 * FEWEST, 32),
        ] {
            let threads = Threads::new(NonZeroUsize::new(count), triangles).unwrap();
            assert_eq!(threads.count(), want);
            assert_eq!(Threads::count_for(NonZeroUsize::new(count), triangles), want);
            assert_eq!(threads.pool.is_some(), want > 1);
        }
        assert_eq!(Threads::new(None, FEWEST_TRIANGLES - 1).unwrap().count(), 1);
    }

    #[test]
    fn copies_are_appended_in_order() {
        for len in [0, 1, 7, 8, 1000] {
            for count in [1, 2, 3, 8] {
                let mut all = vec![7];
                Threads::new(NonZeroUsize::new(count), usize::MAX)
                    .unwrap()
                    .append(&mut all, &Vec::from_iter(0..len));
                assert!(all.into_iter().eq([7].into_iter().chain(0..len)));
            }
        }
    }
}
