//! Regions: the parts into which edges cut a mesh.

use crate::mesh::half_edge::next;
use crate::mesh::named_edges::{half_edges, ordered};
use crate::predicates::area_sign;
use crate::system::threads::Threads;
use crate::{Adjacency, Dimension, Error, Mesh, NONE};
use glam::DVec2;
use std::collections::VecDeque;

/// The regions of a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Regions {
    /// How many there are.
    pub count: u32,
    /// The region of each triangle. Regions are numbered in the order of their first triangles, from 0.
    pub of_triangles: Vec<u32>,
    /// Whether each triangle is inside.
    pub inside: Vec<bool>,
    /// Whether the edges are closed polygons: an even number of them ends at every vertex. If not, `inside` is a guess.
    pub is_closed: bool,
}

/// Cuts a mesh into regions along `edges`, each given by its two vertices, such as
/// [`Constrained::constraint_edges`](crate::Constrained::constraint_edges). Two triangles are in one region if a path
/// from one to the other crosses none of these edges. A path crosses only edges that have two triangles.
///
/// A triangle is inside by the even-odd rule: a path to it from outside crosses the edges an odd number of times. An edge
/// that is given twice counts twice, so that two polygons with a common side are both inside. In the plane, outside is
/// what surrounds a component, not a hole in it. In space, it is all that lies beyond the boundary; in a component
/// without boundary, the region of the first triangle is not inside. If the edges are not closed polygons, the path with
/// the fewest crossings counts.
///
/// # Errors
/// [`Error::Option`] for a pair that is no edge of the mesh.
pub fn regions(mesh: &Mesh, edges: &[[u32; 2]]) -> Result<Regions, Error> {
    let cuts = half_edges(mesh, edges).map_err(|error| match error {
        Error::Option { message, .. } => Error::Option {
            option: "edges",
            message: format!("{message}; bring it in first, as a constraint"),
        },
        other => other,
    })?;
    let triangles = mesh.triangle_count();
    let twins = Adjacency::of_triangles(mesh.vertex_count(), mesh.triangles(), &Threads::default()).twins;
    let mut pairs: Vec<[u32; 2]> = edges.iter().map(|&ends| ordered(ends)).collect();
    pairs.sort_unstable();
    // How often each half-edge is given, modulo 2; NOT_CUT if never.
    let mut crossings = vec![NOT_CUT; 3 * triangles];
    for h in cuts {
        let ends = ordered([h, next(h)].map(|x| mesh.triangles()[x as usize]));
        let times = pairs.partition_point(|pair| *pair <= ends) - pairs.partition_point(|pair| *pair < ends);
        crossings[h as usize] = (times % 2) as u8;
    }
    let sides = |t: usize| 3 * t..3 * t + 3;
    let (count, of_triangles) = parts(&twins, |h| crossings[h] == NOT_CUT);

    // The fewest crossings from outside. The front of the queue has one crossing less than the back, at most.
    let mut fewest = vec![u32::MAX; triangles];
    let mut queue = VecDeque::new();
    let times = |h: usize| u32::from(crossings[h] == 1);
    let mut ends: Vec<u32> = edges.concat();
    ends.sort_unstable();
    let is_closed = ends.chunk_by(|u, v| u == v).all(|ends| ends.len() % 2 == 0);
    let mut borders = match mesh.dimension() {
        // Where the edges are closed, all paths agree, so one edge at the outside suffices.
        Dimension::Two if is_closed => outer_edges(mesh, &twins),
        Dimension::Two => outer_edges(mesh, &twins).into_iter().flat_map(|h| border(&twins, h)).collect(),
        Dimension::Three => (0..3 * triangles).filter(|&h| twins[h] == NONE).collect(),
    };
    borders.sort_by_key(|&h| times(h));
    queue.extend(borders.into_iter().map(|h| (h / 3, times(h))));
    for first in 0..triangles {
        // Triangles at the border come first; then one triangle of each component that they do not reach.
        if queue.is_empty() && fewest[first] == u32::MAX {
            queue.push_back((first, 0));
        }
        while let Some((t, crossed)) = queue.pop_front() {
            if fewest[t] <= crossed {
                continue;
            }
            fewest[t] = crossed;
            for h in sides(t).filter(|&h| twins[h] != NONE) {
                let neighbour = twins[h] as usize / 3;
                match times(h) {
                    0 => queue.push_front((neighbour, crossed)),
                    _ => queue.push_back((neighbour, crossed + 1)),
                }
            }
        }
    }
    let inside = fewest.into_iter().map(|crossed| crossed % 2 == 1).collect();
    Ok(Regions { count, of_triangles, inside, is_closed })
}

