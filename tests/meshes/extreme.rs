//! Coordinates at the ends of what f32 holds, and ties that are missed by a hair.

use super::{Case, case, lifted, moved, plane, signed};
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
    let mut generator = Rand64::new(19);
    let mantissas = moved(&by_name("random 10").unwrap(), |[x, y, _]| {
        [x * 2f32.powi(generator.rand_range(0..40) as i32 - 20), y + 1e-6 * signed(&mut generator), 0.0]
    });
    both("mixed-exponents", &mantissas);
    cases
}

/// A regular polygon of 16 points, all joined to the first. cos(π/2) is 6e-17, not 0, and stands beside 1.
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

/// Kites that mix numbers far apart: no fixed width of integers holds one of them.
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
