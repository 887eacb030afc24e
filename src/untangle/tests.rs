//! On any triangles, and on grids whose vertices move, a repair keeps what it has to.

use super::{Constant, Untangled, untangled};
use crate::mesh::adjacency::Adjacency;
use crate::mesh::half_edge::{self, next, unflagged};
use crate::mesh::named_edges::{half_edges, ordered};
use crate::mesh::winding::Outline;
use crate::{Dimension, Mesh, NONE};
use proptest::collection::vec;
use proptest::prelude::*;
use std::collections::HashSet;

fn mesh(points: &[(i32, i32)], triangles: Vec<u32>) -> Mesh {
    let positions: Vec<f64> = points.iter().flat_map(|&(x, y)| [x, y]).map(f64::from).collect();
    Mesh::new(Dimension::Two, positions, triangles).unwrap()
}

/// The half-edges without a twin, sorted, each with the component of its triangle.
fn boundary(mesh: &Mesh, twins: &[u32]) -> Vec<([u32; 2], u32)> {
    let outline = Outline::new(mesh.triangles(), twins);
    let open = (0..twins.len() as u32).filter(|&h| twins[h as usize] == NONE);
    let mut boundary: Vec<_> = open
        .map(|h| ([h, next(h)].map(|x| mesh.triangles()[x as usize]), outline.components()[h as usize / 3]))
        .collect();
    boundary.sort_unstable();
    boundary
}

/// The vertices of each component, sorted.
fn vertices(mesh: &Mesh, twins: &[u32]) -> Vec<(u32, u32)> {
    let outline = Outline::new(mesh.triangles(), twins);
    let mut vertices: Vec<_> =
        mesh.triangles().iter().enumerate().map(|(h, &v)| (outline.components()[h / 3], v)).collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices
}

/// Triangles without the sign of their component.
fn turned(mesh: &Mesh, twins: &[u32]) -> usize {
    let winding = Outline::new(mesh.triangles(), twins).winding(mesh);
    let points = |t: &[u32]| mesh.positions().points2([t[0], t[1], t[2]]);
    let is_right = |(t, corners): &(usize, &[u32])| {
        let [a, b, c] = points(corners);
        winding.relative(*t as u32, crate::predicates::area_sign(a, b, c)).is_gt()
    };
    mesh.triangles().chunks(3).enumerate().filter(|triangle| !is_right(triangle)).count()
}

/// Repairs a mesh, and checks the result. Returns the number of triangles that were turned over, and of those that are.
fn check(mesh: &Mesh, locked: &[[u32; 2]]) -> (usize, usize) {
    let adjacency = Adjacency::new(mesh);
    let mut twins = adjacency.twins.clone();
    half_edge::lock(&mut twins, &half_edges(mesh, locked).unwrap());
    let constant = Constant::new(mesh, &twins);
    let before = turned(mesh, &twins);
    let Some(Untangled { slots, lost }) = untangled(mesh, &twins, &constant, Vec::new()) else {
        assert_eq!(before, 0);
        return (0, 0);
    };
    let mut flagged = twins.clone();
    let after = mesh.clone().with_slots(&slots, &mut flagged);
    let again = Adjacency::new(&after);
    let plain: Vec<u32> = flagged.iter().map(|&entry| unflagged(entry)).collect();
    assert_eq!(again.twins, plain);
    let counts = |a: &Adjacency| (a.edges, a.boundary, a.non_manifold, a.inconsistent);
    assert_eq!(counts(&again), counts(&adjacency));
    assert_eq!(boundary(&after, &plain), boundary(mesh, &adjacency.twins));
    assert_eq!(vertices(&after, &plain), vertices(mesh, &adjacency.twins));
    // A locked edge is locked, on the boundary, or lost.
    let ends = |mesh: &Mesh, h: u32| ordered([h, next(h)].map(|x| mesh.triangles()[x as usize]));
    let is_locked: HashSet<_> = half_edge::locked(&flagged).into_iter().map(|h| ends(&after, h)).collect();
    let was_locked: HashSet<_> = half_edge::locked(&twins).into_iter().map(|h| ends(mesh, h)).collect();
    for edge in &was_locked {
        assert!(is_locked.contains(edge) != lost.contains(edge), "{edge:?} {lost:?}");
    }
    assert!(is_locked.is_subset(&was_locked));
    assert!(lost.is_sorted());
    let turned = turned(&after, &plain);
    let is_stable = untangled(&after, &flagged, &constant, lost.clone());
    if turned == 0 {
        let mut again = flagged.clone();
        assert!(is_stable.is_none_or(|same| {
            after.clone().with_slots(&same.slots, &mut again);
            again == flagged && same.lost == lost
        }));
    }
    (before, turned)
}

