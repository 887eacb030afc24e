//! `Positions`: the coordinates of a mesh, in the precision that they need.

use crate::mesh::extremes::{Extremes, MAGNITUDE};
use crate::system::threads::Threads;
use crate::{Dimension, Error};
use glam::{DVec2, DVec3};
use std::array;
use std::ops::Range;

/// Coordinates, 2 or 3 per vertex. A [`Mesh`](crate::Mesh) stores 64-bit floats only if at least one of them is not
/// exactly a 32-bit float.
#[derive(Clone, Debug, PartialEq)]
pub enum Positions {
    /// 32-bit floats.
    F32(Vec<f32>),
    /// 64-bit floats.
    F64(Vec<f64>),
}

impl From<Vec<f32>> for Positions {
    fn from(numbers: Vec<f32>) -> Self {
        Self::F32(numbers)
    }
}

impl From<Vec<f64>> for Positions {
    fn from(numbers: Vec<f64>) -> Self {
        Self::F64(numbers)
    }
}

impl Positions {
    /// The number of coordinates.
    pub fn len(&self) -> usize {
        match self {
            Self::F32(numbers) => numbers.len(),
            Self::F64(numbers) => numbers.len(),
        }
    }

    /// Whether there are no coordinates.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether they are 64-bit floats.
    pub(crate) fn is_double(&self) -> bool {
        matches!(self, Self::F64(_))
    }

    /// The bytes of their array.
    pub(crate) fn bytes(&self) -> u64 {
        let number = if self.is_double() { 8 } else { 4 };
        number * self.len() as u64
    }

    /// Their words: one for each 32-bit float, two for each 64-bit float.
    pub(crate) fn words_mut(&mut self) -> &mut [u32] {
        match self {
            Self::F32(numbers) => zerocopy::transmute_mut!(numbers.as_mut_slice()),
            Self::F64(numbers) => {
                let pairs: &mut [[u32; 2]] = zerocopy::transmute_mut!(numbers.as_mut_slice());
                pairs.as_flattened_mut()
            }
        }
    }

    /// The coordinates in their order; f32 to f64 is exact.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = f64> + ExactSizeIterator {
        (0..self.len()).map(|i| self.at(i))
    }

    /// The coordinates rounded to the nearest 32-bit floats; infinite if they are too large.
    pub fn to_f32(&self) -> Vec<f32> {
        match self {
            Self::F32(numbers) => numbers.clone(),
            Self::F64(numbers) => numbers.iter().map(|&x| x as f32).collect(),
        }
    }

    /// A copy for JavaScript: a Float32Array or a Float64Array.
    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    pub(crate) fn to_typed_array(&self) -> wasm_bindgen::JsValue {
        match self {
            Self::F32(numbers) => js_sys::Float32Array::from(numbers.as_slice()).into(),
            Self::F64(numbers) => js_sys::Float64Array::from(numbers.as_slice()).into(),
        }
    }

    /// 32-bit floats, if that loses no bit, including the signs of zeros.
    pub(crate) fn narrowed(self) -> Self {
        match &self {
            Self::F64(numbers) if numbers.iter().all(|&x| f64::from(x as f32).to_bits() == x.to_bits()) => {
                Self::F32(self.to_f32())
            }
            _ => self,
        }
    }

    /// Whether no coordinate is NaN or infinite.
    pub(crate) fn are_finite(&self, threads: &Threads) -> bool {
        match self {
            Self::F32(numbers) => {
                let words: &[u32] = zerocopy::transmute_ref!(numbers.as_slice());
                Extremes::of(words, MAGNITUDE, threads).largest < f32::INFINITY.to_bits()
            }
            Self::F64(numbers) => {
                let are_finite =
                    |piece: Range<usize>| numbers[piece].iter().fold(true, |all, x| all & x.is_finite());
                !threads.map(numbers.len(), are_finite).contains(&false)
            }
        }
    }

    /// Refuses coordinates that are NaN or infinite, with [`Error::NonFinite`] for the first.
    pub(crate) fn refuse_non_finite(&self, dimension: Dimension, threads: &Threads) -> Result<(), Error> {
        let found = if self.are_finite(threads) { None } else { self.iter().position(|x| !x.is_finite()) };
        let stride = dimension.stride();
        found.map_or(Ok(()), |i| {
            let axis = ['x', 'y', 'z'][i % stride];
            Err(Error::NonFinite { vertex: i / stride, axis, value: self.at(i) })
        })
    }

    /// Points of a 2D mesh.
    #[inline(always)]
    pub(crate) fn points2<const N: usize>(&self, vertices: [u32; N]) -> [DVec2; N] {
        let tuples = self.tuples(vertices);
        // Not `map`, which is not always inlined; the same below.
        array::from_fn(|i| DVec2::from_array(tuples[i]))
    }

    /// Points of a 3D mesh.
    #[inline(always)]
    pub(crate) fn points3<const N: usize>(&self, vertices: [u32; N]) -> [DVec3; N] {
        let tuples = self.tuples(vertices);
        array::from_fn(|i| DVec3::from_array(tuples[i]))
    }

    /// The `K` coordinates of each vertex.
    #[inline(always)]
    fn tuples<const K: usize, const N: usize>(&self, vertices: [u32; N]) -> [[f64; K]; N] {
        match self {
            Self::F32(numbers) => gathered(numbers, vertices),
            Self::F64(numbers) => gathered(numbers, vertices),
        }
    }

    pub(crate) fn at(&self, i: usize) -> f64 {
        match self {
            Self::F32(numbers) => f64::from(numbers[i]),
            Self::F64(numbers) => numbers[i],
        }
    }
}

#[inline(always)]
fn gathered<T: Copy + Into<f64>, const K: usize, const N: usize>(
    numbers: &[T],
    vertices: [u32; N],
) -> [[f64; K]; N] {
    let (tuples, _) = numbers.as_chunks::<K>();
    array::from_fn(|i| {
        let tuple = tuples[vertices[i] as usize];
        array::from_fn(|k| tuple[k].into())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_that_are_floats_become_floats_bit_by_bit() {
        let narrow = [-0.0, 0.0, 0.1f32, f32::MAX, f32::MIN_POSITIVE, f32::from_bits(1), f32::INFINITY];
        let wide: Vec<f64> = narrow.iter().map(|&x| x.into()).collect();
        let back = Positions::from(wide.clone()).narrowed();
        assert!(
            matches!(&back, Positions::F32(back) if back.iter().zip(narrow).all(|(x, y)| x.to_bits() == y.to_bits()))
        );
        for x in [0.1, f64::MAX, f64::from_bits(1), 1.0f64.next_up()] {
            let wide = Positions::F64([wide.as_slice(), &[x]].concat());
            assert_eq!(wide.clone().narrowed(), wide);
        }
    }

    #[test]
    fn a_coordinate_that_is_not_finite_is_named() {
        for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let narrow = vec![0.0, f32::MAX, f32::MIN, x];
            let wide: Vec<f64> = narrow.iter().map(|&x| x.into()).collect();
            for positions in [Positions::F32(narrow), Positions::F64(wide)] {
                let refused = positions.refuse_non_finite(Dimension::Two, &Threads::one());
                assert!(matches!(refused, Err(Error::NonFinite { vertex: 1, axis: 'y', .. })), "{refused:?}");
            }
        }
        let all = Positions::F32(vec![f32::MAX, f32::MIN]);
        assert!(all.refuse_non_finite(Dimension::Two, &Threads::one()).is_ok());
    }
}
