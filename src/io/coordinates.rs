//! Coordinates from text: 32-bit floats if these show the digits of the file, else 64-bit floats.

use super::options::Coordinates;
use super::parsed::Parsed;
use super::text::{integer, quoted};
use crate::Error;
use num_bigint::BigInt;
use std::str::FromStr;

/// The most digits of a decimal number that a 32-bit float always shows.
const SHOWN: u32 = 6;
/// With more digits, half of the last one is less than what rounds a 64-bit float.
const MOST: usize = 17;
/// The most digits of an integer that is always a 64-bit float.
const EXACT: usize = 15;
/// The powers of 10 that are 64-bit floats.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Reads a file with 32-bit coordinates, and again with 64-bit ones if those lose digits; or with those that `option`
/// says. `narrow` is told whether to ask for digits, and then ends where one is lost.
pub(super) fn read(
    option: Option<Coordinates>,
    narrow: impl Fn(bool) -> Result<Parsed, Error>,
    wide: impl FnOnce() -> Result<Parsed, Error>,
) -> Result<Parsed, Error> {
    if option != Some(Coordinates::F64) {
        let parsed = narrow(true)?;
        if !parsed.loses {
            return Ok(parsed);
        }
    }
    if option == Some(Coordinates::F32) {
        return Ok(Parsed { loses: true, ..narrow(false)? });
    }
    wide()
}

/// How the coordinates of a file are read.
#[derive(Clone, Copy, Default)]
pub(super) struct Reading {
    /// Whether to ask if the floats show the digits of the file.
    pub(super) asks: bool,
    /// Whether a float does not show its digits.
    pub(super) loses: bool,
}

/// A float.
pub(super) trait Float: Copy + Default + Send + Sync {
    const BITS: u32;

    /// The float nearest to a decimal number, and whether it loses digits of it. `None` if the token is not a number.
    fn nearest(token: &[u8], asks: bool) -> Option<(Self, bool)>;

    fn is_finite(self) -> bool;
}

impl Float for f32 {
    const BITS: u32 = 32;

    #[inline]
    fn nearest(token: &[u8], asks: bool) -> Option<(Self, bool)> {
        if !asks {
            return Some((parsed(token)?, false));
        }
        if let Some(x) = shown(token) {
            return Some((x, false));
        }
        let wide: f64 = parsed(token)?;
        let mut x = wide as f32;
        if f64::from(x) == wide || wide.is_nan() {
            return Some((x, false));
        }
        if is_tie(wide) || !x.is_normal() {
            x = parsed(token)?;
        }
        Some((x, !shows(x, token)))
    }

    fn is_finite(self) -> bool {
        self.is_finite()
    }
}

impl Float for f64 {
    const BITS: u32 = 64;

    #[inline]
    fn nearest(token: &[u8], _: bool) -> Option<(Self, bool)> {
        Some((parsed(token)?, false))
    }

    fn is_finite(self) -> bool {
        self.is_finite()
    }
}

impl Reading {
    /// The float nearest to a decimal number; `None` if the token is not a number. Accepts NaN and infinities.
    #[inline]
    pub(super) fn nearest<T: Float>(&mut self, token: &[u8]) -> Option<T> {
        let (x, loses) = T::nearest(token, self.asks)?;
        self.loses |= loses;
        Some(x)
    }

    /// A finite coordinate, or what is wrong with it.
    #[inline]
    pub(super) fn coordinate<T: Float>(&mut self, token: &[u8]) -> Result<T, String> {
        match self.nearest::<T>(token) {
            Some(x) if x.is_finite() || self.loses => Ok(x),
            Some(_) if T::BITS == 32 && !self.asks => {
                Err(format!("{} is not a finite 32-bit number", quoted(token)))
            }
            Some(_) => Err(format!("{} is not a finite number", quoted(token))),
            None => Err(format!("expected a number, found {}", quoted(token))),
        }
    }
}

fn parsed<T: FromStr>(token: &[u8]) -> Option<T> {
    std::str::from_utf8(token).ok()?.parse().ok()
}

