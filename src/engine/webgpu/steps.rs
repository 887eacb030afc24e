//! What the dispatches of a submission are about.

use super::history::BATCH;

/// Words from one step to the next: the alignment of a dynamic offset that every device offers.
const WORDS: u32 = 64;

/// As in `doubts.wgsl`.
#[derive(Clone, Copy)]
pub(super) enum Step {
    /// The iteration of this index in the batch.
    Iterate(u32),
    /// The iteration that the tail has paused in, or the census once exact arithmetic has decided the rest.
    Resume,
    Census,
    Prepare,
}

impl Step {
    /// All of them, each at its place.
    pub(super) fn words() -> Vec<u32> {
        let all = (0..BATCH).map(Self::Iterate).chain([Self::Resume, Self::Census, Self::Prepare]);
        all.flat_map(|step| {
            let mut words = [0; WORDS as usize];
            words[..2].copy_from_slice(&step.index_and_task());
            words
        })
        .collect()
    }

    fn index_and_task(self) -> [u32; 2] {
        match self {
            Self::Iterate(index) => [index, 0],
            Self::Resume => [0, 1],
            Self::Census => [0, 2],
            Self::Prepare => [0, 3],
        }
    }

    /// Its dynamic offset.
    pub(super) fn offset(self) -> u32 {
        let place = match self {
            Self::Iterate(index) => index,
            other => BATCH - 1 + other.index_and_task()[1],
        };
        4 * WORDS * place
    }
}
