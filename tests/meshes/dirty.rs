//! Meshes that are not clean: folds, non-manifold edges, wrong orientations, degenerate triangles.

use super::{Case, case, joined, lifted, moved, plane, reversed, signed, space};
use edgeflip::{Mesh, families::by_name};
use oorandom::Rand64;

pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    // Each mesh in the plane, and as a flat surface, where a β below 180° has no effect.
    for (name, mesh) in flat() {
        cases.push(case(&format!("{name}-3d"), lifted(&mesh, |_, _| 0.0), 90.0));
        cases.push(case(name, mesh, 10.0));
    }
    for (name, mesh) in bent() {
        for beta in [10.0, 180.0] {
            cases.push(case(name, mesh.clone(), beta));
        }
    }
    for seed in 0..6 {
        let (flat, bent) = soup(seed, 4 + seed as usize / 2, 1 + 3 * seed as usize);
        cases.push(case(&format!("soup-{seed}"), flat, 10.0));
        for beta in [90.0, 180.0] {
            cases.push(case(&format!("soup-{seed}-3d"), bent.clone(), beta));
        }
    }
    cases
}

fn flat() -> Vec<(&'static str, Mesh)> {
    let random = |n: usize| by_name(&format!("random {n}")).unwrap();
    let mut generator = Rand64::new(11);
    let tangled = moved(&by_name("grid 9").unwrap(), |[x, y, z]| {
        [x + 0.12 * signed(&mut generator), y + 0.12 * signed(&mut generator), z]
    });
    vec![
        ("empty", plane(&[], &[])),
        ("single", plane(&[[0., 0.], [1., 0.], [0., 1.]], &[[0, 1, 2]])),
        ("clockwise", reversed(&random(12))),
        ("two-components", joined(&random(8), &moved(&random(9), |[x, y, z]| [x + 2.0, y, z]))),
        ("mixed-components", joined(&random(8), &reversed(&random(9)))),
        ("unused-vertices", joined(&random(6), &plane(&[[7., 7.], [8., 9.]], &[]))),
        ("tangled", tangled),
        ("bow-tie", bow_tie()),
        ("bow-tie-quad", bow_tie_quad()),
        ("folded-quad", folded_quad()),
        ("kite-and-flap", kite_and_flap()),
        ("flat-cap", flat_cap()),
        ("flat-caps-back-to-back", flat_caps()),
        ("needle", needle()),
        ("repeated-index", repeated_index()),
        ("duplicate-triangle", duplicate_triangle()),
        ("two-sided-triangle", two_sided_triangle()),
        ("two-sided-kite", two_sided_kite()),
        ("coincident-vertices", coincident_vertices()),
        ("fan-of-three", fan_of_three()),
        ("inconsistent-pair", inconsistent_pair()),
        ("hole", hole()),
        ("winding-twice", winding_twice()),
    ]
}

fn bent() -> Vec<(&'static str, Mesh)> {
    vec![
        ("moebius", moebius()),
        ("pillow-skew", pillow_skew()),
        ("flat-tetrahedron", flat_tetrahedron()),
        ("three-pages", three_pages()),
    ]
}

/// Two kites that share one vertex only.
/// ```text
///   c1 -- b ... e -- c2      b = the common vertex 0, both long edges (0, 1) and (0, 4)
///    \  / | \ / | \ /        are not Delaunay
///     a1  d1   d2  a2
/// ```
fn bow_tie() -> Mesh {
    plane(
        &[[0., 0.], [4., 0.], [2., 1.], [2., -1.], [-4., 0.], [-2., -1.], [-2., 1.]],
        &[[0, 1, 2], [1, 0, 3], [0, 4, 5], [4, 0, 6]],
    )
}

