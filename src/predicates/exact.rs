//! Exact integers. Floating-point coordinates are integers times one power of two, and signs of polynomials in their
//! differences decide every predicate.

use std::cmp::Ordering;

/// The operations that polynomials need.
pub(super) trait Ring {
    /// `mantissa * 2^shift`.
    fn new(mantissa: i64, shift: u32) -> Self;
    fn add(&self, other: &Self) -> Self;
    fn sub(&self, other: &Self) -> Self;
    fn mul(&self, other: &Self) -> Self;
    fn sign(&self) -> Ordering;
}

impl Ring for i64 {
    fn new(mantissa: i64, shift: u32) -> Self {
        mantissa << shift
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

/// Storage for 64-bit limbs, the least significant first.
pub(super) trait Limbs: AsRef<[u64]> + AsMut<[u64]> {
    /// At least `len` zero limbs; an array always has its own length.
    fn zeros(len: usize) -> Self;
}

impl<const N: usize> Limbs for [u64; N] {
    fn zeros(_len: usize) -> Self {
        [0; N]
    }
}

impl Limbs for Vec<u64> {
    fn zeros(len: usize) -> Self {
        vec![0; len]
    }
}

/// A signed integer: sign and magnitude, with `len` limbs in use.
#[derive(Debug)]
pub(super) struct Int<L> {
    negative: bool,
    len: usize,
    limbs: L,
}

/// An integer of up to `N` limbs. The callers choose `N` so that no result is larger.
pub(super) type Bounded<const N: usize> = Int<[u64; N]>;

/// An integer of any size, for exponents that are far apart.
pub(super) type Unbounded = Int<Vec<u64>>;

impl<L: Limbs> Int<L> {
    fn used(&self) -> &[u64] {
        &self.limbs.as_ref()[..self.len]
    }

    /// The sum with a number of the magnitude of `other` and the given sign.
    #[inline(never)]
    fn add_signed(&self, other: &Self, negative: bool) -> Self {
        let mut limbs = L::zeros(self.len.max(other.len) + 1);
        let is_less = compare(self.used(), other.used()).is_lt();
        let (large, small) = if is_less { (other, self) } else { (self, other) };
        let is_sum = self.negative == negative;
        let len = add_or_subtract(large.used(), small.used(), is_sum, limbs.as_mut());
        Self { negative: if is_less { negative } else { self.negative }, len, limbs }
    }
}

/// The number of limbs up to the last one that is not zero.
fn significant(limbs: &[u64]) -> usize {
    limbs.iter().rposition(|&limb| limb != 0).map_or(0, |last| last + 1)
}

fn compare(x: &[u64], y: &[u64]) -> Ordering {
    x.len().cmp(&y.len()).then_with(|| x.iter().rev().cmp(y.iter().rev()))
}

/// Writes `large` + `small`, or their difference, to `result`, which is all zero. Returns the number of limbs of the
/// result. `large` >= `small`.
fn add_or_subtract(large: &[u64], small: &[u64], is_sum: bool, result: &mut [u64]) -> usize {
    let step = |x: u64, y| if is_sum { x.overflowing_add(y) } else { x.overflowing_sub(y) };
    let mut carry = false;
    for (i, &x) in large.iter().enumerate() {
        let y = small.get(i).copied().unwrap_or(0);
        let (limb, first) = step(x, y);
        let (limb, second) = step(limb, u64::from(carry));
        result[i] = limb;
        carry = first | second;
    }
    if carry {
        result[large.len()] = 1;
    }
    significant(&result[..large.len() + usize::from(carry)])
}

/// Writes the product to `products`, which is all zero. Returns the number of limbs of the product.
fn multiply(x: &[u64], y: &[u64], products: &mut [u64]) -> usize {
    for (i, &x) in x.iter().enumerate() {
        let mut carry = 0u128;
        for (j, &z) in y.iter().enumerate() {
            carry += u128::from(x) * u128::from(z) + u128::from(products[i + j]);
            products[i + j] = carry as u64;
            carry >>= 64;
        }
        if carry > 0 {
            products[i + y.len()] = carry as u64;
        }
    }
    significant(&products[..products.len().min(x.len() + y.len())])
}

impl<L: Limbs> Ring for Int<L> {
    fn new(mantissa: i64, shift: u32) -> Self {
        let wide = u128::from(mantissa.unsigned_abs()) << (shift % 64);
        let at = (shift / 64) as usize;
        let mut limbs = L::zeros(at + 2);
        limbs.as_mut()[at] = wide as u64;
        limbs.as_mut()[at + 1] = (wide >> 64) as u64;
        Self { negative: mantissa < 0, len: significant(&limbs.as_ref()[..at + 2]), limbs }
    }

    fn add(&self, other: &Self) -> Self {
        self.add_signed(other, other.negative)
    }

    fn sub(&self, other: &Self) -> Self {
        self.add_signed(other, !other.negative)
    }

    #[inline(never)]
    fn mul(&self, other: &Self) -> Self {
        let mut limbs = L::zeros(self.len + other.len);
        let len = multiply(self.used(), other.used(), limbs.as_mut());
        Self { negative: self.negative != other.negative, len, limbs }
    }

    fn sign(&self) -> Ordering {
        match (self.len, self.negative) {
            (0, _) => Ordering::Equal,
            (_, true) => Ordering::Less,
            (_, false) => Ordering::Greater,
        }
    }
}

/// `numerator / denominator * 2^exponent`, rounded to the nearest f64, ties to even; infinite if it is too large. The
/// denominator is not 0.
pub(super) fn quotient(numerator: &Unbounded, denominator: &Unbounded, exponent: i32) -> f64 {
    if numerator.sign().is_eq() {
        return 0.0;
    }
    // With the same highest bit, each is less than twice the other.
    let width =
        |x: &Unbounded| 64 * x.len as i32 - x.used().last().map_or(0, |limb| limb.leading_zeros() as i32);
    let shift = width(denominator) - width(numerator);
    let shifted = |x: &Unbounded, shift: i32| x.mul(&Unbounded::new(1, shift.max(0) as u32));
    let (rest, divisor) = (shifted(numerator, shift), shifted(denominator, -shift));
    let (mut rest, divisor) = (rest.used().to_vec(), divisor.used());
    rest.push(0);
    // The first 64 bits of the quotient, of which the first may be 0. The last stands for all that follow.
    let mut bits = 0u64;
    for _ in 0..64 {
        let is_less = rest.last() == Some(&0) && rest[..divisor.len()].iter().rev().lt(divisor.iter().rev());
        bits = bits << 1 | u64::from(!is_less);
        if !is_less {
            let mut borrow = false;
            for (limb, y) in rest.iter_mut().zip(divisor.iter().chain([&0])) {
                let (difference, first) = limb.overflowing_sub(*y);
                let (difference, second) = difference.overflowing_sub(u64::from(borrow));
                (*limb, borrow) = (difference, first | second);
            }
        }
        let mut carry = 0;
        for limb in &mut rest {
            (*limb, carry) = (*limb << 1 | carry, *limb >> 63);
        }
    }
    bits |= u64::from(rest.iter().any(|&limb| limb != 0));
    let unit = exponent - shift - 63;
    // A number has 53 bits, and no bit below 2^-1074. If more than 65 are dropped, nothing is left, as of 65.
    let dropped = (11 - bits.leading_zeros() as i32).max(-1074 - unit).min(65);
    let odd = u128::from(bits) >> dropped & 1;
    let kept = (u128::from(bits) + (1 << (dropped - 1)) - 1 + odd) >> dropped;
    let magnitude = libm::scalbn(kept as f64, unit + dropped);
    if numerator.negative == denominator.negative { magnitude } else { -magnitude }
}

/// Mantissa and exponent with `x = mantissa * 2^exponent`. The mantissa is odd; zero is `(0, i32::MAX)`, so that it
/// never has the smallest exponent.
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
    /// How many [`Differences`] there were: how often a filter did not decide.
    pub(super) static COUNT: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

#[cfg(test)]
pub(super) fn count(bits: u32) {
    WIDEST.set(WIDEST.get().max(bits));
    COUNT.set(COUNT.get() + 1);
}

/// Differences of numbers, as integers times one power of two. No sign depends on that unit.
pub(super) struct Differences<const K: usize> {
    /// Mantissas and exponents.
    minuends: [(i64, i32); K],
    /// `None` if all differences are exact in f64: then the minuends are the differences.
    subtrahends: Option<[(i64, i32); K]>,
    /// The smallest exponent.
    pub(super) unit: i32,
    /// Each difference is below `2^bits` in magnitude.
    pub(super) bits: u32,
}

impl<const K: usize> Differences<K> {
    /// The differences x - y of pairs (x, y) of finite numbers. `bits` is at most 2099.
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
        count(bits);
        Self { minuends, subtrahends, unit, bits }
    }

    /// The integers. `R` must hold `bits` bits, and whatever the caller computes from the integers.
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

/// Whether `x - y`, computed in f64, is the exact difference: the roundoff of Knuth's TwoDiff is zero. Sums of f64 do
/// not underflow. If the difference overflows, the roundoff is NaN, so this returns false.
pub(super) fn difference_is_exact(x: f64, y: f64) -> bool {
    let difference = x - y;
    let y_virtual = x - difference;
    let x_virtual = difference + y_virtual;
    x - x_virtual == 0.0 && y_virtual - y == 0.0
}
