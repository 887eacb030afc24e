//! Triangles that are turned over or flat: what a run counts, what the audit lists, and an exact count of integers.
#![cfg(feature = "gpu")]

use crate::meshes::{joined, plane, reversed, space};
use edgeflip::quality::{Violation, audit};
use edgeflip::{Backend, Dimension, Mesh, Options, Order, Session, families::by_name, make_delaunay};
use oorandom::Rand32;
use pollster::block_on;
use std::collections::HashMap;
use std::ops::ControlFlow;

fn options(backend: Backend, order: Order) -> Options {
    Options { backend, order, max_normal_angle: 180.0, ..Options::default() }
}

/// What a run on an engine leaves: the triangles, and how many are inverted and flat.
fn left_by(mesh: &Mesh, options: &Options) -> (Vec<u32>, [u32; 2]) {
    let outcome = make_delaunay(mesh, options, |_, _| ControlFlow::Continue(())).unwrap();
    (outcome.triangles, [outcome.inverted, outcome.flat])
}

/// The inverted and the flat triangles that both engines leave. Asserts that they agree, and that the audit lists these
/// triangles and finds no violation.
#[track_caller]
fn left(mesh: &Mesh) -> [u32; 2] {
    let [(triangles, found), on_gpu] =
        [Backend::Cpu, Backend::Gpu].map(|backend| left_by(mesh, &options(backend, Order::Reproducible)));
    assert_eq!((&triangles, found), (&on_gpu.0, on_gpu.1));
    let audit = audit(mesh, &triangles, &options(Backend::Cpu, Order::Reproducible));
    assert_eq!([audit.inverted.len() as u32, audit.flat.len() as u32], found);
    assert_eq!(audit.violations, []);
    assert_eq!(audit.is_clean(), found[0] == 0);
    found
}

/// Counts the inverted and the flat triangles of a mesh in the plane with integer coordinates, by code of its own: the
/// components are merged over edges, and areas are sums of 128-bit integers.
fn counted(mesh: &Mesh, triangles: &[u32]) -> [u32; 2] {
    let numbers: Vec<i128> = mesh.positions().iter().map(|x| x as i128).collect();
    let point = |v: u32| [numbers[2 * v as usize], numbers[2 * v as usize + 1]];
    let area = |t: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|k| point(t[k]));
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let areas: Vec<i128> = triangles.chunks(3).map(area).collect();
    // For each edge: its triangles, and whether each passes it from the smaller end to the larger one.
    let mut edges: HashMap<[u32; 2], Vec<(usize, bool)>> = HashMap::new();
    for (t, corners) in triangles.chunks(3).enumerate() {
        for (u, v) in [(corners[0], corners[1]), (corners[1], corners[2]), (corners[2], corners[0])] {
            edges.entry([u.min(v), u.max(v)]).or_default().push((t, u < v));
        }
    }
    let mut component: Vec<usize> = (0..areas.len()).collect();
    for sides in edges.values() {
        if let [(s, up), (t, down)] = sides[..]
            && (s != t && up != down)
        {
            let [from, to] = [component[s], component[t]];
            component.iter_mut().filter(|c| **c == from).for_each(|c| *c = to);
        }
    }
    let total = |of: usize| -> i128 {
        areas.iter().zip(&component).filter(|&(_, &c)| c == of).map(|(area, _)| area).sum()
    };
    let is_inverted = |t: usize| if total(component[t]) < 0 { areas[t] > 0 } else { areas[t] < 0 };
    let inverted = (0..areas.len()).filter(|&t| is_inverted(t)).count();
    [inverted as u32, areas.iter().filter(|&&area| area == 0).count() as u32]
}

/// A sheet of a lattice whose vertices are thrown about: its triangles overlap, and some are flat. Some sheets are
/// clockwise, some have holes or a second sheet on top, some have a triangle that is turned alone.
fn folded(seed: u64) -> Mesh {
    let mut random = Rand32::new(seed);
    let side = random.rand_range(2..7);
    // Few places, so that flat triangles are frequent; or many, up to where 32-bit floats are whole.
    let (step, noise) = [(4, 3), (4, 7), (1, 1), (1 << 20, 1 << 21)][random.rand_range(0..4) as usize];
    let mut thrown = |i: u32| (i * step) as f32 + random.rand_range(0..2 * noise + 1) as f32 - noise as f32;
    let positions: Vec<f32> = (0..=side)
        .flat_map(|j| (0..=side).map(move |i| [i, j]))
        .flat_map(|[i, j]| [thrown(i), thrown(j)])
        .collect();
    let at = |i, j| i + (side + 1) * j;
    let mut triangles = Vec::new();
    for (i, j) in (0..side).flat_map(|j| (0..side).map(move |i| (i, j))) {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        let two = if random.rand_range(0..2) == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
        triangles.extend(two.into_iter().filter(|_| random.rand_range(0..12) > 0).flatten());
    }
    if random.rand_range(0..4) == 0
        && let Some(first) = triangles.first_chunk_mut::<3>()
    {
        first.swap(0, 1);
    }
    let sheet = Mesh::new(Dimension::Two, positions, triangles).unwrap();
    match random.rand_range(0..4) {
        0 => reversed(&sheet),
        1 => joined(&sheet, &reversed(&sheet)),
        _ => sheet,
    }
}

