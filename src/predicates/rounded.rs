//! Quotients rounded once: numbers of twice the precision give nearly all of them, with an error bound that proves the
//! rounding; integers give the rest.

use std::ops::{Add, Mul, Neg, Sub};

/// Unit roundoff of f64.
const U: f64 = f64::EPSILON / 2.0;

/// The sum of two numbers, of which the second is at most half a unit in the last place of the first.
#[derive(Clone, Copy, Debug)]
pub(super) struct Double {
    pub(super) high: f64,
    low: f64,
}

impl Double {
    /// `x - y`, exactly.
    #[inline(always)]
    pub(super) fn difference(x: f64, y: f64) -> Self {
        let high = x - y;
        let y_virtual = x - high;
        let x_virtual = high + y_virtual;
        Self { high, low: (x - x_virtual) + (y_virtual - y) }
    }

    /// `x + y`, exactly.
    #[inline(always)]
    fn sum(x: f64, y: f64) -> Self {
        Self::difference(x, -y)
    }

    /// `x + y`, exactly, where `x` is not less than `y` in magnitude.
    #[inline(always)]
    fn sum_of_ordered(x: f64, y: f64) -> Self {
        let high = x + y;
        Self { high, low: y - (high - x) }
    }

    /// `x · y`, exactly, by halves of 26 bits (Dekker, 1971).
    #[inline(always)]
    fn product(x: f64, y: f64) -> Self {
        let halves = |x: f64| {
            let scaled = 134_217_729.0 * x;
            let upper = scaled - (scaled - x);
            [upper, x - upper]
        };
        let ([a, b], [c, d]) = (halves(x), halves(y));
        let high = x * y;
        Self { high, low: ((a * c - high) + a * d + b * c) + b * d }
    }

    /// The same number in units of another power of two.
    #[inline(always)]
    pub(super) fn scaled(self, power_of_two: f64) -> Self {
        Self { high: self.high * power_of_two, low: self.low * power_of_two }
    }

    #[inline(always)]
    pub(super) fn abs(self) -> f64 {
        self.high.abs()
    }

    /// The quotient, off by at most 16 U² of itself.
    #[inline(always)]
    fn over(self, divisor: Self) -> Self {
        let first = self.high / divisor.high;
        let rest = self - divisor * Self { high: first, low: 0.0 };
        Self::sum_of_ordered(first, rest.high / divisor.high)
    }
}

// Joldes, Muller and Popescu, "Tight and rigorous error bounds for basic building blocks of double-word arithmetic"
// (2017): each result is off by at most 8 U² of itself.

impl Add for Double {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (highs, lows) = (Self::sum(self.high, other.high), Self::sum(self.low, other.low));
        let first = Self::sum_of_ordered(highs.high, highs.low + lows.high);
        Self::sum_of_ordered(first.high, lows.low + first.low)
    }
}

impl Neg for Double {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Double {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let Self { high, low } = Self::product(self.high, other.high);
        Self::sum_of_ordered(high, low + (self.high * other.low + self.low * other.high))
    }
}

/// Numbers in a unit that brings the largest of them near 1, and that unit. `None` near the ends of the range.
#[inline(always)]
pub(super) fn in_unit<const N: usize>(numbers: [Double; N]) -> Option<([Double; N], f64)> {
    let largest = numbers.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let power_of_two = f64::from_bits(largest.to_bits() >> 52 << 52);
    let is_usual = (1e-290..1e290).contains(&power_of_two);
    is_usual.then(|| (numbers.map(|x| x.scaled(1.0 / power_of_two)), power_of_two))
}

/// A polynomial of numbers up to about 4 that stand for exact ones: its value, and the sum of the magnitudes of its
/// terms. The value is off by at most 40 U² of that sum.
#[derive(Clone, Copy)]
pub(super) struct Polynomial {
    pub(super) value: Double,
    pub(super) size: f64,
}

impl Polynomial {
    #[inline(always)]
    pub(super) fn doubled(self) -> Self {
        Self { value: self.value.scaled(2.0), size: 2.0 * self.size }
    }
}

/// The cross product of two vectors.
#[inline(never)]
pub(super) fn cross([ax, ay]: [Double; 2], [bx, by]: [Double; 2]) -> Polynomial {
    Polynomial { value: ax * by - ay * bx, size: ax.abs() * by.abs() + ay.abs() * bx.abs() }
}