/// A quad whose outline crosses itself: its second triangle is inverted.
/// ```text
///   2     3
///   |\   /|     triangles (0, 1, 2) and (1, 0, 3) would be one quad
///   | \ / |     if 3 were below 0-1
///   |  X  |
///   0-----1
/// ```
fn bow_tie_quad() -> Mesh {
    plane(&[[0., 0.], [2., 0.], [0., 2.], [2., 2.]], &[[0, 1, 2], [1, 0, 3]])
}

/// 3 lies inside of (0, 1, 2), so (1, 0, 3) is folded onto it.
/// ```text
///        2
///       / \
///      / 3 \
///     /.' '.\
///    0-------1
/// ```
fn folded_quad() -> Mesh {
    plane(&[[0., 0.], [4., 0.], [2., 3.], [2., 1.]], &[[0, 1, 2], [1, 0, 3]])
}

/// The flip of 0-1 would make 2-3, an edge that the triangle (2, 3, 4) has already. This triangle shares two vertices
/// with the kite, but no edge.
/// ```text
///        2 ------.
///      / | \      '.
///     0 -+- 1       4
///      \ | /      .'
///        3 ------'
/// ```
fn kite_and_flap() -> Mesh {
    plane(&[[-2., 0.], [2., 0.], [0., 1.], [0., -1.], [5., 0.]], &[[0, 1, 2], [1, 0, 3], [3, 4, 2]])
}

/// 2 lies on the edge 0-1: the angle there is exactly π. A flip of 0-1 removes the cap. The edge 1-2 is Delaunay and
/// stays.
/// ```text
///         4
///       .' '.
///   0 ---2--- 1      triangles (0, 1, 2), without area, (1, 0, 3) and (2, 1, 4)
///    '.     .'
///       '3'
/// ```
fn flat_cap() -> Mesh {
    plane(&[[0., 0.], [4., 0.], [2., 0.], [2., -3.], [2.5, 2.]], &[[0, 1, 2], [1, 0, 3], [2, 1, 4]])
}

/// Two caps without area share their long edge: 0 --- 2 --- 3 --- 1 on one line.
fn flat_caps() -> Mesh {
    plane(&[[0., 0.], [6., 0.], [2., 0.], [4., 0.], [3., 3.]], &[[0, 1, 2], [1, 0, 3], [0, 2, 4], [2, 1, 4]])
}

/// A triangle ten million times as long as wide between two fat ones.
/// ```text
///            2
///    0 =============== 1       3 a hair below the middle of 0-1
///       '.   3    .'
///           ' 4 '
/// ```
fn needle() -> Mesh {
    plane(
        &[[0., 0.], [1., 0.], [0.5, 0.7], [0.5, -1e-7], [0.5, -0.6]],
        &[[0, 1, 2], [1, 0, 3], [0, 4, 3], [4, 1, 3]],
    )
}

/// Triangles that name a vertex twice or three times, at a kite whose edge should flip.
/// Edge 0-2 has its kite triangle and both sides of (0, 2, 0): frozen.
fn repeated_index() -> Mesh {
    plane(
        &[[-2., 0.], [2., 0.], [0., 1.], [0., -1.]],
        &[[0, 1, 2], [1, 0, 3], [0, 2, 0], [3, 3, 3], [3, 3, 1], [2, 2, 2], [1, 2, 2]],
    )
}

/// The triangle (0, 1, 2) twice: all its edges have two half-edges in the same direction or three.
fn duplicate_triangle() -> Mesh {
    plane(&[[-2., 0.], [2., 0.], [0., 1.], [0., -1.]], &[[0, 1, 2], [1, 0, 3], [0, 1, 2]])
}

/// A triangle and its back side: three edges with twins, each with c = d.
fn two_sided_triangle() -> Mesh {
    plane(&[[-2., 0.], [2., 0.], [0., 0.5]], &[[0, 1, 2], [1, 0, 2]])
}