#[test]
fn folded_planes_are_counted_exactly() {
    let mut sums = [0, 0];
    for seed in 0..2000 {
        let mesh = folded(seed);
        let before = counted(&mesh, mesh.triangles());
        for order in [Order::Reproducible, Order::Any] {
            let (triangles, found) = left_by(&mesh, &options(Backend::Cpu, order));
            assert_eq!(found, counted(&mesh, &triangles), "{seed}, {order:?}");
            // No flip makes more of them.
            assert!(found[0] + found[1] <= before[0] + before[1], "{seed}, {order:?}: {before:?}, {found:?}");
            sums = [sums[0] + found[0], sums[1] + found[1]];
        }
        if seed % 20 == 0 {
            left(&mesh);
        }
    }
    assert!(sums[0] > 5000 && sums[1] > 5000, "{sums:?}");
}

/// Two pairs of triangles on one square; 4 and 5 are at the same place in its middle.
#[test]
fn a_needle_is_flat() {
    let points = [[0., 0.], [2., 0.], [2., 2.], [0., 2.], [1., 1.], [1., 1.]];
    let triangles = [[0, 1, 4], [1, 2, 5], [4, 1, 5], [2, 3, 5], [3, 0, 4], [4, 5, 3]];
    assert_eq!(left(&plane(&points, &triangles)), [0, 2]);
    assert_eq!(left(&space(&points.map(|[x, y]| [x, y, x - y]), &triangles)), [0, 2]);
}

/// Vertex 5 was dragged across others.
#[test]
fn a_dragged_vertex_turns_triangles_over() {
    let points = [[0., 0.], [8., 0.5], [8.5, 8.], [-0.5, 8.5], [1., 7.], [5., 6.]];
    let triangles = [[5, 2, 4], [5, 3, 2], [4, 1, 5], [5, 0, 3], [2, 1, 4], [1, 0, 5]];
    let mesh = plane(&points, &triangles);
    let [inverted, flat] = left(&mesh);
    assert!(inverted > 0 && flat == 0, "{inverted}, {flat}");
    let mut session = block_on(Session::new(&mesh, options(Backend::Cpu, Order::Reproducible))).unwrap();
    let audit = block_on(session.verify()).unwrap();
    assert!(!audit.is_clean() && audit.violations.is_empty() && audit.unlisted == 0);
    assert_eq!(audit.inverted, [0, 2]);
}

#[test]
fn a_component_has_the_orientation_of_its_area() {
    let sheet = by_name("random 6").unwrap();
    for mesh in [&sheet, &reversed(&sheet), &joined(&sheet, &reversed(&sheet))] {
        assert_eq!(left(mesh), [0, 0]);
    }
    // Two triangles on the same side of their common edge: the smaller one is inverted. If they have the same area, the
    // clockwise one is.
    for (x, expected) in [(-3., 1), (-1., 0), (-2., 1)] {
        let bow = plane(&[[0., 0.], [0., 2.], [x, 1.], [-2., 3.]], &[[0, 1, 2], [1, 0, 3]]);
        let triangles = bow.triangles();
        let audit = audit(&bow, triangles, &Options::default());
        assert_eq!(audit.inverted, [expected], "{x}");
        assert_eq!(counted(&bow, triangles)[0], 1);
        assert_eq!(left(&bow), [1, 0], "{x}");
    }
    // A triangle that is turned against its neighbours is a component of its own.
    assert_eq!(left(&plane(&[[0., 0.], [1., 0.], [0., 1.], [1., 1.]], &[[0, 1, 2], [1, 2, 3]])), [0, 0]);
}

/// Three points in a row, and one of them moved by the smallest step.
#[test]
fn flat_is_exact() {
    let third = f64::from(1f32 / 3.0);
    for scale in [1.0, 2f64.powi(-500), 2f64.powi(500)] {
        for (y, expected) in [(third, [0, 1]), (third.next_up(), [0, 0]), (third.next_down(), [1, 0])] {
            let positions = [0.0, 0.0, third, y, 1.0, 1.0, 2.0, -4.0].map(|x| x * scale).to_vec();
            let mesh = Mesh::new(Dimension::Two, positions, vec![0, 2, 1, 0, 3, 2]).unwrap();
            // The edge between the two triangles may not flip.
            let locked = Options { locked_edges: vec![[0, 2]], ..options(Backend::Cpu, Order::Reproducible) };
            assert_eq!(left_by(&mesh, &locked).1, expected, "{y}, {scale}");
            let lifted = mesh.positions().iter().collect::<Vec<_>>();
            let lifted = lifted.chunks(2).flat_map(|p| [p[1], p[0], p[0]]).collect::<Vec<_>>();
            let surface = Mesh::new(Dimension::Three, lifted, mesh.triangles().to_vec()).unwrap();
            assert_eq!(left_by(&surface, &locked).1, [0, expected[1]], "{y}, {scale}");
        }
    }
}

/// More flat or inverted triangles than before are a violation.
#[test]
fn a_triangle_that_a_result_turns_over_is_a_violation() {
    let dart = plane(&[[-2., 0.], [2., 0.], [1., 1.], [1.2, 2.]], &[[0, 1, 2], [1, 3, 2]]);
    let audit = audit(&dart, &[0, 1, 3, 0, 3, 2], &Options::default());
    assert_eq!(audit.violations, [Violation::Inverted { before: 0, after: 1 }]);
    assert_eq!(audit.inverted, [1]);
}
