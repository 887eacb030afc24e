//! Loops on several threads. The result does not depend on their number: only one piece of a loop writes each word, and
//! the lists of the pieces are joined in order.

use crate::Error;
#[cfg(feature = "threads")]
use rayon::prelude::*;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::AtomicU32;
#[cfg(not(all(target_arch = "wasm32", target_feature = "atomics")))]
use std::sync::atomic::Ordering::Relaxed;
#[cfg(feature = "threads")]
use std::sync::{Arc, Mutex};

/// The fewest items of a piece. With fewer, one thread finishes before another starts. In debug builds it is small, so
/// that small meshes test the threads.
pub(crate) const FEWEST: usize = if cfg!(debug_assertions) { 4 } else { RELEASED };
const RELEASED: usize = 4096;

/// The fewest triangles of a mesh on several threads, for the same reason.
#[cfg(feature = "threads")]
const FEWEST_TRIANGLES: usize = 16 * FEWEST;

/// Pieces per thread, so that no thread waits long for another.
const PIECES: usize = 8;

/// The largest number of threads that a caller may choose.
pub const MOST_THREADS: usize = 256;

/// Checks a number of threads: 1 to [`MOST_THREADS`].
///
/// # Errors
/// [`Error::Option`].
pub(crate) fn checked(count: usize) -> Result<NonZeroUsize, Error> {
    NonZeroUsize::new(count).filter(|_| count <= MOST_THREADS).ok_or_else(|| {
        let message = format!("{count} is not a number of threads: give 1 to {MOST_THREADS}");
        Error::Option { option: "threads", message }
    })
}

/// A number of threads, by default one per core. Without the feature `threads` it is always one, which the compiler
/// knows.
#[derive(Clone, Default)]
pub(crate) struct Threads {
    /// `None`: the threads of the process.
    #[cfg(feature = "threads")]
    pool: Option<Arc<rayon::ThreadPool>>,
    #[cfg(feature = "threads")]
    is_one: bool,
}