/// The parts of a mesh that are joined by the half-edges that `joins` accepts: how many there are, and the part of each
/// triangle. They are numbered in the order of their first triangles.
fn parts(twins: &[u32], joins: impl Fn(usize) -> bool) -> (u32, Vec<u32>) {
    let (mut count, mut of_triangles) = (0, vec![NONE; twins.len() / 3]);
    let mut stack = Vec::new();
    for first in 0..of_triangles.len() {
        if of_triangles[first] != NONE {
            continue;
        }
        of_triangles[first] = count;
        stack.push(first);
        while let Some(t) = stack.pop() {
            for h in (3 * t..3 * t + 3).filter(|&h| joins(h) && twins[h] != NONE) {
                let neighbour = twins[h] as usize / 3;
                if of_triangles[neighbour] == NONE {
                    of_triangles[neighbour] = count;
                    stack.push(neighbour);
                }
            }
        }
        count += 1;
    }
    (count, of_triangles)
}

/// A half-edge at the outside of each component in the plane: of the boundary edges at the highest vertex of the
/// boundary, or the first from the left of the highest ones, that which is first from the left.
fn outer_edges(mesh: &Mesh, twins: &[u32]) -> Vec<usize> {
    let (count, components) = parts(twins, |_| true);
    let mut outer: Vec<Option<(DVec2, DVec2, usize)>> = vec![None; count as usize];
    for h in (0..twins.len()).filter(|&h| twins[h] == NONE) {
        let [u, v] = [h, next(h as u32) as usize].map(|x| mesh.point2(mesh.triangles()[x]));
        let best = &mut outer[components[h / 3] as usize];
        for (top, end) in [(u, v), (v, u)] {
            let is_better = best.is_none_or(|(other, other_end, _)| {
                let is_higher = top.y > other.y || top.y == other.y && top.x < other.x;
                is_higher || top == other && area_sign(top, end, other_end).is_gt()
            });
            if is_better {
                *best = Some((top, end, h));
            }
        }
    }
    outer.into_iter().flatten().map(|(.., h)| h).collect()
}

/// The boundary half-edges that a walk along the boundary meets from one of them on.
fn border(twins: &[u32], first: usize) -> Vec<usize> {
    let mut border = Vec::new();
    let mut h = first;
    loop {
        border.push(h);
        h = next(h as u32) as usize;
        while twins[h] != NONE {
            h = next(twins[h]) as usize;
        }
        if h == first {
            return border;
        }
    }
}

