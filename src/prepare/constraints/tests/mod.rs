#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

mod dirty;
mod long;
mod near;

use super::*;
use crate::families;
use crate::mesh::half_edge::next;
use oorandom::Rand64;
use proptest::prelude::*;
use robust::{Coord, incircle, orient2d};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroUsize;

type Pair = [u32; 2];

fn edges(mesh: &Mesh) -> BTreeSet<Pair> {
    let triangles = mesh.triangles();
    (0..triangles.len() as u32).map(|h| ordered([h, next(h)].map(|x| triangles[x as usize]))).collect()
}

fn point(mesh: &Mesh, v: u32) -> Coord<f64> {
    let [x, y] = mesh.point2(v).to_array();
    Coord { x, y }
}

/// The sign of the area of three vertices, by the crate `robust`.
fn turn(mesh: &Mesh, [a, b, c]: [u32; 3]) -> i32 {
    let [a, b, c] = [a, b, c].map(|v| point(mesh, v));
    let area = orient2d(a, b, c);
    i32::from(area > 0.0) - i32::from(area < 0.0)
}

/// Whether two segments cross in the inside of both, and not at a vertex.
fn cross(mesh: &Mesh, [a, b]: Pair, [c, d]: Pair) -> bool {
    let is_on_both = |&v: &u32| turn(mesh, [a, b, v]) == 0 && turn(mesh, [c, d, v]) == 0;
    turn(mesh, [a, b, c]) * turn(mesh, [a, b, d]) < 0
        && turn(mesh, [c, d, a]) * turn(mesh, [c, d, b]) < 0
        && !(0..mesh.vertex_count() as u32).any(|v| is_on_both(&v))
}

/// The edges with one triangle. No edge may have more than two.
fn border(mesh: &Mesh) -> BTreeSet<Pair> {
    let mut count = BTreeMap::new();
    for h in 0..mesh.triangles().len() as u32 {
        *count.entry(ordered([h, next(h)].map(|x| mesh.triangles()[x as usize]))).or_insert(0) += 1;
    }
    assert!(count.values().all(|&n| n <= 2));
    count.into_iter().filter(|&(_, n)| n == 1).map(|(edge, _)| edge).collect()
}

/// Checks that both meshes have the same vertices and cover the same region, and that all triangles are positive.
fn assert_valid(before: &Mesh, after: &Mesh) {
    assert_eq!(before.positions(), after.positions());
    assert_eq!(before.triangle_count(), after.triangle_count());
    let (corners, _) = after.triangles().as_chunks::<3>();
    assert!(corners.iter().all(|&corners| turn(after, corners) > 0), "a triangle is not positive");
    let used = |mesh: &Mesh| mesh.triangles().iter().copied().collect::<BTreeSet<_>>();
    assert_eq!(used(before), used(after));
    // Positive triangles within the same border cover the same region.
    assert_eq!(border(before), border(after));
}

/// Brings constraints in. The number of threads must not matter.
fn brought_in(mesh: &Mesh, constraints: &[Pair], locked: &[Pair], skips: bool) -> Result<Constrained, Error> {
    let [first, others @ ..] = [1, 2, 5]
        .map(|threads| constrained(mesh, constraints, locked, skips, 0.0, NonZeroUsize::new(threads)));
    for other in others {
        match (&first, other) {
            (Ok(first), Ok(other)) => assert_eq!(*first, other),
            (first, other) => {
                assert_eq!(first.as_ref().unwrap_err().to_string(), other.unwrap_err().to_string())
            }
        }
    }
    first
}

/// Brings constraints in, and leaves out those that cannot come in. Checks everything that the result claims.
fn check(mesh: &Mesh, constraints: &[Pair]) -> Constrained {
    let result = brought_in(mesh, constraints, &[], true).unwrap();
    assert_valid(mesh, &result.mesh);
    let all = edges(&result.mesh);
    assert!(result.locked_edges.iter().all(|&edge| all.contains(&ordered(edge))));
    let mut left_out = result.left_out.iter().peekable();
    let mut taken: Vec<usize> = Vec::new();
    for (i, &ends) in constraints.iter().enumerate() {
        if let Some(LeftOut { reason: message, .. }) = left_out.next_if(|left| left.index == i) {
            if let Some(rest) = message.split("crosses constraint ").nth(1) {
                let other: usize = rest.split(' ').next().unwrap().parse().unwrap();
                assert!(taken.contains(&other));
                assert!(cross(mesh, ends, constraints[other]), "{message}");
            }
            continue;
        }
        assert!(taken.iter().all(|&other| !cross(mesh, ends, constraints[other])));
        taken.push(i);
    }
    assert!(left_out.next().is_none());
    // The parts of each constraint lead from its first end to its second.
    let mut parts = result.locked_edges.iter();
    for &i in &taken {
        let [from, to] = constraints[i];
        let mut at = from;
        while at != to {
            let &[start, end] = parts.next().unwrap();
            assert_eq!(start, at);
            assert_eq!(turn(mesh, [from, to, end]), 0);
            at = end;
        }
    }
    assert!(parts.next().is_none());
    result
}

