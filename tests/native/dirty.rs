//! Tests what the engines promise for each kind of dirty mesh, on the CPU and the GPU.
#![cfg(feature = "gpu")]

use crate::matrix::named;
use crate::meshes::{joined, lifted, moved, moved_wide, plane, reversed, signed, space};
use edgeflip::quality::audit;
use edgeflip::{
    Backend, Dimension, EngineKind, Mesh, Options, Outcome, Reason, Status, families::by_name, make_delaunay,
};
use oorandom::Rand64;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// The outcome of a run. Asserts that both engines agree, and that the audit finds no violation.
#[track_caller]
fn run(mesh: &Mesh, beta: f64) -> Outcome {
    let options = |backend| Options { backend, max_normal_angle: beta, ..Options::default() };
    let [cpu, gpu] = [Backend::Cpu, Backend::Gpu]
        .map(|backend| make_delaunay(mesh, &options(backend), |_, _| ControlFlow::Continue(())).unwrap());
    assert_eq!((cpu.backend, gpu.backend), (EngineKind::Cpu, EngineKind::Gpu));
    assert_eq!(cpu.triangles, gpu.triangles);
    assert_eq!(cpu.flips_per_iteration, gpu.flips_per_iteration);
    assert_eq!((kinds(&cpu), cpu.remaining), (kinds(&gpu), gpu.remaining));
    assert_eq!((cpu.status, gpu.status), (Status::Done, Status::Done));
    let audit = audit(mesh, &cpu.triangles, &options(Backend::Cpu));
    assert!(audit.violations.is_empty(), "{:?}", audit.violations);
    assert_eq!(audit.remaining, cpu.remaining);
    assert_eq!([cpu.inverted, cpu.flat], [gpu.inverted, gpu.flat]);
    assert_eq!([cpu.inverted, cpu.flat], [&audit.inverted, &audit.flat].map(|list| list.len() as u32));
    assert_eq!(cpu.remaining[Reason::Stopped], 0);
    cpu
}

/// The mesh of that name in `meshes::dirty`.
fn dirty(name: &str) -> Mesh {
    named(name).mesh.clone()
}

/// The mesh as a surface in the plane z = 0.
fn flat(mesh: &Mesh) -> Mesh {
    lifted(mesh, |_, _| 0.0)
}

/// A triangulated square of integer coordinates whose edges are mostly not Delaunay.
fn integers() -> Mesh {
    moved(&by_name("random 12").unwrap(), |p| p.map(|x| (1000.0 * x).round()))
}

/// The numbers of all edges, boundary edges, non-manifold edges and inconsistent edges.
fn kinds(outcome: &Outcome) -> [u64; 4] {
    [outcome.edges, outcome.boundary_edges, outcome.non_manifold_edges, outcome.inconsistent_edges]
}

/// Pairs of vertices joined by an edge, the smaller one first.
fn edges(triangles: &[u32]) -> BTreeSet<[u32; 2]> {
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]];
    triangles.as_chunks().0.iter().flat_map(sides).map(|[u, v]| [u.min(v), u.max(v)]).collect()
}

/// Twice the signed area of each triangle of a mesh in the plane, whose coordinates are integers.
fn areas(mesh: &Mesh, triangles: &[u32]) -> Vec<i64> {
    let points = mesh.positions().to_f32();
    let point = |v: u32| [0, 1].map(|k| points[2 * v as usize + k] as i64);
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(point);
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    triangles.as_chunks().0.iter().map(area).collect()
}

/// Three quads share the edge 0-1, like the pages of a book. Each is cut along its wrong diagonal.
/// ```text
///   1----R
///   | \   \       all three meet at 0-1, 1-Q flips to 0-R in each
///   |   \  \
///   0-----'-Q
/// ```
#[test]
fn non_manifold_edges() {
    let mut points = vec![[0., 0., 0.], [0., 0., 2.]];
    let mut triangles = Vec::new();
    for (page, [x, y]) in [[1., 0.], [-1., 0.], [0., 1.]].into_iter().enumerate() {
        let q = 2 + 2 * page as u32;
        points.extend([[3. * x, 3. * y, 0.], [2. * x, 2. * y, 2.]]);
        triangles.extend([[0, q, 1], [1, q, q + 1]]);
    }
    let book = run(&space(&points, &triangles), 10.0);
    assert_eq!((kinds(&book), book.flips), ([13, 9, 1, 0], 3));
    assert!([[0, 1], [0, 3], [0, 5], [0, 7]].iter().all(|edge| edges(&book.triangles).contains(edge)));
    assert_eq!(book.remaining.total(), 0);
    // A non-manifold edge that is not Delaunay is counted.
    let fan = run(&dirty("fan-of-three"), 10.0);
    assert_eq!((fan.non_manifold_edges, fan.remaining[Reason::NonManifold]), (1, 1));
    assert_eq!(fan.remaining.total(), 1);
}

