//! cos β in the layout that the shaders read.

use crate::predicates::cosine_fraction;

/// Bits of a digit; the same in `digits.wgsl` and `numbers.wgsl`.
pub(in crate::engine) const DIGIT_BITS: u32 = 13;

pub(in crate::engine) struct Cosine {
    /// For the filter.
    pub(in crate::engine) rounded: f32,
    pub(in crate::engine) sign: i32,
    /// Whether β is 180°, which allows every angle.
    pub(in crate::engine) is_of_any_angle: bool,
    /// |cos β| is exactly mantissa / power, each in digits.
    pub(in crate::engine) mantissa: [i32; 8],
    pub(in crate::engine) power: [i32; 8],
}

impl Cosine {
    pub(in crate::engine) fn new(cos: f64) -> Self {
        let (mantissa, shift) = cosine_fraction(cos);
        let mut power = [0; 8];
        // The last digit holds up to 2^15, for the largest shift, 106.
        let index = (shift / DIGIT_BITS).min(7);
        power[index as usize] = 1 << (shift - DIGIT_BITS * index);
        Self {
            rounded: cos as f32,
            sign: if cos == 0.0 { 0 } else { cos.signum() as i32 },
            is_of_any_angle: cos == -1.0,
            mantissa: [0, 1, 2, 3, 4, 5, 6, 7]
                .map(|i| (mantissa.checked_shr(DIGIT_BITS * i).unwrap_or(0) & 8191) as i32),
            power,
        }
    }
}
