//! Prepares a mesh for a GPU engine, with coordinates for which its shaders decide exactly.

use crate::mesh::extremes::{Extremes, MAGNITUDE};
use crate::phases::Thresholds;
use crate::system::threads::Threads;
use crate::{Dimension, EngineKind, Error, Mesh, Positions};
#[cfg(all(target_arch = "wasm32", feature = "js-webgl2"))]
use glam::DVec2;
use std::sync::Arc;

/// The most bits of a coordinate without its sign, relative to the centre of the bounding box, in units of the grid.
/// The unit of the grid is the largest power of two that divides all coordinates. The same limit is in `integers.wgsl`.
pub(in crate::engine) const SPAN: u32 = 84;
/// Below this power of two, no difference of two floats overflows. WGSL guarantees nothing for infinities.
const LARGEST_EXPONENT: i32 = 126;
/// Words of a fixed-point coordinate.
const FIXED_WORDS: usize = 3;

/// Which set of shaders a mesh needs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Form {
    pub(crate) dimension: Dimension,
    /// Whether the coordinates are fixed-point numbers (`fixed_point.wgsl`), not floats (`floats.wgsl`).
    pub(crate) is_fixed: bool,
    /// Whether there is a limit for the deviation (`deviation.wgsl`).
    pub(crate) has_deviation: bool,
}

impl Form {
    /// All forms, each at its index.
    pub(crate) const ALL: [Self; 6] = [
        Self { dimension: Dimension::Two, is_fixed: false, has_deviation: false },
        Self { dimension: Dimension::Three, is_fixed: false, has_deviation: false },
        Self { dimension: Dimension::Three, is_fixed: false, has_deviation: true },
        Self { dimension: Dimension::Two, is_fixed: true, has_deviation: false },
        Self { dimension: Dimension::Three, is_fixed: true, has_deviation: false },
        Self { dimension: Dimension::Three, is_fixed: true, has_deviation: true },
    ];
    /// `deviation` is the limit, or infinite.
    pub(crate) fn new(dimension: Dimension, is_fixed: bool, deviation: f64) -> Self {
        let has_deviation = dimension == Dimension::Three && deviation.is_finite();
        Self { dimension, is_fixed, has_deviation }
    }

    /// The number of forms.
    pub(crate) const COUNT: usize = Self::ALL.len();

    /// Its index in [`Form::ALL`].
    pub(crate) fn index(self) -> usize {
        self.dimension.stride() - 2 + usize::from(self.has_deviation) + 3 * usize::from(self.is_fixed)
    }
}

/// A mesh that the GPU engines can decide exactly.
pub(crate) struct Upload {
    pub(crate) mesh: Arc<Mesh>,
    pub(crate) thresholds: Thresholds,
    /// Fixed-point coordinates in the order of `fixed_point.wgsl`; `None` if the upload is 32-bit floats.
    fixed: Option<Vec<u32>>,
    /// The limit for the deviation, in the layout of `state.wgsl`.
    pub(crate) deviation: [u32; 4],
    /// Whether the WebGPU engine keeps the adjacency for kernels of the caller.
    pub(crate) gives_adjacency: bool,
}

impl Upload {
    /// # Errors
    /// [`Error::BackendLimit`] for a mesh whose coordinates the shaders cannot decide exactly.
    pub(crate) fn new(backend: EngineKind, mesh: Arc<Mesh>, thresholds: Thresholds) -> Result<Self, Error> {
        // The limit for the deviation takes bits as a coordinate does. At most, it is a distance that no two points
        // have.
        let deviation = |highest| match mesh.dimension() {
            Dimension::Two => 0.0,
            Dimension::Three => f64::from(thresholds.deviation).min(libm::scalbn(1.0, highest + 3)),
        };
        let with = |(lowest, highest): (i32, i32)| (lowest.min(lowest_bit(deviation(highest))), highest);
        if let Positions::F32(floats) = mesh.positions() {
            let quick = with(most_exponents(floats));
            let ends = if fit(quick) { quick } else { with(exponents(floats.iter().map(|&x| x.into()))) };
            if fit(ends) {
                let deviation = deviation_words(deviation(ends.1), None);
                return Ok(Self { mesh, thresholds, fixed: None, deviation, gives_adjacency: false });
            }
        }
        let ends = with(exponents(mesh.positions().iter()));
        let fixed = fixed_point(&mesh, ends).map_err(|span| {
            let message = format!("the coordinates span {span} bits; it decides at most {SPAN} bits exactly");
            Error::BackendLimit { backend, message }
        })?;
        let deviation = deviation_words(deviation(ends.1), Some(ends.0));
        Ok(Self { mesh, thresholds, fixed: Some(fixed), deviation, gives_adjacency: false })
    }

    pub(crate) fn form(&self) -> Form {
        Form::new(self.mesh.dimension(), self.fixed.is_some(), self.thresholds.deviation.into())
    }