/// Two kites with back sides. The back of the first is split along the same diagonal, which has four half-edges. The
/// back of the second is split along the other diagonal: a closed, flat pillow.
/// ```text
///        2                    6
///      / | \                / | \
///     0 -+- 1              4 -+- 5
///      \ | /                \ | /
///        3                    7
/// ```
fn two_sided_kite() -> Mesh {
    plane(
        &[[-2., 0.], [2., 0.], [0., 1.], [0., -1.], [8., 0.], [12., 0.], [10., 1.], [10., -1.]],
        &[[0, 1, 2], [1, 0, 3], [1, 0, 2], [0, 1, 3], [4, 5, 6], [5, 4, 7], [7, 6, 5], [6, 7, 4]],
    )
}

/// Vertices 3 and 4 have the same position: triangles without area between proper ones.
fn coincident_vertices() -> Mesh {
    plane(
        &[[0., 0.], [4., 0.], [2., 1.], [2., -1.], [2., -1.], [2., -4.]],
        &[[0, 1, 2], [1, 0, 3], [0, 4, 3], [4, 1, 3], [0, 5, 4], [5, 1, 4]],
    )
}

/// Three triangles at edge 0-1, wide enough that two of them have opposite angles above π in sum.
/// ```text
///        2
///      ./ \.
///     0-----1        and 4 above 2
///      '\ /'
///        3
/// ```
fn fan_of_three() -> Mesh {
    plane(
        &[[-2., 0.], [2., 0.], [0., 1.], [0., -1.], [0., 3.], [3., 3.]],
        &[[0, 1, 2], [1, 0, 3], [0, 1, 4], [1, 5, 4]],
    )
}

/// The kite with one triangle reversed: edge 0-1 has two half-edges in the same direction. On its left is a proper kite
/// of the vertices 0, 2 and two more, so that an edge flips beside it.
fn inconsistent_pair() -> Mesh {
    plane(
        &[[-2., 0.], [2., 0.], [0., 1.], [0., -1.], [-2., 1.5], [-1.2, 1.5]],
        &[[0, 1, 2], [0, 1, 3], [0, 2, 4], [2, 5, 4]],
    )
}

/// A lattice without its middle cells.
fn hole() -> Mesh {
    let mesh = by_name("random 12").unwrap();
    let positions = mesh.positions().to_f32();
    let inside = |&v: &u32| {
        let [x, y] = [0, 1].map(|k| positions[2 * v as usize + k]);
        (0.3..0.65).contains(&x) && (0.3..0.65).contains(&y)
    };
    let kept = mesh.triangles().chunks(3).filter(|t| !t.iter().any(inside)).flatten().copied().collect();
    mesh.with_triangles(kept).unwrap()
}

/// A fan of positive triangles that winds twice around its centre: no fold, yet it covers itself.
/// The points of the second turn have the directions of the first, at another distance.
fn winding_twice() -> Mesh {
    let mut points = vec![[0., 0.]];
    let mut random = Rand64::new(13);
    for k in 0..26 {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(k) / 13.0);
        let radius = 1.0 + 0.4 * f64::from(signed(&mut random));
        points.push([(radius * cos) as f32, (radius * sin) as f32]);
    }
    let triangles: Vec<_> = (0..26).map(|k| [0, 1 + k, 1 + (k + 1) % 26]).collect();
    plane(&points, &triangles)
}

/// A band with half a twist: one of its cross edges has two half-edges in the same direction.
/// ```text
///    0---2---4-- ... --1
///    | / | / |         |     twisted, so that the last pair is the first upside down
///    1---3---5-- ... --0
/// ```
fn moebius() -> Mesh {
    let n = 12;
    let mut points = Vec::new();
    for i in 0..n {
        let around = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        let ((sin, cos), (tilt_sin, tilt_cos)) = (libm::sincos(around), libm::sincos(around / 2.0));
        for side in [-1.0, 1.0] {
            // The cross edges lean to and fro, so that some of the diagonals are not Delaunay.
            let side = side * (0.2 + 0.15 * f64::from(i % 3));
            let radius = 1.0 + side * tilt_cos;
            points.push([radius * cos, radius * sin, side * tilt_sin].map(|x| x as f32));
        }
    }
    let mut triangles = Vec::new();
    for i in 0..n as u32 {
        let [p, q] = [2 * i, 2 * i + 1];
        let [r, s] = if i + 1 == n as u32 { [1, 0] } else { [p + 2, q + 2] };
        triangles.extend([[p, q, r], [q, s, r]]);
    }
    space(&points, &triangles)
}