impl Threads {
    /// As many threads as `option` says, or one per core; at most one per piece of the triangles. In a browser,
    /// JavaScript has started the threads already.
    ///
    /// # Errors
    /// [`Error::Option`] if the system cannot start the threads.
    #[cfg_attr(
        any(not(feature = "threads"), target_arch = "wasm32"),
        expect(unused_variables, reason = "there is one thread, or JavaScript has started them")
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
                let message = format!("cannot start {count} threads: {error}");
                Error::Option { option: "threads", message }
            })?;
            return Ok(Self { pool: Some(Arc::new(pool)), is_one: false });
        }
        Ok(Self::default().for_triangles(triangles))
    }

    /// The number of threads of [`Threads::new`].
    #[cfg_attr(not(feature = "threads"), expect(unused_variables, reason = "there is only one thread"))]
    pub(crate) fn count_for(option: Option<NonZeroUsize>, triangles: usize) -> usize {
        #[cfg(feature = "threads")]
        if let Some(count) = option.filter(|_| triangles >= FEWEST_TRIANGLES) {
            return count.get().min(triangles / FEWEST);
        }
        Self::default().for_triangles(triangles).count()
    }

    /// One thread.
    pub(crate) fn one() -> Self {
        Self::default().for_triangles(0)
    }

    /// The same threads, or one thread if the mesh is too small for several.
    #[cfg_attr(not(feature = "threads"), expect(unused_variables, reason = "there is only one thread"))]
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

    /// Runs `work` on one of the threads. Its loops then find the other threads awake.
    pub(crate) fn enter<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        #[cfg(feature = "threads")]
        if self.count() > 1 {
            return self.install(|| rayon::scope(|_| work()));
        }
        work()
    }

    /// Runs `work`, whose rayon loops use the threads of the pool.
    #[cfg(feature = "threads")]
    fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match &self.pool {
            Some(pool) => pool.install(work),
            None => work(),
        }
    }

    /// Calls `work` with each of `0..count`. Not generic: rayon is most of what a loop takes to compile.
    #[cfg(feature = "threads")]
    fn run(&self, count: usize, work: &(dyn Fn(usize) + Sync)) {
        self.install(|| (0..count).into_par_iter().with_max_len(1).for_each(work));
    }

    /// The results of `work` for each piece of a loop over `0..len`, in order.
    pub(crate) fn map<T: Send>(&self, len: usize, work: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
        if len < 2 * FEWEST || self.count() == 1 {
            return vec![work(0..len)];
        }
        self.map_each(self.pieces(len, FEWEST), work)
    }

    /// The pieces of a loop over `0..len`: at least one, each of at least `fewest` items.
    pub(crate) fn pieces(&self, len: usize, fewest: usize) -> Vec<Range<usize>> {
        // `count` may start the threads, so it is not called for one piece.
        let count = if len < 2 * fewest { 1 } else { self.count() };
        cut(len, if count == 1 { 1 } else { PIECES * count }, fewest)
    }

    /// The results of `work` for each item, in order.
    pub(crate) fn map_each<I: Send, T: Send>(&self, items: Vec<I>, work: impl Fn(I) -> T + Sync) -> Vec<T> {
        #[cfg(feature = "threads")]
        if items.len() > 1 && self.count() > 1 {
            let cells = Vec::from_iter(items.into_iter().map(|item| Mutex::new((Some(item), None))));
            self.run(cells.len(), &|i| {
                // Nobody else locks it.
                if let Ok(mut cell) = cells[i].lock() {
                    cell.1 = cell.0.take().map(&work);
                }
            });
            return cells.into_iter().filter_map(|cell| cell.into_inner().ok()?.1).collect();
        }
        items.into_iter().map(work).collect()
    }

    /// As [`Threads::map_each`], for items in a slice.
    pub(crate) fn each<I: Send, T: Send>(
        &self,
        items: &mut [I],
        work: impl Fn(&mut I) -> T + Sync,
    ) -> Vec<T> {
        self.map_each(items.iter_mut().collect(), work)
    }

    /// Runs both, on a thread each if there are several.
    pub(crate) fn join<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        #[cfg(feature = "threads")]
        if self.count() > 1 {
            return self.install(|| rayon::join(first, second));
        }
        (first(), second())
    }

    /// The results of `item` for `0..len`, in order. The threads share the first access to the memory.
    pub(crate) fn collect<T: Send>(&self, len: usize, item: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        #[cfg(feature = "threads")]
        if len >= 2 * FEWEST && self.count() > 1 {
            return self.install(|| (0..len).into_par_iter().with_min_len(FEWEST).map(item).collect());
        }
        (0..len).map(item).collect()
    }

    /// `len` zeros. With one thread, the system provides zeroed memory at the first access.
    pub(crate) fn zeros(&self, len: usize) -> Vec<u32> {
        if self.is_one() { vec![0; len] } else { self.collect(len, |_| 0) }
    }

    /// A copy of `items`, as [`Threads::append`] makes it.
    pub(crate) fn copied<T: Copy + Send + Sync>(&self, items: &[T]) -> Vec<T> {
        let mut copy = Vec::with_capacity(items.len());
        self.append(&mut copy, items);
        copy
    }

    /// The items of lists, one after the other.
    pub(crate) fn joined<T: Copy + Send + Sync>(&self, mut lists: Vec<Vec<T>>) -> Vec<T> {
        if let [list] = &mut *lists {
            return std::mem::take(list);
        }
        let mut all = Vec::with_capacity(lists.iter().map(Vec::len).sum());
        lists.iter().for_each(|list| self.append(&mut all, list));
        all
    }

    /// Copies `items` to `all` from index `first` on: over what is there, then behind it.
    #[cfg(all(feature = "gpu", not(target_arch = "wasm32")))]
    pub(crate) fn put<T: Copy + Send + Sync>(&self, all: &mut Vec<T>, first: usize, items: &[T]) {
        let (over, behind) = items.split_at(items.len().min(all.len().saturating_sub(first)));
        let size = over.len().div_ceil(PIECES * self.count()).max(FEWEST);
        let there = all[first..].chunks_mut(size).zip(over.chunks(size));
        self.map_each(there.collect(), |(there, over)| there[..over.len()].copy_from_slice(over));
        self.append(all, behind);
    }

    /// Appends a copy of `items` to `all`. The threads share the first access to the memory, which takes several times
    /// as long as copying.
    pub(crate) fn append<T: Copy + Send + Sync>(&self, all: &mut Vec<T>, items: &[T]) {
        #[cfg(feature = "threads")]
        if items.len() >= 2 * FEWEST && self.count() > 1 {
            return self.install(|| all.par_extend(items.par_iter().with_min_len(FEWEST)));
        }
        all.extend_from_slice(items);
    }
}