#[test]
fn bow_tie_vertices() {
    for mesh in [dirty("bow-tie"), dirty("bow-tie-3d")] {
        let outcome = run(&mesh, 10.0);
        assert_eq!((kinds(&outcome), outcome.flips), ([10, 8, 0, 0], 2));
        assert!(edges(&outcome.triangles).is_superset(&[[2, 3], [5, 6]].into()));
        assert_eq!(outcome.remaining.total(), 0);
    }
}

#[test]
fn isolated_vertices() {
    let with = run(&dirty("unused-vertices"), 10.0);
    let without = run(&by_name("random 6").unwrap(), 10.0);
    assert_eq!(with.triangles, without.triangles);
    assert!(with.flips > 0);
}

#[test]
fn several_components() {
    let parts = ["random 8", "random 9"].map(|name| by_name(name).unwrap());
    let offset = parts[0].vertex_count() as u32;
    let [first, second] = parts.map(|part| edges(&run(&part, 10.0).triangles));
    let second = second.into_iter().map(|edge| edge.map(|v| v + offset));
    let both = run(&dirty("two-components"), 10.0);
    assert_eq!(edges(&both.triangles), first.into_iter().chain(second).collect());
}

#[test]
fn open_boundaries() {
    let boundary = edgeflip::Adjacency::new(&dirty("hole")).boundary;
    for mesh in [dirty("hole"), dirty("hole-3d")] {
        let outcome = run(&mesh, 10.0);
        assert!(outcome.flips > 0 && boundary > 4 * 11);
        assert_eq!((outcome.boundary_edges, outcome.remaining.total()), (boundary.into(), 0));
    }
}

#[test]
fn inconsistent_orientation() {
    let pair = run(&dirty("inconsistent-pair"), 10.0);
    assert_eq!(pair.inconsistent_edges, 1);
    assert!(edges(&pair.triangles).contains(&[0, 1]));
    assert_eq!((pair.remaining[Reason::Inconsistent], pair.remaining.total()), (1, 1));
    // In a band with half a twist, only one edge is inconsistent.
    let moebius = run(&dirty("moebius"), 60.0);
    assert_eq!((moebius.non_manifold_edges, moebius.inconsistent_edges), (0, 1));
    assert!(moebius.flips > 0);
}

#[test]
fn duplicate_triangles() {
    // Edges 1-2 and 2-0 of the kite have two half-edges in the same direction, and 0-1 has three half-edges.
    let kite = run(&dirty("duplicate-triangle"), 10.0);
    assert_eq!((kinds(&kite), kite.flips), ([5, 2, 1, 2], 0));
    assert_eq!((kite.remaining[Reason::NonManifold], kite.remaining.total()), (1, 1));
    // One repeated triangle freezes only its own edges.
    let mesh = by_name("random 12").unwrap();
    let some = [mesh.triangles(), &mesh.triangles()[150..153]].concat();
    let outcome = run(&mesh.with_triangles(some).unwrap(), 10.0);
    assert_eq!((outcome.non_manifold_edges, outcome.inconsistent_edges), (3, 0));
    assert!(outcome.flips > 0);
    // If all triangles are repeated, no edge may flip.
    let all = mesh.with_triangles(mesh.triangles().repeat(2)).unwrap();
    let outcome = run(&all, 10.0);
    assert_eq!((&outcome.triangles[..], outcome.flips), (all.triangles(), 0));
    assert_eq!((outcome.boundary_edges, outcome.inconsistent_edges), (0, 44));
    assert_eq!(outcome.non_manifold_edges, outcome.edges - 44);
}

#[test]
fn caps() {
    // A cap without area, and one with almost none. Both have the long edge 0-1.
    for name in ["flat-cap", "flat-cap-3d", "needle", "needle-3d"] {
        let outcome = run(&dirty(name), 10.0);
        let edges = edges(&outcome.triangles);
        assert!(edges.contains(&[2, 3]) && !edges.contains(&[0, 1]), "{name}");
        assert_eq!(outcome.remaining.total(), 0, "{name}");
    }
    // Two caps whose four corners are on one line stay, because no flip would give them area.
    let line = run(&dirty("flat-caps-back-to-back"), 10.0);
    assert_eq!((line.flips, line.remaining.total()), (0, 0));
    // A cap that stands upright has a normal of its own.
    let upright =
        space(&[[0., 0., 0.], [4., 0., 0.], [2., 0., 0.001], [2., -3., 0.]], &[[0, 1, 2], [1, 0, 3]]);
    let outcome = run(&upright, 10.0);
    assert_eq!((outcome.flips, outcome.remaining[Reason::Angle]), (0, 1));
}