/// A pillow on whose rim three edges see both apexes, which are near the middle, at more than 90°:
/// each flip would make the edge between the apexes.
/// ```text
///        .2.
///      .' | '.
///     3---A---1       A above, B below
///      '. | .'
///        4 0
/// ```
fn pillow_skew() -> Mesh {
    let mut points: Vec<[f32; 3]> = [0.0, 100.0, 200.0, 300.0, 330.0]
        .map(|degrees: f64| {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            [cos as f32, sin as f32, 0.0]
        })
        .to_vec();
    points.extend([[0.02, 0.01, 0.05], [-0.01, 0.02, -0.05]]);
    let triangles: Vec<_> = (0..5).flat_map(|i| [[i, (i + 1) % 5, 5], [(i + 1) % 5, i, 6]]).collect();
    space(&points, &triangles)
}

/// A tetrahedron with its apex close to the middle of its base: every flip would make an edge that exists.
fn flat_tetrahedron() -> Mesh {
    space(
        &[[0., 0., 0.], [4., 0., 0.], [2., 3., 0.], [2., 1., 0.1]],
        &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    )
}

/// Three kites share the edge 0-1, like the pages of a book. The diagonal of each kite should flip.
/// ```text
///      2---1---...
///      |\  |        page 1: (0, 1, 2) and (0, 2, 5), and so on for 3 and 4
///      | \ |
///      5--.0---...
/// ```
fn three_pages() -> Mesh {
    let page = |angle: f64, across: f64, along: f64| {
        let (sin, cos) = libm::sincos(angle);
        [(across * cos) as f32, (across * sin) as f32, along as f32]
    };
    let mut points = vec![[0., 0., 0.], [0., 0., 1.]];
    let mut triangles = Vec::new();
    for k in 0..3 {
        let angle = 2.1 * f64::from(k);
        points.push(page(angle, 1.0, 1.5));
        points.push(page(angle, 0.3, 0.4 + 0.3 * f64::from(k)));
        let p = points.len() as u32 - 2;
        triangles.extend([[0, 1, p + 1], [p, p + 1, 1], [0, p + 1, p]]);
    }
    space(&points, &triangles)
}

/// A small disc and `extra` random triangles of its vertices, in the plane and in space. They have every fault at once.
/// In the disc, some edges can flip. Most of the further triangles share an edge with an earlier one.
pub fn soup(seed: u64, n: usize, extra: usize) -> (Mesh, Mesh) {
    let disc = by_name(&format!("random {n} seed={seed}")).unwrap();
    let side = 4.0 * n as f32;
    let disc = moved(&disc, |[x, y, _]| [(side * x).round(), (side * y).round(), 0.0]);
    let mut random = Rand64::new(u128::from(100 + seed));
    let mut below = |n: usize| random.rand_range(0..n as u64) as usize;
    let vertices = disc.vertex_count();
    let mut triangles: Vec<u32> = disc.triangles().to_vec();
    for _ in 0..extra {
        let h = below(triangles.len());
        let edge = [triangles[if h % 3 == 2 { h - 2 } else { h + 1 }], triangles[h]];
        match below(4) {
            0 => triangles.extend([0; 3].map(|_: u32| below(vertices) as u32)),
            1 => triangles.extend([edge[1], edge[0], below(vertices) as u32]),
            _ => triangles.extend([edge[0], edge[1], below(vertices) as u32]),
        }
    }
    let flat = disc.with_triangles(triangles).unwrap();
    let bent = lifted(&flat, |_, _| (below(7) as f32 - 3.0) / 2.0);
    (flat, bent)
}