    /// The coordinates as the shaders of its form read them: words, axis after axis.
    pub(crate) fn words(&self) -> &[u32] {
        match (&self.fixed, self.mesh.positions()) {
            (Some(words), _) => words,
            (None, Positions::F32(floats)) => bytemuck::cast_slice(floats),
            // 64-bit floats are always uploaded as fixed-point numbers.
            (None, Positions::F64(_)) => &[],
        }
    }
}

/// Whether the span of all points, or of the limit for the deviation, allows exact arithmetic.
fn fit((lowest, highest): (i32, i32)) -> bool {
    highest - lowest < SPAN as i32 && highest < LARGEST_EXPONENT
}

/// The exponent of the lowest set bit; that of 0 is beyond all others.
fn lowest_bit(x: f64) -> i32 {
    let (magnitude, unit) = parts(x);
    if magnitude == 0 { i32::MAX } else { unit + magnitude.trailing_zeros() as i32 }
}

/// Whether an update to these positions may have to leave edges alone (`left_alone.wgsl`). `deviation` is the limit, or
/// infinite.
#[cfg(all(target_arch = "wasm32", feature = "js-webgl2"))]
pub(in crate::engine) fn may_leave_edges(positions: &[f32], deviation: f32) -> bool {
    let (lowest, highest) = most_exponents(positions);
    let limit = if deviation.is_finite() { lowest_bit(deviation.into()) } else { i32::MAX };
    !fit((lowest.min(limit), highest))
}

/// Whether an update leaves a triangle alone, for the same reasons.
#[cfg(all(target_arch = "wasm32", feature = "js-webgl2"))]
pub(in crate::engine) fn leaves_triangle(points: [DVec2; 3]) -> bool {
    !fit(exponents(points.iter().flat_map(|point| point.to_array())))
}

/// The limit for the deviation in the layout of `state.wgsl`: the words of a coordinate, in units of 2^`grid` or else a
/// float, and rounded to f32.
pub(in crate::engine) fn deviation_words(limit: f64, grid: Option<i32>) -> [u32; 4] {
    let Some(grid) = grid else {
        let most = (limit as f32).min(f32::MAX).to_bits();
        return [most, 0, 0, most];
    };
    // No two points of a box of coordinates are this far apart.
    let most = on_grid(limit, grid).min(1 << (SPAN + 2));
    [most as u32, (most >> 32) as u32, (most >> 64) as u32, (most as f32).to_bits()]
}

/// The coordinates as integers in units of the grid, relative to the lowest corner of the bounding box. The error is the
/// number of bits that a coordinate would take. `lowest` and `highest` are the exponents of the lowest and the highest
/// bit set.
fn fixed_point(mesh: &Mesh, (lowest, highest): (i32, i32)) -> Result<Vec<u32>, u32> {
    let (positions, stride) = (mesh.positions(), mesh.dimension().stride());
    let span = (highest - lowest + 1) as u32;
    // The difference of two such integers is an i128.
    if span > i128::BITS - 2 {
        return Err(span);
    }
    let mut corner = [0; 3];
    for (axis, corner) in corner[..stride].iter_mut().enumerate() {
        let numbers = || positions.iter().skip(axis).step_by(stride);
        let [low, high] = [numbers().reduce(f64::min), numbers().reduce(f64::max)]
            .map(|end| on_grid(end.unwrap_or_default(), lowest));
        // Relative to the centre of the box, a coordinate takes one bit less than relative to the corner.
        let bits = (i128::BITS - (high - low).leading_zeros()).saturating_sub(1);
        if bits > SPAN {
            return Err(bits);
        }
        *corner = low;
    }
    let numbers: Vec<f64> = positions.iter().collect();
    let mut words = Vec::with_capacity(FIXED_WORDS * numbers.len());
    for point in numbers.chunks_exact(stride) {
        for word in 0..FIXED_WORDS {
            let word_of = |(&x, corner): (&f64, &i128)| ((on_grid(x, lowest) - corner) >> (32 * word)) as u32;
            words.extend(point.iter().zip(&corner).map(word_of));
        }
    }
    Ok(words)
}

/// `x` in units of 2^`grid`, of which it is a multiple.
fn on_grid(x: f64, grid: i32) -> i128 {
    let (magnitude, unit) = parts(x);
    let whole = match unit - grid {
        // The unit of 0 means nothing.
        _ if magnitude == 0 => 0,
        shift if shift < 0 => i128::from(magnitude >> -shift),
        shift => i128::from(magnitude) << shift,
    };
    if x < 0.0 { -whole } else { whole }
}

/// Magnitude m and unit e of |`x`| = m·2^e.
fn parts(x: f64) -> (u64, i32) {
    let bits = x.to_bits();
    let (field, fraction) = ((bits >> 52 & 0x7ff) as i32, bits & ((1 << 52) - 1));
    let magnitude = if field == 0 { fraction } else { fraction | 1 << 52 };
    (magnitude, field.max(1) - 1075)
}