/// Vertices 3 and 4 have the same position, so two needles have no area. The edge above the needles flips; the needles
/// stay.
#[test]
fn needles() {
    for mesh in [dirty("coincident-vertices"), dirty("coincident-vertices-3d")] {
        let outcome = run(&mesh, 10.0);
        assert!(
            edges(&outcome.triangles).is_superset(&[[2, 3], [3, 4], [0, 3], [0, 4], [1, 3], [1, 4]].into())
        );
        assert_eq!((outcome.flips, outcome.remaining.total()), (1, 0));
    }
}

/// A mesh with one of its vertices moved onto a neighbour.
#[test]
fn zero_length_edges() {
    let mesh = integers();
    let [from, to] = [mesh.triangles()[150], mesh.triangles()[151]];
    let position = |v: u32| mesh.positions().to_f32()[2 * v as usize..][..2].to_vec();
    let mut positions = mesh.positions().to_f32();
    positions[2 * from as usize..][..2].copy_from_slice(&position(to));
    let drawn = Mesh::new(Dimension::Two, positions, mesh.triangles().to_vec()).unwrap();
    for mesh in [flat(&drawn), drawn] {
        let outcome = run(&mesh, 10.0);
        assert!(edges(&outcome.triangles).contains(&[from.min(to), from.max(to)]));
        assert!(outcome.flips > 0);
    }
}

#[test]
fn clockwise_2d() {
    let mesh = integers();
    let [there, back] = [run(&mesh, 10.0), run(&reversed(&mesh), 10.0)];
    assert_eq!(edges(&there.triangles), edges(&back.triangles));
    assert!(areas(&mesh, &back.triangles).iter().all(|&area| area < 0));
    assert!(back.flips > 0 && back.remaining.total() == 0);
}

#[test]
fn mixed_winding_2d() {
    let mesh = integers();
    let mixed = joined(&mesh, &moved(&reversed(&mesh), |[x, y, z]| [x + 2000.0, y, z]));
    let outcome = run(&mixed, 10.0);
    let (first, second) = outcome.triangles.split_at(mesh.triangles().len());
    assert!(areas(&mixed, first).iter().all(|&area| area > 0));
    assert!(areas(&mixed, second).iter().all(|&area| area < 0));
    let back: Vec<u32> = second.iter().map(|v| v - mesh.vertex_count() as u32).collect();
    assert_eq!(edges(first), edges(&back));
    assert_eq!(outcome.remaining.total(), 0);
}

/// A run never increases the number of inverted or flat triangles, or the area of the inverted ones.
#[test]
fn folded_2d() {
    let mut improved = 0;
    for seed in 0..12 {
        let mut random = Rand64::new(seed);
        let mut noise = || (0.7 * signed(&mut random) * 64.0).round();
        let mesh = moved(&by_name("grid 9").unwrap(), |[x, y, z]| {
            [(8.0 * 64.0 * x).round() + noise(), (8.0 * 64.0 * y).round() + noise(), z]
        });
        let outcome = run(&mesh, 10.0);
        let [before, after] = [mesh.triangles(), &outcome.triangles].map(|triangles| {
            let mut areas = areas(&mesh, triangles);
            areas.retain(|&area| area <= 0);
            (areas.len(), -areas.iter().sum::<i64>())
        });
        assert!(before.0 > 0 && after.0 <= before.0 && after.1 <= before.1, "{seed}: {before:?}, {after:?}");
        improved += usize::from(after.0 < before.0);
    }
    assert!(improved > 6);
}

/// From left to right: a quad that a flip unfolds, a tie, and a quad that has to stay.
/// ```text
///        2              2     3          2
///       / \             |\   /|         / '.3
///      / 3 \            | \ / |        / .'  '.
///     /.' '.\           |  X  |       /.'      '.
///    0-------1          0-----1      0-----------1
/// ```
#[test]
fn folded_quads_2d() {
    let inside = run(&dirty("folded-quad"), 10.0);
    assert_eq!((inside.flips, inside.remaining.total()), (1, 0));
    let cocircular = run(&dirty("bow-tie-quad"), 10.0);
    assert_eq!((cocircular.flips, cocircular.remaining.total()), (0, 0));
    // The third quad; then a quad with 3 on the edge 1-2, where a new triangle would be flat; then the same with
    // coordinates of very different sizes.
    for (third, x) in [([3., 1.], 0.), ([2.5, 1.], 0.), ([2.5, 1.], 2f32.powi(-40))] {
        let quad = plane(&[[x, 0.], [4., 0.], [1., 2.], third], &[[0, 1, 2], [1, 0, 3]]);
        for quad in [reversed(&quad), quad] {
            let outcome = run(&quad, 10.0);
            assert_eq!((outcome.flips, outcome.remaining[Reason::Fold]), (0, 1));
        }
    }
}

