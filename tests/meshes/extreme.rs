//! The smallest and largest coordinates in f32 and f64, and near ties.

use super::{Case, case, lifted, moved, moved_wide, plane, signed};
use edgeflip::families::by_name;
use oorandom::Rand64;

pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut both = |name: &str, mesh: &edgeflip::Mesh| {
        cases.push(case(name, mesh.clone(), 10.0));
        let z = |x: f32, y: f32| x * 0.25 + y * 0.125;
        cases.push(case(&format!("{name}-3d"), lifted(mesh, z), 60.0));
    };
    let random = by_name("random 12").unwrap();
    let scaled = |s: f32| moved(&random, |p| p.map(|x| x * s));
    // Below 1.2e-38 the numbers are subnormal and lose bits one by one: 1e-43 is 71 times the smallest.
    both("scale-1e-38", &scaled(1e-38));
    both("scale-1e-43", &scaled(1e-43));
    both("scale-1e30", &scaled(1e30));
    both("scale-3e38", &moved(&random, |[x, y, _]| [(x - 0.5) * 3e38 * 2.0, (y - 0.5) * 3e38 * 2.0, 0.0]));

    let mut generator = Rand64::new(17);
    let hair = moved(&by_name("regular 12 1").unwrap(), |p| {
        p.map(|x| match generator.rand_range(0..3) {
            0 => x.next_up(),
            1 => x.next_down(),
            _ => x,
        })
    });
    both("lattice-one-ulp", &hair);
    both("lattice-offset", &by_name("regular 12 100000").unwrap());
    both("polygon-cos-noise", &polygon());
    both("magnitudes", &magnitudes());
    both("wide-side", &wide_side());
    let mut generator = Rand64::new(19);
    let mantissas = moved(&by_name("random 10").unwrap(), |[x, y, _]| {
        [x * 2f32.powi(generator.rand_range(0..40) as i32 - 20), y + 1e-6 * signed(&mut generator), 0.0]
    });
    both("mixed-exponents", &mantissas);
    cases.extend(doubles());
    cases
}

/// Kites, almost on a circle, in which one side is twice as long as the others and as the distances between the other
/// corners: of the four differences of the test of an edge, one alone has bits above 2^39.
fn wide_side() -> edgeflip::Mesh {
    const UNIT: f32 = 8_388_608.0;
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for (kite, by) in [-1.0, 1.0, -1.0, 1.0].into_iter().enumerate() {
        points.extend([[0., 0.], [0., 62_166.], [-1., 31_083.], [7., -56_833.]].map(|p| p.map(|x| x * UNIT)));
        points[4 * kite + 2][0] += by;
        let mut pair = [[0, 1, 2], [1, 0, 3]].map(|triangle| triangle.map(|corner| 4 * kite as u32 + corner));
        if kite > 1 {
            pair.reverse();
        }
        triangles.extend(pair);
    }
    plane(&points, &triangles)
}

/// Coordinates that 32-bit floats cannot hold.
fn doubles() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut both = |name: &str, mesh: &edgeflip::Mesh, map: &mut dyn FnMut(f64) -> f64| {
        let mesh = moved_wide(mesh, |p| p.map(&mut *map).to_vec());
        let surface = moved_wide(&mesh, |[x, y]| vec![x, y, x * 0.25 + y * 0.125]);
        cases.push(case(&format!("f64-{name}"), mesh, 10.0));
        cases.push(case(&format!("f64-{name}-3d"), surface, 60.0));
    };
    let (random, lattice) = (by_name("random 12").unwrap(), by_name("regular 12").unwrap());
    // The lattice's spacing is 0.1.
    let line = |x: f64| (10.0 * x).round();
    both("lattice-offset", &lattice, &mut |x| 0.1 * line(x) + 1e6);
    let mut generator = Rand64::new(23);
    both("lattice-one-ulp", &lattice, &mut |x| {
        let x = 0.1 * line(x) + 1e6;
        [x, x.next_up(), x.next_down()][generator.rand_range(0..3) as usize]
    });
    // Metres of Web Mercator, a micrometre apart.
    both("mercator", &random, &mut |x| 1.2e7 + 12e-6 * x);
    both("scale-max", &random, &mut |x| (2.0 * x - 1.0) * f64::MAX);
    // At 1e160 and 1e-160, products of two coordinates overflow or underflow; at 1e80 and 1e-80, products of four do.
    // At 1e-300, only the smallest coordinates lose bits.
    for (name, scale) in
        [("1e160", 1e160), ("1e80", 1e80), ("1e-80", 1e-80), ("1e-160", 1e-160), ("1e-300", 1e-300)]
    {
        both(&format!("scale-{name}"), &random, &mut |x| (x - 0.5) * scale);
    }
    both("subnormal", &random, &mut |x| x * 1e-320);
    // Magnitudes from 1e-300 to 1e300, in ascending order along each axis.
    both("magnitudes", &by_name("random 8").unwrap(), &mut |x| {
        (1.0 + x) * 2f64.powi((2000.0 * x) as i32 - 1000)
    });
    let mut generator = Rand64::new(29);
    both("magnitudes-mixed", &by_name("random 8").unwrap(), &mut |_| {
        f64::from(signed(&mut generator)) * 2f64.powi(generator.rand_range(0..2000) as i32 - 1000)
    });
    cases
}

/// A regular polygon of 16 points, all joined to the first. One coordinate is cos(π/2), rounded to 6e-17 and not 0,
/// next to a 1.
fn polygon() -> edgeflip::Mesh {
    let points: Vec<_> = (0..16)
        .map(|i| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 16.0);
            [cos as f32, sin as f32]
        })
        .collect();
    let triangles: Vec<_> = (1..15).map(|i| [0, i, i + 1]).collect();
    plane(&points, &triangles)
}

/// Kites whose coordinates have very different magnitudes: no integers of a fixed width hold all coordinates of a kite.
/// ```text
///            3 (0, 1e30)
///          /   \
///   0 (-1, 0)---1 (1, 1e-40)      and 2 close below, 4 a copy of the kite 1e-30 high
///          \   /
///            2
/// ```
fn magnitudes() -> edgeflip::Mesh {
    plane(
        &[[-1., 0.], [1., 1e-40], [0., -1e-30], [0., 1e30], [3e38, -3e38], [1e-44, -1.], [-1e-38, -1e20]],
        &[[0, 1, 3], [1, 0, 2], [0, 5, 2], [5, 1, 2], [0, 6, 5], [6, 1, 5], [1, 6, 4]],
    )
}