/// `base` + `unit` · `numerator` / `denominator`, rounded to the nearest f64, where that is certain.
#[inline(never)]
pub(super) fn rounded(base: f64, numerator: Polynomial, denominator: Polynomial, unit: f64) -> Option<f64> {
    // What underflows is off by less than 2^-1000, because all factors are at most about 4.
    let error = |size: f64| 40.0 * U * U * size + 1e-300;
    let (above, below) = (error(numerator.size), error(denominator.size));
    let divisor = denominator.value.abs();
    let quotient = numerator.value.over(denominator.value);
    // With N and D for the exact numerator and denominator, and the computed ones off by δN and δD, the quotient is off
    // by (δN - N/D · δD) over the computed denominator. D is at least 3/4 of that, so that N/D is at most 4/3 of the
    // computed quotient and of δN over it. The division adds 16 U².
    let error = (2.0 * above + 3.0 * quotient.abs() * below) / divisor + 32.0 * U * U * quotient.abs();
    let quotient = quotient.scaled(unit);
    let sum = Double::sum(base, quotient.high);
    let low = sum.low + quotient.low;
    let sum = Double::sum(sum.high, low);
    // The sum of the two low parts is rounded, and the parts of the quotient may have underflowed.
    let error = error * unit + 2.0 * U * low.abs() + f64::MIN_POSITIVE;
    certain(sum, error, 4.0 * below < divisor)
}

/// The same in f64, for products of rounded numbers: the numerator and the denominator, each with the sum of the magnitudes
/// of its terms, are off by at most 8 U of that sum, if nothing but these terms underflows.
#[inline(always)]
pub(super) fn rounded_quickly(base: f64, numerator: [f64; 2], denominator: [f64; 2]) -> Option<f64> {
    let [above, below] = [numerator[1], denominator[1]].map(|size| 8.0 * U * size + f64::MIN_POSITIVE);
    let quotient = numerator[0] / denominator[0];
    let divisor = denominator[0].abs();
    let error = (2.0 * above + 3.0 * quotient.abs() * below) / divisor + 2.0 * U * quotient.abs();
    certain(Double::sum(base, quotient), error + f64::MIN_POSITIVE, 4.0 * below < divisor)
}

/// The high part, if every number that is so near to the sum is rounded to it.
#[inline(always)]
fn certain(Double { high, low }: Double, error: f64, is_known: bool) -> Option<f64> {
    // The sums with the error are rounded.
    let error = 1.01 * (error + 2.0 * U * U * high.abs());
    (is_known && high + (low + error) == high && high + (low - error) == high).then_some(high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use proptest::prelude::*;

    /// A number of twice the precision in units of 2^-400.
    fn integer(x: Double) -> BigInt {
        [x.high, x.low].map(of).iter().sum()
    }

    fn of(x: f64) -> BigInt {
        let (mantissa, exponent) = super::super::exact::decode(x);
        if mantissa == 0 { BigInt::ZERO } else { BigInt::from(mantissa) << (exponent + 400) }
    }

    fn double() -> impl Strategy<Value = Double> {
        let part = || (-1.0f64..1.0, -30i32..1).prop_map(|(x, e)| libm::scalbn(x, e));
        (part(), part(), -60i32..-53)
            .prop_map(|(x, y, e)| Double::sum(x, libm::scalbn(y * x, e)))
            .prop_filter("not zero", |x| x.high != 0.0)
    }

    proptest! {
        #[test]
        fn operations_keep_their_bounds(x in double(), y in double()) {
            let (p, q) = (integer(x), integer(y));
            let is_near = |computed: BigInt, exact: BigInt, bound: u32| {
                let difference: BigInt = (computed - &exact) << 106;
                difference.magnitude() <= (exact * bound).magnitude()
            };
            prop_assert!(is_near(integer(x + y), &p + &q, 8));
            prop_assert!(is_near(integer(x - y), &p - &q, 8));
            prop_assert!(is_near(integer(x * y) << 400, &p * &q, 8));
            prop_assert!(is_near(integer(x.over(y)) * &q, p << 400, 16));
            prop_assert_eq!(integer(Double::product(x.high, y.high)) << 400, of(x.high) * of(y.high));
        }
    }
}