/// The third of these quads in space. Its triangles lie back to back, so every flip turns a triangle over.
#[test]
fn folded_3d() {
    let quad = space(&[[0., 0., 0.], [4., 0., 0.], [1., 2., 0.], [3., 1., 0.]], &[[0, 1, 2], [1, 0, 3]]);
    for (beta, reason) in [(10.0, Reason::Angle), (180.0, Reason::Fold)] {
        let outcome = run(&quad, beta);
        assert_eq!((outcome.flips, outcome.remaining[reason], outcome.remaining.total()), (0, 1, 1));
    }
}

/// The edges 0-2, 1-2, 1-3, 2-2 and 3-3 have three or four half-edges. Only 0-1 has two, and flips.
#[test]
fn triangles_with_a_vertex_twice() {
    for mesh in [dirty("repeated-index"), dirty("repeated-index-3d")] {
        let outcome = run(&mesh, 10.0);
        assert_eq!((kinds(&outcome), outcome.flips), ([8, 2, 5, 0], 1));
        assert!(edges(&outcome.triangles).contains(&[2, 3]));
    }
}

#[test]
fn all_points_equal() {
    let mesh = moved(&by_name("random 12").unwrap(), |_| [3.0, -7.0, 0.0]);
    for mesh in [flat(&mesh), mesh] {
        let outcome = run(&mesh, 10.0);
        assert_eq!((&outcome.triangles[..], outcome.remaining.total()), (mesh.triangles(), 0));
    }
}

#[test]
fn empty_meshes() {
    for mesh in [plane(&[], &[]), space(&[], &[]), plane(&[[1., 2.]; 5], &[]), space(&[[1., 2., 3.]; 5], &[])]
    {
        let outcome = run(&mesh, 10.0);
        assert_eq!((kinds(&outcome), outcome.iterations), ([0; 4], 0));
        assert!(outcome.triangles.is_empty());
    }
}

#[test]
fn one_triangle() {
    for mesh in [dirty("single"), dirty("single-3d"), reversed(&dirty("single"))] {
        let outcome = run(&mesh, 10.0);
        assert_eq!((kinds(&outcome), outcome.iterations), ([3, 3, 0, 0], 0));
        assert_eq!(outcome.triangles, mesh.triangles());
    }
}

/// An offset that the coordinates can hold exactly changes no bit of the result.
#[test]
fn huge_offsets() {
    let mesh = integers();
    let near = run(&mesh, 10.0);
    assert!(near.flips > 0);
    let far = 2f32.powi(23);
    assert_eq!(run(&moved(&mesh, |[x, y, z]| [x + far, y - far, z]), 10.0).triangles, near.triangles);
    let farther = 2f64.powi(42);
    let doubles = moved_wide(&mesh, |[x, y]| vec![x - farther, y + farther]);
    assert_eq!(run(&doubles, 10.0).triangles, near.triangles);
    let near = run(&flat(&mesh), 10.0);
    let doubles = moved_wide(&mesh, |[x, y]| vec![x - farther, y + farther, farther]);
    assert_eq!(run(&doubles, 10.0).triangles, near.triangles);
}

/// A kite whose two triangles have vertices of their own at the same positions: no edge joins them.
#[test]
fn duplicate_vertices() {
    let whole = plane(&[[-2., 0.], [2., 0.], [0., 1.], [0., -1.]], &[[0, 1, 2], [1, 0, 3]]);
    let halves =
        plane(&[[-2., 0.], [2., 0.], [0., 1.], [0., -1.], [-2., 0.], [2., 0.]], &[[0, 1, 2], [5, 4, 3]]);
    for [whole, halves] in [[flat(&whole), flat(&halves)], [whole, halves]] {
        assert_eq!(run(&whole, 10.0).flips, 1);
        let outcome = run(&halves, 10.0);
        assert_eq!((kinds(&outcome), outcome.flips), ([6, 6, 0, 0], 0));
        assert_eq!(outcome.remaining.total(), 0);
    }
}
