//! The extremes of many words: they check indices and coordinates in one pass.

use crate::system::threads::Threads;

/// The bits of a 32-bit float without its sign.
pub(crate) const MAGNITUDE: u32 = !(1 << 31);

/// The extremes of some words, each after `&` with a mask. `largest` is the largest. `below` is 1 less than the
/// smallest that is not 0; `u32::MAX` if all are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Extremes {
    pub(crate) below: u32,
    pub(crate) largest: u32,
}

impl Extremes {
    const NONE: Self = Self { below: u32::MAX, largest: 0 };

    pub(crate) fn of(words: &[u32], mask: u32, threads: &Threads) -> Self {
        let pieces = threads.map(words.len(), |piece| Self::of_piece(&words[piece], mask));
        pieces.into_iter().fold(Self::NONE, |all, ends| Self {
            below: all.below.min(ends.below),
            largest: all.largest.max(ends.largest),
        })
    }

    fn and(self, word: u32) -> Self {
        Self { below: self.below.min(word.wrapping_sub(1)), largest: self.largest.max(word) }
    }

    #[cfg(not(target_feature = "simd128"))]
    fn of_piece(words: &[u32], mask: u32) -> Self {
        words.iter().fold(Self::NONE, |ends, word| ends.and(word & mask))
    }

    /// The same; the compiler would not vectorize it.
    #[cfg(target_feature = "simd128")]
    fn of_piece(words: &[u32], mask: u32) -> Self {
        use std::arch::wasm32::{u32x4_max, u32x4_min, u32x4_splat, u32x4_sub, v128, v128_and};
        let (fours, rest) = words.as_chunks::<4>();
        let (masks, ones) = (u32x4_splat(mask), u32x4_splat(1));
        let (mut below, mut largest) = (u32x4_splat(u32::MAX), u32x4_splat(0));
        for &four in fours {
            let four: v128 = zerocopy::transmute!(four);
            let four = v128_and(four, masks);
            below = u32x4_min(below, u32x4_sub(four, ones));
            largest = u32x4_max(largest, four);
        }
        let [below, largest]: [[u32; 4]; 2] = [below, largest].map(|lanes| zerocopy::transmute!(lanes));
        let ends = below.into_iter().zip(largest).fold(Self::NONE, |all, (below, largest)| Self {
            below: all.below.min(below),
            largest: all.largest.max(largest),
        });
        rest.iter().fold(ends, |ends, word| ends.and(word & mask))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ends_are_those_of_a_sorted_list(words in proptest::collection::vec(any::<u32>(), 0..40), zeros in 0usize..3) {
            let all: Vec<u32> = words.iter().copied().chain(std::iter::repeat_n(1 << 31, zeros)).collect();
            let mut sorted: Vec<u32> = all.iter().map(|word| word & MAGNITUDE).collect();
            sorted.sort_unstable();
            let below = sorted.iter().find(|&&word| word > 0).map_or(u32::MAX, |word| word - 1);
            let expected = Extremes { below, largest: sorted.last().copied().unwrap_or(0) };
            prop_assert_eq!(Extremes::of(&all, MAGNITUDE, &Threads::default()), expected);
        }
    }
}