/// Flips a mesh to the end with these edges locked.
fn flipped(mesh: &Mesh, locked: &[Pair]) -> Mesh {
    let options =
        crate::Options { backend: crate::Backend::Cpu, locked_edges: locked.to_vec(), ..Default::default() };
    let outcome = crate::make_delaunay(mesh, &options, |_, _| std::ops::ControlFlow::Continue(())).unwrap();
    let locked_only = outcome.remaining[crate::Reason::Locked];
    assert_eq!(outcome.remaining.total(), locked_only);
    mesh.with_triangles(outcome.triangles).unwrap()
}

/// The edges of a constrained Delaunay triangulation by the crate `spade`.
fn by_spade(mesh: &Mesh, locked: &[Pair]) -> BTreeSet<Pair> {
    let points = (0..mesh.vertex_count() as u32).map(|v| {
        let Coord { x, y } = point(mesh, v);
        Point2::new(x, y)
    });
    let pairs = locked.iter().map(|pair| pair.map(|v| v as usize)).collect();
    let cdt =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::bulk_load_cdt(points.collect(), pairs).unwrap();
    let edge = |edge: spade::handles::UndirectedEdgeHandle<'_, _, _, _, _>| {
        ordered(edge.vertices().map(|vertex| vertex.index() as u32))
    };
    cdt.undirected_edges().map(edge).collect()
}

/// Whether the four vertices of the two triangles at an edge are on a circle, by the crate `robust`.
fn is_tie(mesh: &Mesh, edge: Pair) -> bool {
    let (corners, _) = mesh.triangles().as_chunks::<3>();
    let around = corners.iter().filter(|corners| edge.iter().all(|v| corners.contains(v)));
    let vertices: BTreeSet<u32> = around.flatten().copied().collect();
    let points: Vec<_> = vertices.into_iter().map(|v| point(mesh, v)).collect();
    matches!(points[..], [a, b, c, d] if incircle(a, b, c, d) == 0.0)
}

/// The 36 points with whole coordinates on a circle with radius 65, all joined to its centre, which is vertex 0.
fn circle() -> Mesh {
    let on_circle = |&(x, y): &(i32, i32)| x * x + y * y == 65 * 65;
    let all = (-65..=65).flat_map(|x| (-65..=65).map(move |y| (x, y)));
    let mut points: Vec<_> = all.filter(on_circle).map(|(x, y)| [f64::from(x), f64::from(y)]).collect();
    points.sort_by(|[x, y], [p, q]| y.atan2(*x).total_cmp(&q.atan2(*p)));
    let count = points.len() as u32;
    points.insert(0, [0.0, 0.0]);
    let triangles = (0..count).flat_map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
    Mesh::new(Dimension::Two, points.concat(), triangles).unwrap()
}

fn pairs(vertices: usize, count: usize) -> impl Strategy<Value = Vec<Pair>> {
    let vertex = 0..vertices as u32;
    proptest::collection::vec([vertex.clone(), vertex], 0..count)
        .prop_map(|pairs| pairs.into_iter().filter(|[u, v]| u != v).collect())
}

proptest! {
    /// Random points, thin triangles, lattices, where most constraints meet vertices, and points on a circle.
    #[test]
    fn constraints_become_edges(
        family in prop::sample::select(vec!["random 9", "shear 9", "regular 9", "grid 9", "sweep 60", "strips 30", "circle"]),
        seed in 0u64..1000,
        constraints in pairs(61, 30),
    ) {
        let seeded = format!("{family} seed={seed}");
        let mesh = families::by_name(&seeded).or_else(|_| families::by_name(family)).unwrap_or_else(|_| circle());
        let count = mesh.vertex_count() as u32;
        let constraints: Vec<Pair> = constraints.into_iter().map(|pair| pair.map(|v| v % count)).filter(|[u, v]| u != v).collect();
        let result = check(&mesh, &constraints);
        let after = flipped(&result.mesh, &result.locked_edges);
        assert_valid(&mesh, &after);
        // spade also fills the convex hull.
        let locked: Vec<Pair> = border(&mesh).into_iter().chain(result.locked_edges).collect();
        let (ours, theirs) = (edges(&after), by_spade(&mesh, &locked));
        let other: Vec<_> = ours.difference(&theirs).filter(|&&edge| !is_tie(&after, edge)).collect();
        prop_assert!(other.is_empty(), "{other:?}");
    }
}