/// Whether the threads of the process could be started; set at the first try.
#[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
static HAS_STARTED: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

/// The number of threads of the process, or of the pool of the present thread. Starts the threads at the first call. If
/// that fails, rayon would panic, so the result is 1.
#[cfg(all(feature = "threads", not(target_arch = "wasm32")))]
fn count_of_process() -> usize {
    use std::error::Error;
    let start = || match rayon::ThreadPoolBuilder::new().build_global() {
        Ok(()) => true,
        // An error without a source means that they are already started.
        Err(error) => error.source().is_none(),
    };
    let is_there = rayon::current_thread_index().is_some() || *HAS_STARTED.get_or_init(start);
    if is_there { rayon::current_num_threads() } else { 1 }
}

/// The number of threads that JavaScript has started.
#[cfg(all(feature = "threads", target_arch = "wasm32"))]
fn count_of_process() -> usize {
    rayon::current_num_threads()
}

/// Cuts `0..len` into at least one and at most `most` pieces of at least `fewest` items.
#[inline]
fn cut(len: usize, most: usize, fewest: usize) -> Vec<Range<usize>> {
    // Lets the compiler remove the rest in builds without threads.
    if most == 1 {
        return std::iter::once(0..len).collect();
    }
    let pieces = most.min(len / fewest).max(1);
    let size = len.div_ceil(pieces);
    (0..pieces).map(|i| len.min(i * size)..len.min((i + 1) * size)).collect()
}

/// A word that several threads may read and write. After a loop, all threads see the values written in it.
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

/// WebAssembly has only sequentially consistent atomic accesses, which are several times as slow. Its plain accesses
/// are what Rust calls relaxed.
#[cfg(all(target_arch = "wasm32", target_feature = "atomics"))]
#[expect(unsafe_code, reason = "Rust offers no other plain access to an atomic")]
impl Word for AtomicU32 {
    #[inline(always)]
    fn get(&self) -> u32 {
        // SAFETY: the pointer is valid and aligned. WebAssembly defines plain accesses that race, and accesses to
        // aligned words do not tear. Volatile accesses are neither removed nor merged.
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

    /// No thread starts without work.
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

    /// JavaScript checks them before it has loaded a module.
    #[test]
    fn limits_are_those_of_the_npm_package() {
        for (file, line) in [
            ("settings.ts", format!("MOSTITERATIONS = {};", crate::engine::MOST_ITERATIONS)),
            ("cores.ts", format!("MOSTTHREADS = {};", crate::MOST_THREADS)),
            ("cores.ts", format!("FEWESTTRIANGLES = {};", FEWEST_TRIANGLES / FEWEST * RELEASED)),
            ("cores.ts", format!("FEWESTEACH = {RELEASED};")),
        ] {
            let path = format!("{}/src/js/{file}", env!("CARGO_MANIFEST_DIR"));
            let text = std::fs::read_to_string(&path).unwrap().replace('_', "");
            assert!(text.contains(&line), "{path} has no {line}");
        }
    }

    #[cfg(feature = "gpu")]
    #[test]
    fn copies_replace_what_is_there() {
        for (len, there) in [(0, 0), (0, 3), (7, 3), (7, 9), (1000, 0), (1000, 500), (1000, 2000)] {
            for count in [1, 2, 3, 8] {
                let mut all = Vec::from_iter(0..1 + there);
                Threads::new(NonZeroUsize::new(count), usize::MAX).unwrap().put(&mut all, 1, &vec![7; len]);
                let (copied, rest) = all[1..].split_at(len);
                assert!(all[0] == 0 && copied.iter().all(|&item| item == 7));
                assert!(rest.iter().copied().eq(1 + len..1 + there));
            }
        }
    }

    #[test]
    fn both_run() {
        for count in [1, 2, 3, 8] {
            let threads = Threads::new(NonZeroUsize::new(count), usize::MAX).unwrap();
            for len in [0, 1, 7, 8, 1000] {
                let (mut low, mut high) = (vec![0; len], vec![0; len]);
                let sides = threads.join(|| low.fill(1), || high.fill(2));
                assert_eq!((sides, low, high), (((), ()), vec![1; len], vec![2; len]));
            }
        }
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