/// The mark of a half-edge that cuts nothing.
const NOT_CUT: u8 = 2;

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

    use super::*;
    use crate::{Constrained, constrained, families};
    use proptest::prelude::*;

    /// The sides of polygons, each a list of vertices.
    fn sides(polygons: &[&[u32]]) -> Vec<[u32; 2]> {
        let sides = |ring: &&[u32]| {
            let ring = ring.to_vec();
            (0..ring.len()).map(move |i| [ring[i], ring[(i + 1) % ring.len()]])
        };
        polygons.iter().flat_map(sides).collect()
    }

    /// How many regions there are, and the area inside.
    fn found(mesh: &Mesh, edges: &[[u32; 2]]) -> (u32, f64) {
        let Constrained { mesh, locked_edges, .. } = constrained(mesh, edges, &[], false, 0.0, None).unwrap();
        let Regions { count, of_triangles, inside, is_closed } = regions(&mesh, &locked_edges).unwrap();
        assert_eq!((of_triangles[0], is_closed), (0, edges.len() != 1));
        assert!((0..count).all(|region| of_triangles.contains(&region)));
        let (corners, _) = mesh.triangles().as_chunks::<3>();
        let area = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|v| mesh.point2(v));
            (b - a).perp_dot(c - a) / 2.0
        };
        (count, corners.iter().zip(inside).filter(|&(_, inside)| inside).map(|(t, _)| area(t)).sum())
    }

    /// A lattice of 6 by 6 points at distance 1.
    fn lattice() -> Mesh {
        let positions: Vec<f64> = (0..36).flat_map(|v| [f64::from(v % 6), f64::from(v / 6)]).collect();
        let corners = (0..25).map(|i| 6 * (i / 5) + i % 5);
        let triangles = corners.flat_map(|v| [v, v + 1, v + 7, v, v + 7, v + 6]).collect();
        Mesh::new(Dimension::Two, positions, triangles).unwrap()
    }

    #[test]
    fn polygons_with_holes_and_common_sides() {
        let mesh = lattice();
        let at = |x: u32, y: u32| 6 * y + x;
        let square = |from: u32, to: u32| [at(from, from), at(to, from), at(to, to), at(from, to)];
        let [whole, outer, hole] = [square(0, 5), square(1, 4), square(2, 3)];
        let area = |polygons: &[&[u32]]| {
            let (count, area) = found(&mesh, &sides(polygons));
            (count, area.round() as u32)
        };
        assert_eq!(area(&[]), (1, 0));
        assert_eq!(area(&[&whole]), (1, 25));
        assert_eq!(area(&[&outer]), (2, 9));
        assert_eq!(area(&[&outer, &hole]), (3, 8));
        assert_eq!(area(&[&whole, &outer, &hole]), (3, 17));
        // Two halves with a common side, and a polygon that fills the hole of another.
        let halves: [&[u32]; 2] =
            [&[at(0, 0), at(3, 0), at(3, 5), at(0, 5)], &[at(3, 0), at(5, 0), at(5, 5), at(3, 5)]];
        assert_eq!(area(&halves), (2, 25));
        assert_eq!(area(&[&outer, &hole, &hole]), (3, 9));
        // A line is no polygon: it cuts, and no side of it is inside. A shorter one does not even cut.
        assert_eq!(area(&[&[at(0, 2), at(5, 2)]]), (2, 0));
        let line = |from, to| found(&mesh, &[[from, to]]);
        assert_eq!((line(at(0, 2), at(5, 2)), line(at(1, 2), at(4, 2))), ((2, 0.0), (1, 0.0)));
    }

    /// A ring around a hole of the mesh, around a turned triangle, and around nothing.
    #[test]
    fn a_hole_of_the_mesh_is_not_outside() {
        let square = |from: i32, to: i32| [[from, from], [to, from], [to, to], [from, to]];
        let points = [square(0, 6), square(1, 5), square(2, 4)].concat().concat();
        let positions: Vec<f64> = points.into_iter().map(f64::from).collect();
        let band = |outer: u32, inner: u32| {
            (0..4).flat_map(move |k| {
                let n = (k + 1) % 4;
                [outer + k, outer + n, inner + n, outer + k, inner + n, inner + k]
            })
        };
        let hollow: Vec<u32> = band(0, 4).chain(band(4, 8)).collect();
        let ring = sides(&[&[4, 5, 6, 7]]);
        for (more, expected) in [(vec![], 8), (vec![8, 9, 10, 8, 10, 11], 10), (vec![9, 8, 10, 8, 10, 11], 9)]
        {
            let triangles = [hollow.clone(), more].concat();
            let clockwise = triangles.iter().rev().copied().collect();
            for triangles in [triangles, clockwise] {
                let mesh = Mesh::new(Dimension::Two, positions.clone(), triangles).unwrap();
                let found = regions(&mesh, &ring).unwrap();
                let inside = found.inside.iter().filter(|&&inside| inside).count();
                assert_eq!((inside, found.is_closed), (expected, true));
                assert!(regions(&mesh, &[]).unwrap().inside.iter().all(|&inside| !inside));
                let whole = regions(&mesh, &sides(&[&[0, 1, 2, 3]])).unwrap();
                assert_eq!(whole.inside.iter().filter(|&&inside| inside).count(), 8 + expected);
            }
        }
    }

    /// A hole that touches the outer boundary in a vertex, on the lattice of 6 by 6 points.
    #[test]
    fn a_hole_may_touch_the_boundary() {
        let mut mesh = lattice();
        let mut triangles = mesh.triangles().to_vec();
        let hole = triangles.as_chunks().0.iter().position(|t| *t == [1, 8, 7]).unwrap();
        triangles.drain(3 * hole..3 * hole + 3);
        mesh = mesh.with_triangles(triangles).unwrap();
        for (polygon, area) in [([0, 5, 35, 30], 24.5), ([0, 3, 15, 12], 5.5)] {
            assert_eq!(found(&mesh, &sides(&[&polygon])).1, area);
        }
    }

    #[test]
    fn a_closed_surface_is_cut_too() {
        let mesh = families::by_name("uvsphere 6").unwrap();
        let [a, b, c] = [0, 1, 2].map(|k| mesh.triangles()[k]);
        assert_eq!(regions(&mesh, &[]).unwrap().count, 1);
        let cut = regions(&mesh, &[[a, b], [b, c], [c, a]]).unwrap();
        assert_eq!(
            (cut.count, cut.inside.iter().filter(|&&inside| inside).count()),
            (2, mesh.triangle_count() - 1)
        );
        assert!(matches!(regions(&mesh, &[[a, a]]), Err(Error::Option { .. })));
    }

    proptest! {
        /// A triangle is inside if a ray from its middle crosses the polygons an odd number of times.
        #[test]
        fn the_even_odd_rule(seed in 0u64..1000, corners in proptest::collection::vec(0u32..144, 3..7)) {
            let mesh = families::by_name(&format!("random 12 seed={seed}")).unwrap();
            let ring: Vec<u32> = corners;
            let edges: Vec<[u32; 2]> = sides(&[&ring]).into_iter().filter(|[u, v]| u != v).collect();
            let Ok(Constrained { mesh, locked_edges, .. }) = constrained(&mesh, &edges, &[], false, 0.0, None) else {
                return Ok(());
            };
            let found = regions(&mesh, &locked_edges).unwrap();
            let (triangles, _) = mesh.triangles().as_chunks::<3>();
            for (t, corners) in triangles.iter().enumerate() {
                let middle = corners.iter().map(|&v| mesh.point2(v)).sum::<glam::DVec2>() / 3.0;
                let crosses = |&&[u, v]: &&[u32; 2]| {
                    let (p, q) = (mesh.point2(u), mesh.point2(v));
                    (p.y > middle.y) != (q.y > middle.y)
                        && (q.x - p.x) * (middle.y - p.y) / (q.y - p.y) + p.x > middle.x
                };
                let odd = edges.iter().filter(crosses).count() % 2 == 1;
                prop_assert_eq!(found.inside[t], odd);
            }
        }
    }
}
