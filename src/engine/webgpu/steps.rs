//! The steps of a submission: a uniform tells each dispatch which iteration or task it is for.

use crate::engine::MOST_ITERATIONS;

/// Words per step: an alignment of dynamic offsets that every device supports.
const WORDS: u32 = 64;

/// The same numbers as in `doubts.wgsl`.
#[derive(Clone, Copy)]
pub(super) enum Step {
    /// The iteration of this index in the submission.
    Iterate(u32),
    /// The iteration in which the tail has paused, or the census after exact arithmetic.
    Resume,
    Census,
    Prepare,
}

impl Step {
    /// All steps, each at its offset.
    pub(super) fn words() -> Vec<u32> {
        let all = (0..MOST_ITERATIONS).map(Self::Iterate).chain([Self::Resume, Self::Census, Self::Prepare]);
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
        let slot = match self {
            Self::Iterate(index) => index,
            other => MOST_ITERATIONS - 1 + other.index_and_task()[1],
        };
        4 * WORDS * slot
    }
}
