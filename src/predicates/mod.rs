//! The exact tests. Each is the sign of a polynomial in differences of coordinates: an f64 filter with a
//! proven bound decides nearly all, exact integers decide the rest. Nothing depends on an epsilon.
//!
//! An edge (a, b) has the triangles (a, b, c) and (b, a, d). With p = a - c, q = b - c, r = a - d,
//! s = b - d, the normals are n1 = p × q and n2 = s × r, the cosines' numerators dot1 = p·q and
//! dot2 = s·r; after the flip the triangles (a, d, c) and (b, c, d) have the normals r × p and q × s.

mod exact;
mod plane;
mod space;

pub(crate) use plane::{area_sign, in_circle_filter, in_circle_sign, total_area_sign};
pub(crate) use space::{Quad, corner};

/// The cosine that the β test uses: an f64, so a rational number, and the same one on every platform. It is the cosine
/// of 0°, 60°, 90°, 120° and 180°, and less than 3 units in the last place from that of any other angle.
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

/// The sine of up to 45 degrees, if `odd` is 1, or the cosine, if it is 0: what is left out is below 2^-58.
fn taylor(degrees: f64, odd: u32) -> f64 {
    let x = degrees * (std::f64::consts::PI / 180.0);
    let mut rest = 1.0;
    for term in (1..9).rev() {
        let n = f64::from(2 * term + odd);
        rest = 1.0 - x * x / (n * (n - 1.0)) * rest;
    }
    if odd == 1 { x * rest } else { rest }
}

/// |k| = mantissa / 2^shift, exactly, for a cosine k from [`cos_degrees`]; the shift is at most 106.
pub(crate) fn cosine_fraction(k: f64) -> (u64, u32) {
    let (mantissa, exponent) = exact::decode(k);
    (mantissa.unsigned_abs(), if mantissa == 0 { 0 } else { -exponent as u32 })
}

#[cfg(test)]
mod tests;
#[cfg(test)]
pub(crate) mod tiers;