/// Two chains that bend towards the constraint, and a zigzag between them: the polygons have few convex corners.
#[test]
fn a_constraint_between_inward_chains_comes_in() {
    let left = [[2.0, 0.2], [4.0, 0.8], [6.0, 1.8], [8.0, 3.2]];
    for mirrored in [false, true] {
        let mut points = vec![[0.0, 0.0], [10.0, 0.0]];
        points.extend(left);
        points.extend(left.iter().rev().map(|[x, y]| [10.0 - x, -y]));
        if mirrored {
            points.iter_mut().for_each(|point| point[1] = -point[1]);
        }
        // u = 0, v = 1; the left chain is 2 to 5, the right one 6 to 9.
        let triangles =
            [[0, 6, 2], [6, 3, 2], [6, 4, 3], [6, 5, 4], [6, 7, 5], [7, 8, 5], [8, 9, 5], [9, 1, 5]];
        let mut mesh = Mesh::new(Dimension::Two, points.concat(), triangles.concat()).unwrap();
        if mirrored {
            let turned = triangles.map(|[a, b, c]| [b, a, c]);
            mesh = mesh.with_triangles(turned.concat()).unwrap();
        }
        for ends in [[0, 1], [1, 0]] {
            let result = check(&mesh, &[ends]);
            assert_eq!(result.locked_edges, [ends]);
            assert_eq!(result.crossed_edges, 7);
        }
    }
}

/// A square of 4 × 4 vertices with two triangles in each cell but the middle one; the vertex 16 is in no triangle.
fn ring() -> Mesh {
    let mut positions: Vec<f64> = (0..16).flat_map(|v| [f64::from(v % 4), f64::from(v / 4)]).collect();
    positions.extend([9.0, 9.0]);
    let cell = |v: u32| [[v, v + 1, v + 5], [v, v + 5, v + 4]];
    let cells = [0, 1, 2, 4, 6, 8, 9, 10];
    Mesh::new(Dimension::Two, positions, cells.map(cell).as_flattened().concat()).unwrap()
}

#[track_caller]
fn assert_refused(mesh: &Mesh, constraints: &[Pair], locked: &[Pair], message: &str) {
    let error = brought_in(mesh, constraints, locked, false).unwrap_err().to_string();
    assert!(error.ends_with(message), "{error}");
    if constraints.len() == 1 && message.contains(" between ") {
        let result = brought_in(mesh, constraints, locked, true).unwrap();
        assert_eq!((result.crossed_edges, result.left_out.len()), (0, 1));
        assert_eq!((&result.mesh, &result.locked_edges[..]), (mesh, locked));
    }
}

#[test]
fn errors_name_the_constraint_and_what_it_meets() {
    let mesh = ring();
    let border = "crosses the edge between 6 and 5, which does not have two triangles";
    assert_refused(&mesh, &[[1, 14]], &[], &format!("constraint 0 between 1 and 14 {border}"));
    assert_refused(&mesh, &[[5, 10]], &[], "constraint 0 between 5 and 10 leaves the mesh at vertex 5");
    assert_refused(
        &mesh,
        &[[3, 16]],
        &[],
        "constraint 0 between 3 and 16 ends at vertex 16, which no triangle has; weld it if another vertex is there",
    );
    assert_refused(
        &mesh,
        &[[16, 3]],
        &[],
        "constraint 0 between 16 and 3 ends at vertex 16, which no triangle has; weld it if another vertex is there",
    );
    assert_refused(&mesh, &[[0, 17]], &[], "constraint 0 joins 0 and 17; the mesh has 17 vertices");
    assert_refused(
        &mesh,
        &[[1, 4]],
        &[[0, 5]],
        "constraint 0 between 1 and 4 crosses the locked edge between 5 and 0",
    );
    let other = "constraint 1 between 4 and 1 crosses constraint 0 between 5 and 0";
    assert_refused(&mesh, &[[5, 0], [4, 1]], &[], other);
    let result = brought_in(&mesh, &[[5, 0], [4, 1], [2, 7]], &[], true).unwrap();
    assert_eq!(result.left_out, [LeftOut { index: 1, reason: other.to_owned() }]);
    assert_eq!(result.locked_edges, [[5, 0], [2, 7]]);

    let folded = mesh.with_triangles(vec![0, 1, 5, 0, 5, 2, 4, 9, 8]).unwrap();
    let what = "constraint 0 between 1 and 4 crosses triangle 1, which is flat or turned over; untangle may mend that";
    assert_refused(&folded, &[[1, 4]], &[], what);
    let surface = Mesh::new(Dimension::Three, vec![0.0; 9], vec![0, 1, 2]).unwrap();
    assert!(brought_in(&surface, &[[0, 1]], &[], true).is_err());
    let twice =
        Mesh::new(Dimension::Two, vec![0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0], vec![0, 1, 2, 3, 1, 2])
            .unwrap();
    let [first, second] = [[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], [1.0, 1.0, 2.0, 2.0, 0.0, 2.0]];
    let apart = Mesh::new(Dimension::Two, [first, second].concat(), (0..6).collect()).unwrap();
    let place = "constraint 0 between 0 and 3 reaches the point of vertex 3 in triangles without it: another \
                 vertex has that point, or triangles overlap there; untangle may mend that";
    assert_refused(&apart, &[[0, 3]], &[], place);
    let same = "constraint 0 between 0 and 3 joins two vertices at the same point; weld them first";
    assert_refused(&twice, &[[0, 3]], &[], same);
    let itself = "constraint 0 between 1 and 1 joins a vertex to itself; remove it from the list";
    assert_refused(&twice, &[[1, 1]], &[], itself);
}

