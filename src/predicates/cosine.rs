//! The cosine of β, as a rational number.

use super::exact::decode;

/// The cosine for the β test: an f64, and so a rational number, the same on every platform. It is exact for 0°, 60°,
/// 90°, 120° and 180°, and less than 3 units in the last place off for any other angle.
///
/// `degrees` is an angle from 0 to 180.
pub fn cos_degrees(degrees: f64) -> f64 {
    if degrees == 60.0 {
        0.5
    } else if degrees == 120.0 {
        -0.5
    } else if degrees < 45.0 {
        taylor(degrees, 0)
    } else if degrees <= 135.0 {
        taylor(90.0 - degrees, 1)
    } else {
        -taylor(180.0 - degrees, 0)
    }
}

/// The sine (`odd` = 1) or the cosine (`odd` = 0) of up to 45 degrees. The truncation error is below 2^-58.
fn taylor(degrees: f64, odd: u32) -> f64 {
    let x = degrees * (std::f64::consts::PI / 180.0);
    let mut rest = 1.0;
    for term in (1..9).rev() {
        let n = f64::from(2 * term + odd);
        rest = 1.0 - x * x / (n * (n - 1.0)) * rest;
    }
    if odd == 1 { x * rest } else { rest }
}

/// Mantissa and shift with |k| = mantissa / 2^shift, exactly, for a cosine k from [`cos_degrees`]. The shift is at most
/// 106.
pub(crate) fn cosine_fraction(k: f64) -> (u64, u32) {
    let (mantissa, exponent) = decode(k);
    (mantissa.unsigned_abs(), if mantissa == 0 { 0 } else { -exponent as u32 })
}
