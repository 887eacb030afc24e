//! The iterations of a submission, and the history that the device writes of them.

/// Iterations with a dispatch for each phase in one submission.
pub(super) const BATCH: u32 = 12;
/// The most iterations that the tail runs after the batch.
pub(super) const TAIL: u32 = 256;
/// The same on drivers that end loops too early.
pub(super) const SHORT_TAIL: u32 = 4;
/// How often the tail may pause in a submission for exact arithmetic.
pub(super) const PAUSES: u32 = 8;

// The layout of the history in words, as in `state.wgsl`.
pub(super) const COUNTS: usize = 11;
pub(super) const AREAS: usize = 8;
pub(super) const SEVERAL_FANS: usize = 12;
pub(super) const FLIPPED: usize = 13;
pub(super) const ENTRIES: usize = 15;
pub(super) const ENTRY_WORDS: usize = 4;
pub(super) const HISTORY_WORDS: usize = ENTRIES + ENTRY_WORDS * (1 + BATCH as usize + TAIL as usize);

/// The entry of the history that the next iteration starts from: FLIPS, LENGTH, BUILT, RAN.
pub(super) type Entry = [u32; ENTRY_WORDS];
