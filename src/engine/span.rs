//! Which coordinates the engines on a GPU decide exactly.

use crate::mesh::Mesh;
use crate::{Error, Positions};

/// The coordinates of a mesh must be integers of so many bits times a power of two; as in `points.wgsl`.
pub(super) const SPAN: u32 = 84;

/// Refuses a mesh whose coordinates the shaders cannot decide exactly.
pub(super) fn refuse_wide_span(backend: &'static str, mesh: &Mesh) -> Result<(), Error> {
    let refuse = |message| Err(Error::BackendLimit { backend, message });
    let Positions::F32(positions) = mesh.positions() else {
        return refuse("its coordinates are 64-bit floats, and it takes 32-bit ones".to_owned());
    };
    let (lowest, highest) = exponents(positions);
    let span = (highest - lowest + 1) as u32;
    if span > SPAN {
        return refuse(format!("its coordinates span {span} bits, and it decides {SPAN} bits exactly"));
    }
    // A difference of larger ones may overflow, and shaders promise nothing for infinities.
    if highest >= 126 {
        return refuse(format!("a coordinate is 2^{highest} or more, and it takes those below 2^126"));
    }
    Ok(())
}

/// Exponents of the lowest and of the highest bit that is set in any coordinate; 0 and 0 if none is.
fn exponents(positions: &[f32]) -> (i32, i32) {
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    for bits in positions.iter().map(|x| x.to_bits() & 0x7fff_ffff).filter(|&bits| bits != 0) {
        let field = (bits >> 23) as i32;
        let magnitude = if field == 0 { bits & 0x7f_ffff } else { bits & 0x7f_ffff | 0x80_0000 };
        let unit = field.max(1) - 150;
        lowest = lowest.min(unit + magnitude.trailing_zeros() as i32);
        highest = highest.max(unit + magnitude.ilog2() as i32);
    }
    if lowest == i32::MAX { (0, 0) } else { (lowest, highest) }
}