/// Bounds on the results of [`exponents`]. The bounds are faster to find.
fn most_exponents(floats: &[f32]) -> (i32, i32) {
    // A mesh has about as many triangles as coordinates.
    let threads = Threads::default().for_triangles(floats.len());
    let Extremes { below, largest } = Extremes::of(bytemuck::cast_slice(floats), MAGNITUDE, &threads);
    let smallest = below.wrapping_add(1);
    let exponent = |bits: u32| (bits >> 23).max(1) as i32 - 127;
    if largest == 0 { (0, 0) } else { (exponent(smallest) - 23, exponent(largest)) }
}

/// The exponents of the lowest and the highest bit set in any number; (0, 0) if no bit is set.
fn exponents(numbers: impl Iterator<Item = f64>) -> (i32, i32) {
    let (mut lowest, mut highest) = (i32::MAX, i32::MIN);
    for x in numbers.filter(|&x| x != 0.0) {
        let (magnitude, unit) = parts(x);
        lowest = lowest.min(unit + magnitude.trailing_zeros() as i32);
        highest = highest.max(unit + magnitude.ilog2() as i32);
    }
    if lowest == i32::MAX { (0, 0) } else { (lowest, highest) }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

    use super::*;
    use crate::Options;

    fn upload(positions: impl Into<Positions>) -> Result<Upload, String> {
        let mesh = Mesh::new(Dimension::Two, positions, Vec::new()).unwrap();
        let thresholds = Thresholds::from(&Options::default());
        Upload::new(EngineKind::Gpu, Arc::new(mesh), thresholds).map_err(|error| error.to_string())
    }

    /// The fixed-point coordinates of an upload.
    fn fixed(positions: &[f64]) -> Vec<u128> {
        let upload = upload(positions.to_vec()).unwrap();
        assert!(upload.form().is_fixed);
        let point = |words: &[u32]| {
            [0, 1].map(|axis| (0..3).map(|word| u128::from(words[2 * word + axis]) << (32 * word)).sum())
        };
        upload.words().chunks_exact(6).flat_map(point).collect()
    }

    #[test]
    fn forms_are_at_their_indices() {
        assert!((0..).zip(Form::ALL).all(|(index, form)| form.index() == index));
    }

    #[test]
    fn floats_stay_floats_where_their_span_allows() {
        let numbers = [1.0, -0.0, -(2f32.powi(-60)), 2f32.powi(23)];
        let upload = upload(numbers.to_vec()).unwrap();
        assert!(!upload.form().is_fixed);
        assert_eq!(upload.words(), numbers.map(f32::to_bits));
    }

    #[test]
    fn fixed_points_count_from_the_corner_of_the_box() {
        let (third, tiny) = (1.0 / 3.0, f64::from_bits(1));
        // A third has 53 bits, the last of which is 2^-54.
        assert_eq!(fixed(&[third, 7.0, 0.0, 8.5]), [6_004_799_503_160_661, 0, 0, 3 << 53]);
        assert_eq!(fixed(&[-4.0 * tiny, 3.0 * tiny, 8.0 * tiny, tiny]), [0, 2, 12, 0]);
        assert_eq!(fixed(&[f64::MAX, 1e300, f64::MAX, 1e300]), [0; 4]);
        let wide = fixed(&[0.0, 2f64.powi(30), 2f64.powi(-50) + 1.0, 0.0]);
        assert_eq!(wide, [0, 1 << 80, (1 << 50) + 1, 0]);
    }

    #[test]
    fn exponents_lie_between_their_bounds() {
        let tiny = f32::from_bits(1);
        for numbers in [
            vec![],
            vec![0.0, -0.0],
            vec![3.0, -0.0],
            vec![tiny, -7.5, 0.0],
            vec![f32::MAX, 1.5e-40],
            vec![-2.0],
        ] {
            let (lowest, highest) = exponents(numbers.iter().map(|&x| x.into()));
            let (least, most) = most_exponents(&numbers);
            assert!(least <= lowest && highest <= most, "{numbers:?}: {least} {lowest} {highest} {most}");
            assert!(lowest - least <= 23 && most - highest <= 23, "{numbers:?}");
        }
    }

    #[test]
    fn the_limit_is_84_bits_to_each_side() {
        let (far, one) = (2f64.powi(300), 2f64.powi(216));
        assert_eq!(fixed(&[-far, 0.0, far - one * 2f64.powi(32), one])[..2], [0, 0]);
        let refused = upload(vec![-far, 0.0, far, one]).err().unwrap();
        assert!(refused.contains("span 85 bits"), "{refused}");
        // Exponents too far apart for an i128.
        for numbers in [[f64::MAX, f64::from_bits(1)], [-f64::MAX, f64::MIN_POSITIVE], [1.0, 1e-300]] {
            assert!(upload(numbers.to_vec()).err().unwrap().contains("span"));
        }
        // Floats whose differences overflow, and floats that span too many bits from zero but not from their corner.
        assert!(upload(vec![f32::MAX, f32::MIN]).unwrap().form().is_fixed);
        assert!(upload(vec![2f32.powi(100), 1.0, 2f32.powi(100), 2.0]).unwrap().form().is_fixed);
        assert!(upload(vec![2f32.powi(100), 1.0, 0.0, 2.0]).is_err());
    }
}
