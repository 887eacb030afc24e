//! The engines count the same inverted and flat triangles, also where only exact arithmetic can tell.

use super::{any_deviation, engines};
use crate::engine::Engine;
use crate::mesh::Mesh;
use crate::mesh::areas::Areas;
use crate::{Dimension, Positions};
use oorandom::Rand32;
use pollster::block_on;
use std::sync::Arc;

/// Quads of a mesh. No two share a vertex.
const QUADS: usize = 1000;

/// The four points of a quad of one kind, which are often on one line, exactly or nearly. `is_double`: in 64-bit floats.
fn quad(kind: usize, stride: usize, is_double: bool, random: &mut Rand32) -> Vec<f64> {
    let mut whole = |end: u32| f64::from(random.rand_range(0..2 * end + 1)) - f64::from(end);
    let ulp = if is_double { f64::EPSILON } else { f64::from(f32::EPSILON) };
    match kind {
        // A small lattice.
        0 => (0..4 * stride).map(|_| whole(2)).collect(),
        // Points on a line, some of them off by one unit in the last place.
        1 => {
            let (start, step): (Vec<_>, Vec<_>) =
                (0..stride).map(|_| (1.0 + 0.125 * whole(3), 0.0625 * whole(2))).unzip();
            let at = |k: f64, axis: usize| start[axis] + k * step[axis];
            let points =
                [0.0, 3.0, 1.0, 4.0].map(|k| (0..stride).map(|axis| at(k, axis)).collect::<Vec<_>>());
            points.concat().into_iter().map(|x| x + ulp * (whole(1) * whole(1)).max(0.0)).collect()
        }
        // Points of any size, so that all bits that a GPU decides are in use.
        _ => (0..4 * stride)
            .map(|_| {
                let exponent = if is_double { 14 } else { 28 };
                let mantissa = 1.0 + ulp * (whole(1 << 22) + f64::from(1 << 22)).floor();
                mantissa * libm::exp2(whole(exponent)) * if whole(1) > 0.0 { -1.0 } else { 1.0 }
            })
            .collect(),
    }
}

fn counted(what: &str, mesh: Mesh) -> Areas {
    let (mut cpu, mut gpu) = engines(&Arc::new(mesh), any_deviation(180.0));
    let [by_cpu, by_gpu] = [block_on(cpu.areas()), block_on(gpu.areas())].map(Result::unwrap);
    assert_eq!(by_cpu, by_gpu, "{what}");
    // They stay the same numbers after a count, and agree after a run.
    assert_eq!(block_on(gpu.areas()).unwrap(), by_gpu, "{what}");
    block_on(cpu.iterate(u32::MAX)).unwrap();
    block_on(gpu.iterate(u32::MAX)).unwrap();
    assert_eq!(block_on(cpu.areas()).unwrap(), block_on(gpu.areas()).unwrap(), "{what}, after a run");
    by_cpu
}

#[test]
fn near_flat_triangles_are_counted_alike() {
    for dimension in [Dimension::Two, Dimension::Three] {
        for is_double in [false, true] {
            for kind in 0..3 {
                let mut random = Rand32::new(7);
                let what = format!("{dimension:?}, kind {kind}, doubles: {is_double}");
                let numbers = (0..QUADS).flat_map(|_| quad(kind, dimension.stride(), is_double, &mut random));
                let doubles: Vec<f64> = numbers.collect();
                let positions: Positions = if is_double {
                    doubles.into()
                } else {
                    doubles.iter().map(|&x| x as f32).collect::<Vec<_>>().into()
                };
                let triangles =
                    (0..QUADS as u32).flat_map(|i| [0, 1, 2, 1, 0, 3].map(|v| v + 4 * i)).collect();
                let Areas { inverted, flat, undecided } =
                    counted(&what, Mesh::new(dimension, positions, triangles).unwrap());
                assert_eq!(undecided, 0, "{what}");
                assert_eq!(inverted > 100, dimension == Dimension::Two, "{what}: {inverted}");
                assert_eq!(flat > 20, kind < 2, "{what}: {flat}");
            }
        }
    }
}
