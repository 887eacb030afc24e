//! Results with planted faults: the audit must name each fault.

use crate::matrix::named;
use crate::meshes::{joined, plane, reversed};
use crate::simulation::simulate;
use edgeflip::quality::{Audit, MAX_LISTED, RemainingEdge, Violation, audit};
use edgeflip::{Mesh, Options, Reason, families::by_name};

/// The audit of the mesh's own triangles after `fault` has changed them.
fn audit_of(mesh: &Mesh, fault: impl FnOnce(&mut Vec<u32>)) -> Audit {
    let mut triangles = mesh.triangles().to_vec();
    fault(&mut triangles);
    audit(mesh, &triangles, &Options::default())
}

/// Flips the edge between two vertices, without any check.
fn flip(triangles: &mut [u32], u: u32, v: u32) {
    let next = |h: usize| if h % 3 == 2 { h - 2 } else { h + 1 };
    let find = |u, v| (0..triangles.len()).find(|&h| (triangles[h], triangles[next(h)]) == (u, v)).unwrap();
    let (h, g) = (find(u, v), find(v, u));
    let (c, d) = (triangles[next(next(h))], triangles[next(next(g))]);
    triangles[next(h)] = d;
    triangles[next(g)] = c;
}

/// ```text
///        2
///      / | \         0-1 is not Delaunay
///     0 -+- 1        4 lies far to the right of 1
///      \ | /
///        3
/// ```
fn kite() -> Mesh {
    plane(&[[-2., 0.], [2., 0.], [0., 1.], [0., -1.], [5., 0.]], &[[0, 1, 2], [1, 0, 3], [1, 4, 2]])
}

#[test]
fn an_untouched_mesh_is_clean_but_not_delaunay() {
    let audit = audit_of(&kite(), |_| {});
    assert!(audit.is_clean());
    assert_eq!(audit.remaining_edges, [RemainingEdge { u: 0, v: 1, reason: Reason::Stopped }]);
    assert_eq!((audit.remaining[Reason::Stopped], audit.remaining.total()), (1, 1));
    let flipped = audit_of(&kite(), |t| flip(t, 0, 1));
    assert!(flipped.is_clean());
    assert_eq!(flipped.remaining.total(), 0);
}

#[test]
fn a_turned_triangle() {
    let violations = audit_of(&by_name("grid 5").unwrap(), |t| t.swap(30, 31)).violations;
    assert!(violations.iter().any(|v| matches!(v, Violation::NewInconsistent { .. })), "{violations:?}");
    assert!(violations.contains(&Violation::Area));
    // A single reversed triangle is its own component: it is not inverted, but its boundary and its area change.
    let alone = plane(&[[0., 0.], [1., 0.], [0., 1.]], &[[0, 1, 2]]);
    let violations = audit_of(&alone, |t| t.swap(0, 1)).violations;
    assert!(violations.contains(&Violation::Boundary { u: 0, v: 1 }));
    assert!(violations.contains(&Violation::Area));
}

#[test]
fn a_flip_in_a_quad_that_is_not_convex() {
    let mesh = plane(&[[0., 0.], [4., 0.], [0.5, 0.5], [-3., 2.]], &[[0, 1, 2], [2, 3, 0]]);
    let audit = audit_of(&mesh, |t| flip(t, 2, 0));
    assert_eq!(audit.violations, [Violation::Inverted { before: 0, after: 1 }]);
}

#[test]
fn a_lost_boundary_edge() {
    let violations = audit_of(&kite(), |t| t[7] = 3).violations;
    assert!(violations.contains(&Violation::Boundary { u: 1, v: 4 }), "{violations:?}");
    assert!(violations.contains(&Violation::Vertex { vertex: 4 }));
}

#[test]
fn a_duplicate_edge() {
    let violations = audit_of(&named("kite-and-flap").mesh, |t| flip(t, 0, 1)).violations;
    assert!(violations.contains(&Violation::NewNonManifold { u: 2, v: 3, half_edges: 3 }), "{violations:?}");
}