/// A grid of squares, each divided, whose boundary stays.
fn grid(size: u32, holes: &[u32], is_clockwise: bool) -> (Vec<(i32, i32)>, Vec<u32>) {
    let points = (0..size * size).map(|v| (10 * (v % size) as i32, 10 * (v / size) as i32)).collect();
    let mut triangles = Vec::new();
    for v in (0..size * (size - 1)).filter(|v| v % size < size - 1 && !holes.contains(v)) {
        let [a, b, c, d] = [v, v + 1, v + size, v + size + 1];
        triangles.extend(if v % 3 == 0 { [[a, b, d], [a, d, c]] } else { [[a, b, c], [b, d, c]] });
    }
    if is_clockwise {
        triangles.iter_mut().for_each(|corners| corners.reverse());
    }
    (points, triangles.into_flattened())
}

proptest! {
    /// Few vertices make nearly all edges non-manifold, many make nearly all boundary. Triangles may repeat a corner.
    #[test]
    fn any_triangles_keep_their_boundary(
        points in vec((-4i32..5, -4i32..5), 12),
        corners in (3u32..13).prop_flat_map(|vertices| vec(0..vertices, 0..60)),
    ) {
        check(&mesh(&points, corners[..corners.len() / 3 * 3].to_vec()), &[]);
    }

    /// Vertices inside a grid go anywhere in it, apart from each other and from its lines: then all triangles become
    /// positive. Others go beyond it, or to one point.
    #[test]
    fn grids_are_untangled(
        size in 3u32..9,
        is_clockwise: bool,
        moves in vec((0usize..81, 0i32..80, 0i32..80), 0..40),
        is_wild: bool,
        locks in vec(0usize..300, 0..4),
    ) {
        let (mut points, triangles) = grid(size, &[], is_clockwise);
        let on_boundary = |v: usize| {
            let (x, y, last) = (v as u32 % size, v as u32 / size, size - 1);
            x == 0 || y == 0 || x == last || y == last
        };
        let mut taken: HashSet<(i32, i32)> = points.iter().copied().collect();
        for (v, x, y) in moves {
            let v = v % points.len();
            let most = 10 * (size as i32 - 1);
            let to = (x % most, y % most);
            let is_inside = to.0 > 0 && to.1 > 0;
            if is_wild {
                points[v] = (x - 5, y - 5);
            } else if !on_boundary(v) && is_inside && taken.insert(to) {
                points[v] = to;
            }
        }
        let mesh = mesh(&points, triangles);
        let edge = |h: usize| [h as u32, next(h as u32)].map(|x| mesh.triangles()[x as usize]);
        let locked: Vec<_> = locks.into_iter().map(|h| edge(h % mesh.triangles().len())).collect();
        let (_, after) = check(&mesh, &locked);
        prop_assert!(is_wild || after == 0, "{after} are left");
    }

    /// Holes, pinched corners and several components.
    #[test]
    fn holes_are_kept(
        holes in vec(0u32..49, 0..12),
        is_clockwise: bool,
        moves in vec((0usize..49, -9i32..10, -9i32..10), 0..30),
    ) {
        let (mut points, triangles) = grid(7, &holes, is_clockwise);
        for (v, x, y) in moves {
            points[v].0 += x;
            points[v].1 += y;
        }
        check(&mesh(&points, triangles), &[]);
    }
}
