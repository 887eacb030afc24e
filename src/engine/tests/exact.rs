//! Edges that only long integers decide: pairs of triangles with an exact tie, or next to one, whose coordinates span up
//! to 84 bits.

use super::{any_deviation, compare_mesh, engines};
use crate::mesh::Mesh;
use crate::phases::Thresholds;
use crate::{Dimension, Positions, cos_degrees};
use pollster::block_on;
use std::sync::Arc;

/// Every coordinate is a multiple of this, and less than 2^84 times as large.
const UNIT: f64 = 1.0 / (1u64 << 43) as f64;
const DEVIATION: f64 = 3.0 / 1024.0;

struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % end
    }

    /// A number of up to so many bits, anywhere in the span. Three times as much fits as well.
    fn wide(&mut self, bits: u32) -> f64 {
        let mantissa = (self.below(1 << 31) << 22 | self.below(1 << 22)) >> (53 - bits) | 1;
        mantissa as f64 * UNIT * 2f64.powi(self.below(u64::from(82 - bits)) as i32)
    }
}

/// The corners a, b, c, d of the triangles a, b, c and b, a, d.
type Quad = [[f64; 3]; 4];

/// The diagonals of a rectangle about the origin: the opposite angles sum to π.
fn rectangle(numbers: &mut Numbers, bits: u32, dimension: Dimension) -> Quad {
    let [x, y, z] = [(); 3].map(|()| numbers.wide(bits));
    match dimension {
        Dimension::Two => [[x, y, 0.0], [-x, -y, 0.0], [-y, x, 0.0], [y, -x, 0.0]],
        Dimension::Three => [[x, y, z], [-x, -y, -z], [y, z, x], [-y, -z, -x]],
    }
}

/// An edge whose normals differ by 60°, and opposite angles of any size.
fn hinge_of_60(numbers: &mut Numbers, bits: u32) -> Quad {
    let [s, x, y] = [(); 3].map(|()| numbers.wide(bits));
    [[s, s, s], [-s, -s, -s], [-x, -x, 2.0 * x], [2.0 * y, -y, -y]]
}

/// The same with normals at a right angle.
fn hinge_of_90(numbers: &mut Numbers, bits: u32) -> Quad {
    let [s, x, y, z] = [(); 4].map(|()| numbers.wide(bits));
    [[0.0, 0.0, s], [0.0, 0.0, -s], [x, y, z], [-y, x, -z]]
}

/// Two diagonals whose lines are as far apart as the limit allows.
fn bridge(numbers: &mut Numbers, bits: u32) -> Quad {
    let [x, y] = [(); 2].map(|()| numbers.wide(bits));
    [[x, 2.0 * x, 0.0], [-x, -2.0 * x, 0.0], [y, -y, DEVIATION], [-y, y, DEVIATION]]
}

/// Moves a coordinate to the next number of `bits` bits, mostly.
fn nudge(quad: &mut Quad, numbers: &mut Numbers, bits: u32, axes: u64) {
    let x = &mut quad[numbers.below(4) as usize][numbers.below(axes) as usize];
    let step = UNIT.max(2f64.powi(x.abs().max(UNIT).log2() as i32 - bits as i32));
    *x += if numbers.below(2) == 0 { step } else { -step };
}

/// Quads that share no vertices, as floats of 24 bits, or as doubles.
fn mesh_of(dimension: Dimension, is_fixed: bool, count: u32) -> Mesh {
    let mut numbers = Numbers(7);
    let (bits, most) = if is_fixed { (40, 50) } else { (21, 23) };
    let axes = dimension.stride();
    let mut positions = Vec::new();
    for i in 0..count {
        let mut quad = match (dimension, i % 4) {
            (Dimension::Two, _) | (_, 0) => rectangle(&mut numbers, bits, dimension),
            (_, 1) => hinge_of_60(&mut numbers, bits),
            (_, 2) => hinge_of_90(&mut numbers, bits),
            _ => bridge(&mut numbers, bits),
        };
        let first = numbers.below(axes as u64) as usize;
        for _ in 0..numbers.below(3) {
            nudge(&mut quad, &mut numbers, most, axes as u64);
        }
        positions
            .extend(quad.iter().flat_map(|corner| (0..axes).map(move |axis| corner[(first + axis) % axes])));
    }
    let triangles = (0..count).flat_map(|i| [0, 1, 2, 1, 0, 3].map(|corner| 4 * i + corner)).collect();
    let floats: Vec<f32> = positions.iter().map(|&x| x as f32).collect();
    let are_floats = floats.iter().zip(&positions).all(|(&x, &y)| f64::from(x) == y);
    assert!(are_floats != is_fixed);
    let positions = if is_fixed { Positions::F64(positions) } else { Positions::F32(floats) };
    Mesh::new(dimension, positions, triangles).unwrap()
}

/// Each form of shader, with angles β and limits that are ties too.
#[test]
fn ties_of_wide_integers_agree() {
    for (dimension, is_fixed) in
        [(Dimension::Two, false), (Dimension::Two, true), (Dimension::Three, false), (Dimension::Three, true)]
    {
        let mesh = mesh_of(dimension, is_fixed, 160);
        let is_plane = dimension == Dimension::Two;
        for degrees in if is_plane { &[180.0][..] } else { &[60.0, 90.0, 180.0] } {
            for deviation in if is_plane { &[f32::INFINITY][..] } else { &[f32::INFINITY, DEVIATION as f32] }
            {
                let thresholds = Thresholds { cos: cos_degrees(*degrees), deviation: *deviation };
                compare_mesh("ties", mesh.clone(), thresholds);
            }
        }
        let (_, gpu) = engines(&Arc::new(mesh), any_deviation(180.0));
        let [_, exact] = block_on(gpu.tiers()).unwrap();
        assert!(exact > 60, "{exact} edges of 160 need exact arithmetic");
    }
}