/// Clockwise triangles give the mirrored result.
#[test]
fn clockwise_meshes_take_constraints() {
    let mesh = families::by_name("random 9").unwrap();
    let turned = |mesh: &Mesh| {
        let triangles = mesh.triangles().as_chunks::<3>().0.iter().map(|&[a, b, c]| [b, a, c]);
        mesh.with_triangles(triangles.collect::<Vec<_>>().concat()).unwrap()
    };
    let constraints = [[0, 80], [72, 44], [3, 60]];
    let [ours, theirs] =
        [&mesh, &turned(&mesh)].map(|mesh| brought_in(mesh, &constraints, &[], true).unwrap());
    assert_eq!(edges(&ours.mesh).len(), edges(&theirs.mesh).len());
    assert_valid(&mesh, &turned(&theirs.mesh));
    assert_eq!(ours.locked_edges, theirs.locked_edges);
}

/// Long chains that bend towards the constraint. Flips could need the square of their length.
#[test]
fn a_constraint_between_long_inward_chains_comes_in() {
    let count = 400;
    let curve = |i: u32| {
        let x = f64::from(i + 1);
        [x, 1.0 + x * x]
    };
    let mut points = vec![[0.0, 0.0], [f64::from(count + 2), 0.0]];
    points.extend((0..count).map(curve));
    points.extend((0..count).map(|i| [f64::from(i + 1), -curve(count - 1 - i)[1]]));
    let (left, right) = (|i: u32| 2 + i, |i: u32| 2 + count + i);
    let mut triangles = vec![[0, right(0), left(0)]];
    for i in 1..count {
        triangles.push([right(i - 1), left(i), left(i - 1)]);
        triangles.push([right(i - 1), right(i), left(i)]);
    }
    triangles.push([right(count - 1), 1, left(count - 1)]);
    let mesh = Mesh::new(Dimension::Two, points.concat(), triangles.concat()).unwrap();
    let result = brought_in(&mesh, &[[0, 1]], &[], true).unwrap();
    assert_eq!((result.crossed_edges, &result.left_out[..]), (799, &[][..]));
    assert_valid(&mesh, &result.mesh);
}

/// The search for the first triangle of a constraint passes by vertices where many triangles or constraints meet.
#[test]
fn constraints_from_one_vertex_are_walked_from_the_other_end() {
    let [random, fan] = ["random 20", "fan2 400"].map(|spec| families::by_name(spec).unwrap());
    // The second vertex has most of the fan's triangles.
    for (mesh, hub) in [(random, 210), (fan, 1)] {
        let ends = (0..400).filter(|&v| v != hub).map(|v| [hub, v]);
        let constraints: Vec<_> = ends.collect();
        let state = State::new(&mesh, &[], &Threads::one());
        let directed = directed(&state, &constraints);
        assert!(directed.iter().all(|&[_, end]| end == hub));
        check(&mesh, &constraints);
    }
    // A fan round a vertex whose star is not known to be embedded, because a triangle above it is missing.
    let rim = (1..400).map(|i| f64::from(i) * std::f64::consts::TAU / 400.0);
    let rim = rim.flat_map(|angle| [angle.sin(), angle.cos()]);
    let triangles = (1..399).flat_map(|i| [0, i + 1, i]).collect();
    let mesh = Mesh::new(Dimension::Two, [0.0, 0.0].into_iter().chain(rim).collect::<Vec<f64>>(), triangles)
        .unwrap();
    let state = State::new(&mesh, &[], &Threads::one());
    assert!(!state.embedded.at(0));
    for ends in (1..400).map(|v| [v, 0]).chain((1..397).map(|v| [v, v + 3])) {
        assert!(state.walk(ends, usize::MAX).unwrap().around.len() < 20, "{ends:?}");
    }
}
