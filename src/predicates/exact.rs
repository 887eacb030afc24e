//! Exact integers: points with floating-point coordinates are integers times one power of two, and every predicate is
//! the sign of a polynomial in their differences.

use num_bigint::{BigInt, Sign};
use std::cmp::Ordering;

/// What a polynomial needs of the numbers it is evaluated in.
pub(super) trait Ring {
    /// `mantissa * 2^shift`.
    fn new(mantissa: i64, shift: u32) -> Self;
    fn add(&self, other: &Self) -> Self;
    fn sub(&self, other: &Self) -> Self;
    fn mul(&self, other: &Self) -> Self;
    fn sign(&self) -> Ordering;
}

impl Ring for i128 {
    fn new(mantissa: i64, shift: u32) -> Self {
        Self::from(mantissa) << shift
    }
    fn add(&self, other: &Self) -> Self {
        self + other
    }
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    fn mul(&self, other: &Self) -> Self {
        self * other
    }
    fn sign(&self) -> Ordering {
        self.cmp(&0)
    }
}

/// Of any size: where the exponents are far apart.
impl Ring for BigInt {
    fn new(mantissa: i64, shift: u32) -> Self {
        Self::from(mantissa) << shift
    }
    fn add(&self, other: &Self) -> Self {
        self + other
    }
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    fn mul(&self, other: &Self) -> Self {
        self * other
    }
    fn sign(&self) -> Ordering {
        match Self::sign(self) {
            Sign::Minus => Ordering::Less,
            Sign::NoSign => Ordering::Equal,
            Sign::Plus => Ordering::Greater,
        }
    }
}

/// A signed integer of up to `N` 64-bit limbs: sign and magnitude, `len` limbs in use, the least
/// significant first. The callers choose `N` so that no result is larger.
#[derive(Clone, Copy, Debug)]
pub(super) struct Int<const N: usize> {
    negative: bool,
    len: usize,
    limbs: [u64; N],
}

impl<const N: usize> Int<N> {
    const ZERO: Self = Self { negative: false, len: 0, limbs: [0; N] };

    fn trimmed(mut self) -> Self {
        while self.len > 0 && self.limbs[self.len - 1] == 0 {
            self.len -= 1;
        }
        self
    }

    fn negated(mut self) -> Self {
        self.negative = !self.negative;
        self
    }

    fn compare_magnitude(&self, other: &Self) -> Ordering {
        self.len.cmp(&other.len).then_with(|| {
            let differs = (0..self.len).rev().find(|&i| self.limbs[i] != other.limbs[i]);
            differs.map_or(Ordering::Equal, |i| self.limbs[i].cmp(&other.limbs[i]))
        })
    }

    /// |self| + |other| with the sign of `self`.
    fn add_magnitude(&self, other: &Self) -> Self {
        let mut result = Self { negative: self.negative, len: self.len.max(other.len), ..Self::ZERO };
        let mut carry = false;
        for i in 0..result.len {
            let (sum, first) = self.limbs[i].overflowing_add(other.limbs[i]);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            result.limbs[i] = sum;
            carry = first | second;
        }
        if carry {
            result.limbs[result.len] = 1;
            result.len += 1;
        }
        result
    }

    /// |self| - |other| with the sign of `self`, where |self| >= |other|.
    fn sub_magnitude(&self, other: &Self) -> Self {
        let mut result = Self { negative: self.negative, len: self.len, ..Self::ZERO };
        let mut borrow = false;
        for i in 0..result.len {
            let (difference, first) = self.limbs[i].overflowing_sub(other.limbs[i]);
            let (difference, second) = difference.overflowing_sub(u64::from(borrow));
            result.limbs[i] = difference;
            borrow = first | second;
        }
        result.trimmed()
    }
}

impl<const N: usize> Ring for Int<N> {
    fn new(mantissa: i64, shift: u32) -> Self {
        let mut result = Self { negative: mantissa < 0, ..Self::ZERO };
        let wide = u128::from(mantissa.unsigned_abs()) << (shift % 64);
        let at = (shift / 64) as usize;
        result.limbs[at] = wide as u64;
        result.limbs[at + 1] = (wide >> 64) as u64;
        result.len = at + 2;
        result.trimmed()
    }

