//! The iterations of a submission, and the history that the device writes of them.

use super::params::Params;
use crate::engine::gpu::Form;
use std::sync::atomic::{AtomicU32, Ordering};

/// The most iterations with a dispatch for each phase in one submission.
pub(super) const BATCH: u32 = 12;
/// The most iterations that the tail runs after the batch.
pub(super) const TAIL: u32 = 256;
/// The same on drivers that end loops too early.
pub(super) const SHORT_TAIL: u32 = 4;

// The layout of the history in words, as in `state.wgsl`.
pub(super) const TURNED: usize = 3;
pub(super) const COUNTS: usize = 11;
pub(super) const AREAS: usize = 8;
pub(super) const SEVERAL_FANS: usize = 12;
pub(super) const FLIPPED: usize = 13;
pub(super) const ENTRIES: usize = 15;
pub(super) const ENTRY_WORDS: usize = 4;
pub(super) const HISTORY_WORDS: usize = ENTRIES + ENTRY_WORDS * (1 + BATCH as usize + TAIL as usize);

/// How an iteration finds the triangles that are due, as in `state.wgsl`.
pub(super) const LISTED: u32 = 1;
pub(super) const ALL: u32 = 2;

/// The entry of the history that the next iteration starts from: FLIPS, LENGTH, DUE, RAN.
pub(super) type Entry = [u32; ENTRY_WORDS];

/// How many iterations the last run of each form and size needed before the tail could take over. The next run of the
/// same kind gets no more dispatches, because each takes time, also if nothing is left to do. Results do not depend on it.
/// In a browser it stays empty.
#[derive(Default)]
pub(super) struct Batches([[AtomicU32; 32]; Form::COUNT]);

impl Batches {
    fn of(&self, form: Form, triangles: u32) -> &AtomicU32 {
        &self.0[form.index()][(u32::BITS - 1 - triangles.max(1).leading_zeros()) as usize]
    }

    /// The iterations that the last run needed; 0 if there was none.
    pub(super) fn needed(&self, form: Form, triangles: u32) -> u32 {
        self.of(form, triangles).load(Ordering::Relaxed)
    }

    /// The iterations with dispatches of their own in the first submission of a run.
    pub(super) fn first(&self, form: Form, triangles: u32) -> u32 {
        match self.needed(form, triangles) {
            0 => BATCH,
            needed => needed.min(BATCH),
        }
    }

    /// Takes over the history of a submission with these parameters.
    pub(super) fn learn(&self, form: Form, params: &Params, history: &[u32]) {
        let is_ready =
            |entry: &[u32]| entry[0] == 0 || (entry[2] == LISTED && entry[1] <= params.tail_length);
        let entries = history[ENTRIES..].chunks_exact(ENTRY_WORDS).take_while(|entry| entry[3] == 1);
        let needed = params.first + entries.take_while(|entry| !is_ready(entry)).count() as u32;
        self.of(form, params.triangles).store(needed.max(1), Ordering::Relaxed);
    }
}
