//! Cuts a polygon into triangles. The fan around its first corner stays if it does not leave the polygon. Otherwise the
//! crate `spade` triangulates the corners, seen along the normal of the polygon; its predicates are exact.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};
use spade::handles::{DirectedEdgeHandle, FixedVertexHandle};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation, mitigate_underflow};
use std::collections::{HashMap, HashSet};

/// How a polygon is cut.
#[derive(Debug, PartialEq)]
pub(super) enum Cut {
    /// Into the fan around its first corner.
    Fan,
    /// Into these triangles of corners: two less than corners, in the orientation of the polygon.
    Others(Vec<[usize; 3]>),
    /// Its outline crosses or touches itself, seen along its normal.
    Crossing,
}

/// Cuts a polygon of at least 3 corners.
pub(super) fn cut(corners: &[DVec3]) -> Cut {
    let points = seen(corners, Along::Normal);
    if fan_stays_inside(&points) {
        return Cut::Fan;
    }
    let triangles = triangulated(&points).or_else(|| triangulated(&seen(corners, Along::Axis)));
    triangles.map_or(Cut::Crossing, Cut::Others)
}

/// Whether rounding cannot turn a triangle of a quadrilateral's fan against the other. Most files have no other.
pub(super) fn is_far_from_concave([a, b, c, d]: [DVec3; 4]) -> bool {
    let [ab, ac, ad] = [b - a, c - a, d - a];
    let product = ab.cross(ac).dot(ac.cross(ad));
    let size = ab.length_squared() * ac.length_squared() * ac.length_squared() * ad.length_squared();
    product > 0.0 && product * product > 1e-24 * size
}

/// The direction in which a polygon is seen.
#[derive(PartialEq)]
enum Along {
    /// The normal of the best-fitting plane (Newell's).
    Normal,
    /// The axis that is closest to it. This rounds nothing: corners on a line stay there.
    Axis,
}

/// The corners seen in a direction, so that the area is positive.
fn seen(corners: &[DVec3], along: Along) -> Vec<DVec2> {
    let largest = corners.iter().fold(0.0, |largest: f64, corner| largest.max(corner.abs().max_element()));
    // A power of two: nothing overflows, and nothing is rounded.
    let scale = if largest > 0.0 { libm::ldexp(1.0, (-libm::ilogb(largest)).min(1022)) } else { 1.0 };
    let first = corners[0] * scale;
    let spans: Vec<DVec3> = corners.iter().map(|&corner| corner * scale - first).collect();
    let areas = || spans.windows(2).map(|pair| pair[0].cross(pair[1]));
    let mut normal: DVec3 = areas().sum();
    if normal == DVec3::ZERO {
        // The areas cancel each other, or all corners are on a line.
        normal = areas().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared())).unwrap_or_default();
    }
    let axis = normal.abs().max_position();
    let [mut u, mut v] = [(axis + 1) % 3, (axis + 2) % 3];
    if along == Along::Axis || normal[u] == 0.0 && normal[v] == 0.0 {
        if normal[axis] < 0.0 {
            (u, v) = (v, u);
        }
        return corners.iter().map(|&corner| DVec2::new(corner[u], corner[v]) * scale).collect();
    }
    let (u, v) = (normal / normal[axis].abs()).normalize().any_orthonormal_pair();
    spans.iter().map(|span| DVec2::new(span.dot(u), span.dot(v))).collect()
}

/// The sign of the area of a triangle, exactly.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
    orient2d(a, b, c)
}

/// Whether no triangle of the fan is turned over, and the fan does not go around its first corner more than once.
fn fan_stays_inside(points: &[DVec2]) -> bool {
    let first = points[0];
    let Some(&start) = points.iter().find(|&&point| point != first) else { return true };
    if points.iter().skip(2).rev().skip(1).any(|&point| point == first) {
        return false;
    }
    let is_opposite = |a: DVec2, b: DVec2| (a - first).dot(b - first) < 0.0;
    let mut is_past_half = false;
    points[1..].windows(2).all(|pair| {
        let turn = area(first, pair[0], pair[1]);
        let side = area(first, start, pair[1]);
        let was_past_half = is_past_half;
        is_past_half = side < 0.0 || side == 0.0 && is_opposite(start, pair[1]);
        let turns_back = turn < 0.0 || turn == 0.0 && is_opposite(pair[0], pair[1]);
        !turns_back && (is_past_half || !was_past_half)
    })
}