#[test]
fn a_changed_frozen_edge() {
    let violations = audit_of(&named("fan-of-three").mesh, |t| flip(t, 0, 1)).violations;
    assert!(
        violations.contains(&Violation::Frozen { u: 0, v: 1 })
            || violations.contains(&Violation::Boundary { u: 0, v: 1 })
    );
}

#[test]
fn a_merged_component() {
    let mesh = joined(&kite(), &reversed(&kite()));
    let violations = audit_of(&mesh, |t| t[9..].iter_mut().for_each(|v| *v -= 5)).violations;
    assert!(violations.iter().any(|v| matches!(v, Violation::Components { .. })), "{violations:?}");
    assert!(violations.iter().any(|v| matches!(v, Violation::Euler { .. })));
}

#[test]
fn a_lost_ridge() {
    let roof = by_name("roof 4").unwrap();
    let run = simulate(&roof, 10.0, None);
    assert!(audit(&roof, &run.triangles, &Options::default()).is_clean());
    // Nine columns: vertices 4, 13, 22, … are the ridge.
    let flipped = |t: &mut Vec<u32>| flip(t, 13, 22);
    assert!(audit_of(&roof, flipped).violations.contains(&Violation::Crease { u: 13, v: 22 }));
}

#[test]
fn a_lost_lock() {
    let locked = [[1, 0], [0, 1], [3, 0], [3, 4], [0, 5], [u32::MAX, u32::MAX]];
    let options = Options { locked_edges: locked.to_vec(), ..Options::default() };
    let kept = audit(&kite(), kite().triangles(), &options);
    assert!(kept.is_clean());
    assert_eq!((kept.remaining[Reason::Locked], kept.remaining.total()), (1, 1));
    let mut triangles = kite().triangles().to_vec();
    flip(&mut triangles, 0, 1);
    // Locked pairs that the input has no edge for do not count as missing.
    assert_eq!(audit(&kite(), &triangles, &options).violations, [Violation::Locked { u: 0, v: 1 }]);
}

#[test]
fn wrong_arrays() {
    let audit_of = |fault: fn(&mut Vec<u32>)| audit_of(&kite(), fault);
    assert_eq!(audit_of(|t| t.truncate(6)).violations, [Violation::Length { before: 9, after: 6 }]);
    assert_eq!(audit_of(|t| t.truncate(7)).violations, [Violation::Length { before: 9, after: 7 }]);
    let wrong = audit_of(|t| t[4] = 5);
    assert_eq!(wrong.violations, [Violation::IndexOutOfRange { triangle: 1, index: 5 }]);
    assert_eq!(wrong.violations[0].to_string(), "triangle 1: vertex index 5 is out of range");
    let audit = audit(&by_name("grid 20").unwrap(), &[u32::MAX; 3 * 722], &Options::default());
    assert_eq!((audit.violations.len(), audit.unlisted), (MAX_LISTED, 3 * 722 - MAX_LISTED));
}

#[test]
fn frozen_edges_of_many_triangles_take_no_quadratic_time() {
    // A book: 100,000 triangles share the edge 0-1, and their opposite angles are at most 90°. The last triangle is
    // obtuse.
    let pages = 100_000u32;
    let mut points = vec![[0., 0.], [1., 0.]];
    points.extend((0..pages).map(|k| [0.5, 0.5 + k as f32]));
    let mut triangles: Vec<_> = (0..pages).map(|k| [0, 1, 2 + k]).collect();
    let book = plane(&points, &triangles);
    assert_eq!(audit(&book, book.triangles(), &Options::default()).remaining.total(), 0);
    points.push([0.5, 0.499]);
    triangles.push([1, 0, 2 + pages]);
    let book = plane(&points, &triangles);
    let audit = audit(&book, book.triangles(), &Options::default());
    assert_eq!(audit.remaining_for(Reason::NonManifold).collect::<Vec<_>>(), [[0, 1]]);
}