    fn add(&self, other: &Self) -> Self {
        if self.negative == other.negative {
            self.add_magnitude(other)
        } else if self.compare_magnitude(other).is_ge() {
            self.sub_magnitude(other)
        } else {
            other.sub_magnitude(self)
        }
    }

    fn sub(&self, other: &Self) -> Self {
        self.add(&other.negated())
    }

    fn mul(&self, other: &Self) -> Self {
        let mut result = Self { negative: self.negative != other.negative, ..Self::ZERO };
        for i in 0..self.len {
            let mut carry = 0u128;
            for j in 0..other.len {
                carry +=
                    u128::from(self.limbs[i]) * u128::from(other.limbs[j]) + u128::from(result.limbs[i + j]);
                result.limbs[i + j] = carry as u64;
                carry >>= 64;
            }
            if carry > 0 {
                result.limbs[i + other.len] = carry as u64;
            }
        }
        result.len = (self.len + other.len).min(N);
        result.trimmed()
    }

    fn sign(&self) -> Ordering {
        match (self.len, self.negative) {
            (0, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        }
    }
}

/// `x = mantissa * 2^exponent` with an odd mantissa; zero is `(0, i32::MAX)`, so that it never is the
/// smallest exponent.
pub(super) fn decode(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let magnitude = if field == 0 { fraction } else { fraction | 1 << 52 };
    if magnitude == 0 {
        return (0, i32::MAX);
    }
    let zeros = magnitude.trailing_zeros();
    let mantissa = magnitude >> zeros;
    (if x < 0.0 { -mantissa } else { mantissa }, field.max(1) - 1075 + zeros as i32)
}

#[cfg(test)]
thread_local! {
    /// The largest `bits` of [`Differences`] since the test set it to 0.
    pub(super) static WIDEST: std::cell::Cell<u32> = const { std::cell::Cell::new(0) };
}

/// Differences of numbers as integers times one power of two, a unit that no sign depends on.
pub(super) struct Differences<const K: usize> {
    /// Mantissas and exponents.
    minuends: [(i64, i32); K],
    /// None where f64 holds all differences: those are the minuends then.
    subtrahends: Option<[(i64, i32); K]>,
    /// The smallest exponent.
    unit: i32,
    /// Each difference is below `2^bits` in size.
    pub(super) bits: u32,
}

impl<const K: usize> Differences<K> {
    /// Of x - y for each (x, y), any finite numbers. `bits` is at most 2099.
    pub(super) fn new(pairs: [(f64, f64); K]) -> Self {
        let exact = pairs.iter().all(|&(x, y)| difference_is_exact(x, y));
        let minuends = pairs.map(|(x, y)| decode(if exact { x - y } else { x }));
        let subtrahends = (!exact).then(|| pairs.map(|(_, y)| decode(y)));
        let numbers = || minuends.iter().chain(subtrahends.as_slice().as_flattened());
        let unit = numbers().map(|&(_, exponent)| exponent).min().unwrap_or(0);
        let width =
            |&(m, e): &(i64, i32)| if m == 0 { 0 } else { m.unsigned_abs().ilog2() + 1 + (e - unit) as u32 };
        let bits = numbers().map(width).max().unwrap_or(0) + u32::from(!exact);
        #[cfg(test)]
        WIDEST.set(WIDEST.get().max(bits));
        Self { minuends, subtrahends, unit, bits }
    }

    /// The integers; `R` must have room for `bits`, and for what is computed from them.
    pub(super) fn integers<R: Ring>(&self) -> [R; K] {
        let integer = |(m, e): (i64, i32)| R::new(m, if m == 0 { 0 } else { (e - self.unit) as u32 });
        match self.subtrahends {
            None => self.minuends.map(integer),
            Some(subtrahends) => {
                std::array::from_fn(|i| integer(self.minuends[i]).sub(&integer(subtrahends[i])))
            }
        }
    }
}

/// True where `x - y`, computed in f64, is the exact difference: the roundoff of Knuth's TwoDiff is zero. Sums of f64
/// do not underflow, and of a difference that overflows no part of the roundoff is a number.
fn difference_is_exact(x: f64, y: f64) -> bool {
    let difference = x - y;
    let y_virtual = x - difference;
    let x_virtual = difference + y_virtual;
    x - x_virtual == 0.0 && y_virtual - y == 0.0
}