/// The triangles inside the outline of a polygon with positive area; `None` if the outline crosses or touches itself.
fn triangulated(points: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    let count = points.len();
    // -0 + 0 is 0.
    let mut points =
        Vec::from_iter(points.iter().map(|p| mitigate_underflow(Point2::new(p.x + 0.0, p.y + 0.0))));
    let (outline, mut triangles) = without_repeated(&points);
    let (mut numbers, mut places) = (HashMap::new(), Vec::new());
    let place = |&corner: &usize| {
        let point: Point2<f64> = points[corner];
        *numbers.entry([point.x.to_bits(), point.y.to_bits()]).or_insert_with(|| {
            places.push(point);
            places.len() - 1
        })
    };
    let places_of_outline: Vec<usize> = outline.iter().map(place).collect();
    let ends = |i: usize| [i, (i + 1) % outline.len()].map(|i| places_of_outline[i]);
    // A bridge is in the outline twice.
    let mut seen = HashSet::new();
    let edges = (0..outline.len()).map(ends).filter(|&[a, b]| seen.insert([a.min(b), a.max(b)]));
    let mut crosses = false;
    let cut =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(places, edges.collect(), |_| {
            crosses = true;
        });
    let cut = cut.ok().filter(|_| !crosses)?;
    // The corner where each directed edge begins. An edge of the outline with corners on it is in pieces: there it gets
    // corners of its own, which go again in the end.
    let (mut starts, mut corner_after) = (HashMap::new(), Vec::new());
    for (i, &corner) in outline.iter().enumerate() {
        let [mut from, to] = ends(i).map(FixedVertexHandle::from_index);
        let mut start = corner;
        while from != to {
            let next = next_on(&cut, from, to)?;
            if starts.insert([from.index(), next.index()], start).is_some() {
                return None;
            }
            if next != to {
                points.push(cut.vertex(next).position());
                start = points.len() - 1;
                corner_after.push(start + 1);
            }
            from = next;
        }
        if start >= count {
            corner_after[start - count] = outline[(i + 1) % outline.len()];
        }
    }
    let start = |edge: Edge| starts.get(&[edge.from().index(), edge.to().index()]).copied();
    let begins: Vec<Option<usize>> = cut.directed_edges().map(start).collect();
    let is_inside = inside(&cut, &begins)?;
    // Corners at the same place are told apart by the edge of the outline that comes before, counterclockwise.
    let mut corners = vec![0; begins.len()];
    for (first, corner) in cut.directed_edges().zip(&begins) {
        let Some(corner) = *corner else { continue };
        let mut edge = first;
        loop {
            corners[edge.index()] = corner;
            edge = edge.ccw();
            if begins[edge.index()].is_some() {
                break;
            }
        }
    }
    for face in cut.inner_faces().filter(|face| is_inside[face.index()]) {
        triangles.push(face.adjacent_edges().map(|edge| corners[edge.index()]));
    }
    if triangles.len() != points.len() - 2 {
        return None;
    }
    if !corner_after.is_empty() {
        triangles = without_last(&points, triangles, &corner_after)?;
    }
    for triangle in &mut triangles {
        let least = triangle.iter().zip(0..).min().map_or(0, |(_, i)| i);
        triangle.rotate_left(least);
    }
    triangles.sort_unstable();
    Some(triangles)
}

type Edge<'a> = DirectedEdgeHandle<'a, Point2<f64>, (), spade::CdtEdge<()>, ()>;