/// Whether a number is halfway between two 32-bit floats. It may have become so by rounding to 64 bits.
fn is_tie(wide: f64) -> bool {
    wide.to_bits() & 0x1fff_ffff == 0x1000_0000
}

/// The float nearest to a decimal number of few digits that it shows; `None` also if that takes a closer look.
#[inline]
fn shown(token: &[u8]) -> Option<f32> {
    let (is_negative, token) = match token {
        [b'-', token @ ..] => (true, token),
        [b'+', token @ ..] => (false, token),
        token => (false, token),
    };
    let (mut digits, mut point, mut end, mut exponent) = (0_u64, None, token.len(), 0);
    for (i, &b) in token.iter().enumerate() {
        let digit = b.wrapping_sub(b'0');
        if digit < 10 {
            digits = digits.wrapping_mul(10).wrapping_add(u64::from(digit));
        } else if b == b'.' && point.is_none() {
            point = Some(i);
        } else if matches!(b, b'e' | b'E') {
            (end, exponent) = (i, integer(&token[i + 1..])?);
            break;
        } else {
            return None;
        }
    }
    let count = end - usize::from(point.is_some());
    let last = exponent.checked_sub(point.map_or(0, |point| (end - point - 1) as i64))?;
    if !(1..=EXACT).contains(&count) {
        return None;
    }
    let power = *POWERS.get(usize::try_from(last.checked_neg()?).ok()?)?;
    // Both are 64-bit floats, so this is rounded once.
    let number = digits as f64;
    let wide = number / power;
    let x = wide as f32;
    if f64::from(x) != wide {
        if is_tie(wide) || !x.is_normal() {
            return None;
        }
        // With powers up to 10^12, the product has at most 52 bits.
        let is_near = || last >= -12 && (f64::from(x) * power - number).abs() <= 0.5;
        if digits >= 10_u64.pow(SHOWN) && !is_near() {
            return None;
        }
    }
    Some(if is_negative { -x } else { x })
}

/// Whether a float is at most half a unit of the last digit away from the token: rounded to as many digits, it is the
/// token.
fn shows(x: f32, token: &[u8]) -> bool {
    let (digits, count, last) = digits_of(token);
    if !x.is_finite() || count > MOST {
        return false;
    }
    let bits = x.abs().to_bits();
    let (mantissa, exponent) = if x.is_normal() {
        (bits & 0x7f_ffff | 0x80_0000, i64::from(bits >> 23) - 150)
    } else {
        (bits, -149)
    };
    let power = |base: u32, exponent: i64| BigInt::from(base).pow(exponent.max(0) as u32);
    // All multiplied by the powers that make them integers.
    let unit = power(10, last) * power(2, -exponent);
    let distance = power(10, -last) * power(2, exponent) * mantissa - &unit * digits;
    2 * BigInt::from(distance.into_parts().1) <= unit
}

/// The digits from the first to the last that is not 0, their number and the power of 10 of the last. With more than 19,
/// the digits are any.
fn digits_of(token: &[u8]) -> (u64, usize, i64) {
    let (mut digits, mut count, mut zeros, mut decimals, mut is_after_point, mut exponent) =
        (0_u64, 0, 0, 0, false, 0);
    for (i, &b) in token.iter().enumerate() {
        match b {
            b'.' => is_after_point = true,
            b'e' | b'E' => {
                exponent = integer(&token[i + 1..]).unwrap_or_default();
                break;
            }
            b'0'..=b'9' => {
                decimals += i64::from(is_after_point);
                if b != b'0' {
                    zeros += 1;
                    digits = digits.wrapping_mul(10_u64.wrapping_pow(zeros as u32));
                    digits = digits.wrapping_add(u64::from(b - b'0'));
                    count += zeros;
                    zeros = 0;
                } else if count > 0 {
                    zeros += 1;
                }
            }
            _ => {}
        }
    }
    (digits, count, exponent.saturating_sub(decimals).saturating_add(zeros as i64))
}