/// The corners without those at the place of the corner before, and triangles without area for these.
fn without_repeated(points: &[Point2<f64>]) -> (Vec<usize>, Vec<[usize; 3]>) {
    let after = |corner: usize| (corner + 1) % points.len();
    let is_new = |&corner: &usize| points[corner] != points[(corner + points.len() - 1) % points.len()];
    let outline: Vec<usize> = (0..points.len()).filter(is_new).collect();
    let mut triangles = Vec::new();
    for (i, &corner) in outline.iter().enumerate() {
        let next = outline[(i + 1) % outline.len()];
        let mut last = corner;
        while after(last) != next {
            triangles.push([last, after(last), next]);
            last = after(last);
        }
    }
    (outline, triangles)
}

/// The vertex after `from` on the way to `to`, along constraints.
fn next_on(
    cut: &ConstrainedDelaunayTriangulation<Point2<f64>>,
    from: FixedVertexHandle,
    to: FixedVertexHandle,
) -> Option<FixedVertexHandle> {
    let [start, end] = [from, to].map(|vertex| at(cut.vertex(vertex).position()));
    let is_on = |edge: &Edge| {
        let place = at(edge.to().position());
        edge.is_constraint_edge() && area(start, end, place) == 0.0 && (place - start).dot(end - start) > 0.0
    };
    cut.vertex(from).out_edges().find(is_on).map(|edge| edge.to().fix())
}

/// The triangles without the last corners, each of which is on a straight line between its neighbours in the outline,
/// with one triangle less for each. `after` has the next corner of the outline for each of them.
fn without_last(
    points: &[Point2<f64>],
    triangles: Vec<[usize; 3]>,
    after: &[usize],
) -> Option<Vec<[usize; 3]>> {
    // The third corner for each directed edge of a triangle.
    let mut thirds = HashMap::new();
    for [a, b, c] in triangles {
        thirds.extend([([a, b], c), ([b, c], a), ([c, a], b)]);
    }
    for (corner, &next) in (points.len() - after.len()..).zip(after) {
        // The corners around it, without those that are ears.
        let mut chain = vec![next];
        let mut last = next;
        while let Some(third) = thirds.remove(&[corner, last]) {
            thirds.remove(&[last, third]);
            thirds.remove(&[third, corner]);
            while let [.., a, b] = chain[..] {
                if area(at(points[a]), at(points[b]), at(points[third])) <= 0.0 {
                    break;
                }
                thirds.extend([([a, b], third), ([b, third], a), ([third, a], b)]);
                chain.pop();
            }
            chain.push(third);
            last = third;
        }
        if chain.len() != 2 {
            return None;
        }
    }
    let is_first = |&([a, b], c): &([usize; 2], usize)| a < b && a < c;
    Some(thirds.into_iter().filter(is_first).map(|([a, b], c)| [a, b, c]).collect())
}

fn at(point: Point2<f64>) -> DVec2 {
    DVec2::new(point.x, point.y)
}

/// Whether each face is inside the outline. `begins` has a corner for each directed edge of the outline. `None` if the
/// outline goes around a face twice, or clockwise.
fn inside(
    cut: &ConstrainedDelaunayTriangulation<Point2<f64>>,
    begins: &[Option<usize>],
) -> Option<Vec<bool>> {
    // How often the outline goes around a face: once more to the left of its edges than to the right.
    let mut turns = vec![None; cut.num_all_faces()];
    turns[cut.outer_face().index()] = Some(0);
    let mut pending: Vec<Edge> = cut.convex_hull().collect();
    while let Some(edge) = pending.pop() {
        let [left, right] = [edge.face(), edge.rev().face()];
        if turns[right.index()].is_some() {
            continue;
        }
        let [here, back] = [edge, edge.rev()].map(|edge| begins[edge.index()].is_some());
        let step = i32::from(back) - i32::from(here);
        turns[right.index()] = turns[left.index()].map(|turns| turns + step);
        pending.extend(right.as_inner().into_iter().flat_map(|face| face.adjacent_edges()));
    }
    turns
        .into_iter()
        .map(|turns| match turns {
            Some(0) => Some(false),
            Some(1) => Some(true),
            _ => None,
        })
        .collect()
}
