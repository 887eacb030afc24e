//! Measures of the shape of a mesh. They are computed in f64, for reports only: no flip depends on them.

use super::angles::triangle_angles;
use crate::predicates::has_area;
use crate::system::threads::Threads;
use crate::{Dimension, Mesh};
use glam::DVec3;
use rstar::{AABB, PointDistance, RTree, RTreeObject};

/// Measures of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Smallest angle in degrees; 60 for a mesh without triangles.
    pub min_angle: f64,
    /// Mean of the smallest angles of the triangles, in degrees; 60 for a mesh without triangles.
    pub mean_min_angle: f64,
    /// Mean aspect ratio of the triangles that are not flat, and whose area is not 0 in f64: the longest edge divided by
    /// the diameter of the incircle, scaled to 1 for an equilateral triangle; 1 if there are none.
    pub mean_aspect: f64,
    /// The number of flat triangles: their corners are on one line, exactly.
    pub flat: usize,
    /// The sum of the unsigned areas of the triangles.
    pub area: f64,
    /// The volume inside a closed surface, negative if its triangles are clockwise from outside. 0 in the plane. An
    /// open surface is closed by a cone from its boundary to the position of the lowest vertex index that a triangle
    /// uses. Flips change neither, so the difference of the volumes before and after a run is the volume between the
    /// surfaces.
    pub volume: f64,
}

/// Triangles per chunk of work. The sums of the chunks are added in order, so the result has the same bits on any
/// number of threads.
const CHUNK: usize = 1 << 12;

/// Measures a mesh.
pub fn measures(mesh: &Mesh) -> Measures {
    let (count, triangles) = (mesh.triangle_count(), mesh.triangles());
    let origin = origin(mesh);
    let chunks = triangles.chunks(3 * CHUNK).collect();
    let threads = Threads::default().for_triangles(count);
    let all = threads.map_each(chunks, |chunk| Sums::of(mesh, chunk, origin)).into_iter();
    let sums = all.fold(Sums { min_angle: 60.0, ..Sums::default() }, Sums::and);
    let mean = |sum: f64, count: usize, of_none: f64| if count == 0 { of_none } else { sum / count as f64 };
    Measures {
        min_angle: sums.min_angle,
        mean_min_angle: mean(sums.min_angles, count, 60.0),
        mean_aspect: mean(sums.aspects, sums.with_aspect, 1.0),
        flat: sums.flat,
        area: sums.area,
        volume: if mesh.dimension() == Dimension::Two { 0.0 } else { sums.volume },
    }
}

/// The origin for volumes: the position of the lowest vertex index that a triangle uses, which no flip changes. It is
/// near the mesh, so that a large offset costs no precision.
fn origin(mesh: &Mesh) -> DVec3 {
    mesh.triangles().iter().min().map_or(DVec3::ZERO, |&v| mesh.point3(v))
}

/// Sums over triangles.
#[derive(Clone, Copy, Default)]
struct Sums {
    min_angle: f64,
    min_angles: f64,
    aspects: f64,
    with_aspect: usize,
    flat: usize,
    area: f64,
    volume: f64,
}

impl Sums {
    fn of(mesh: &Mesh, chunk: &[u32], origin: DVec3) -> Self {
        let mut sums = Self { min_angle: 60.0, ..Self::default() };
        for corners in triangles(mesh, chunk) {
            let angle = smallest_angle(corners);
            sums.min_angle = sums.min_angle.min(angle);
            sums.min_angles += angle;
            let [a, b, c] = corners;
            let is_flat = !has_area(a, b, c);
            sums.flat += usize::from(is_flat);
            let [a, b, c] = corners.map(|corner| corner - origin);
            let doubled = (b - a).cross(c - a).length();
            sums.area += doubled / 2.0;
            sums.volume += a.dot(b.cross(c)) / 6.0;
            let edges = [a - b, b - c, c - a].map(DVec3::length);
            if doubled > 0.0 && !is_flat {
                let [longest, around] = [edges.into_iter().fold(0.0, f64::max), edges.iter().sum::<f64>()];
                // The radius of the incircle is twice the area divided by the perimeter.
                sums.aspects += longest * around / (2.0 * 3f64.sqrt() * doubled);
                sums.with_aspect += 1;
            }
        }
        sums
    }

    fn and(self, other: Self) -> Self {
        Self {
            min_angle: self.min_angle.min(other.min_angle),
            min_angles: self.min_angles + other.min_angles,
            aspects: self.aspects + other.aspects,
            with_aspect: self.with_aspect + other.with_aspect,
            flat: self.flat + other.flat,
            area: self.area + other.area,
            volume: self.volume + other.volume,
        }
    }
}

/// The smallest angle of a triangle, in degrees: the one opposite to its shortest edge.
fn smallest_angle(corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners;
    let squares = [b - c, c - a, a - b].map(DVec3::length_squared);
    // Outside this range, products overflow, underflow or are 0.
    if !squares.iter().all(|square| (1e-200..1e200).contains(square)) {
        return triangle_angles(corners).into_iter().fold(f64::INFINITY, f64::min);
    }
    let opposite = match squares {
        [x, y, z] if x <= y && x <= z => 0,
        [_, y, z] if y <= z => 1,
        _ => 2,
    };
    let [p, q] = [1, 2].map(|k| corners[(opposite + k) % 3] - corners[opposite]);
    libm::atan2(p.cross(q).length(), p.dot(q)).to_degrees()
}

fn triangles(mesh: &Mesh, triangles: &[u32]) -> impl Iterator<Item = [DVec3; 3]> {
    triangles.as_chunks::<3>().0.iter().map(|triangle| triangle.map(|v| mesh.point3(v)))
}

/// The indices of the triangles that differ between `before` and `after`, in ascending order. A triangle that only
/// starts at another corner does not differ.
pub fn moved(before: &[u32], after: &[u32]) -> Vec<u32> {
    let is_same = |[a, b, c]: [u32; 3], other| [[a, b, c], [b, c, a], [c, a, b]].contains(other);
    let [before, after] = [before, after].map(|triangles| triangles.as_chunks::<3>().0);
    let count = before.len().min(after.len());
    let lists = Threads::default().for_triangles(count).map(count, |piece| {
        piece.filter(|&t| !is_same(before[t], &after[t])).map(|t| t as u32).collect::<Vec<_>>()
    });
    lists.concat()
}

/// The largest distance between the surfaces of `triangles` and of the mesh, in both directions, in the unit of its
/// coordinates. It is measured at three points of each edge that only one of the two surfaces has: there, flips move a
/// surface most.
pub fn distance(mesh: &Mesh, triangles: &[u32]) -> f64 {
    let moved = moved(mesh.triangles(), triangles);
    if moved.is_empty() || mesh.dimension() == Dimension::Two {
        return 0.0;
    }
    let [before, after] = [mesh.triangles(), triangles].map(|triangles| edges(triangles, &moved));
    one_way(mesh, &without(&after, &before), mesh.triangles()).max(one_way(
        mesh,
        &without(&before, &after),
        triangles,
    ))
}

/// The edges of these triangles, in ascending order.
fn edges(triangles: &[u32], these: &[u32]) -> Vec<[u32; 2]> {
    let all = triangles.as_chunks::<3>().0;
    let edges = these.iter().flat_map(|&t| {
        let [a, b, c] = all[t as usize];
        [[a, b], [b, c], [c, a]].map(|[u, v]| [u.min(v), u.max(v)])
    });
    let mut edges: Vec<_> = edges.collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The edges that are not in `excluded`, which is sorted.
fn without(edges: &[[u32; 2]], excluded: &[[u32; 2]]) -> Vec<[u32; 2]> {
    edges.iter().filter(|edge| excluded.binary_search(edge).is_err()).copied().collect()
}

/// The largest distance from points on the edges to a surface.
fn one_way(mesh: &Mesh, edges: &[[u32; 2]], surface: &[u32]) -> f64 {
    // So that no square of a coordinate overflows.
    let scale = mesh.positions().iter().fold(f64::MIN_POSITIVE, |scale, x| scale.max(x.abs()));
    let scaled = |triangle: [DVec3; 3]| Patch(triangle.map(|corner| corner / scale));
    let tree = RTree::bulk_load(triangles(mesh, surface).map(scaled).collect());
    let points = edges.iter().flat_map(|edge| {
        let [u, v] = edge.map(|vertex| mesh.point3(vertex) / scale);
        [0.25, 0.5, 0.75].map(|part| u.lerp(v, part))
    });
    let squares = points.filter_map(|point| Some(tree.nearest_neighbor_with_distance_2(point.into())?.1));
    scale * squares.fold(0.0, f64::max).sqrt()
}

/// A triangle in space, for searches by position.
struct Patch([DVec3; 3]);

impl RTreeObject for Patch {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        let [a, b, c] = self.0;
        AABB::from_corners(a.min(b).min(c).into(), a.max(b).max(c).into())
    }
}

impl PointDistance for Patch {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        let point = DVec3::from_array(*point);
        let [a, b, c] = self.0;
        let normal = (b - a).cross(c - a);
        let is_inside = |from: DVec3, to: DVec3| normal.dot((to - from).cross(point - from)) >= 0.0;
        if normal.length_squared() > 0.0 && is_inside(a, b) && is_inside(b, c) && is_inside(c, a) {
            let height = normal.dot(point - a);
            return height * height / normal.length_squared();
        }
        [(a, b), (b, c), (c, a)]
            .map(|(from, to)| to_segment(point, from, to))
            .into_iter()
            .fold(f64::MAX, f64::min)
    }
}

/// The square of the distance from a point to a segment.
fn to_segment(point: DVec3, from: DVec3, to: DVec3) -> f64 {
    let along = to - from;
    let square = along.length_squared();
    let part = if square > 0.0 { ((point - from).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    point.distance_squared(from + part * along)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::by_name;
    use crate::quality::angles;

    fn mesh(positions: &[f64], triangles: &[u32]) -> Mesh {
        Mesh::new(Dimension::Three, positions.to_vec(), triangles.to_vec()).unwrap()
    }

    /// The corner of a cube of side 2, far from the origin, counter-clockwise from outside.
    const CORNER: [f64; 12] = [1e6, 0., 0., 1e6 + 2., 0., 0., 1e6, 2., 0., 1e6, 0., 2.];
    const TETRAHEDRON: [u32; 12] = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];

    #[test]
    fn a_tetrahedron_is_measured() {
        let found = measures(&mesh(&CORNER, &TETRAHEDRON));
        assert!((found.area - (6.0 + 2.0 * 3f64.sqrt())).abs() < 1e-9, "{found:?}");
        assert!((found.volume - 8.0 / 6.0).abs() < 1e-9, "{found:?}");
        assert!((found.min_angle - 45.0).abs() < 1e-9, "{found:?}");
        assert!((found.mean_min_angle - 48.75).abs() < 1e-9, "{found:?}");
        // The aspect of a right triangle with legs 1 is (1 + √2)·√2 / √3; that of an equilateral triangle is 1.
        let right = (2f64.sqrt() + 2.0) * 2f64.sqrt() / (2.0 * 3f64.sqrt());
        assert!((found.mean_aspect - (3.0 * right + 1.0) / 4.0).abs() < 1e-9, "{found:?}");
    }

    /// Vertex 0 is unused. A square in a plane is flipped; a wall stands on one of its sides.
    #[test]
    fn an_open_surface_has_the_same_volume_after_a_flip_inside_a_plane() {
        let positions = [9., 9., 9., 0., 0., 0., 2., 0., 0., 2., 2., 0., 0., 2., 0., 2., 1., 2.];
        let [before, after] = [[1, 2, 3, 1, 3, 4, 3, 2, 5], [2, 4, 1, 2, 3, 4, 3, 2, 5]]
            .map(|triangles| measures(&mesh(&positions, &triangles)).volume);
        assert_eq!((before, after), (-8.0 / 6.0, -8.0 / 6.0));
    }

    #[test]
    fn flat_triangles_are_counted() {
        let found = measures(&mesh(&CORNER, &[0, 0, 1, 1, 2, 3]));
        assert_eq!((found.flat, found.min_angle), (1, 0.0));
        assert!((found.mean_aspect - 1.0).abs() < 1e-9);
        // Areas that f64 rounds to 0.
        let tiny = CORNER.map(|x| x % 1e6 * 1e-170);
        let found = measures(&mesh(&tiny, &TETRAHEDRON));
        assert_eq!((found.flat, found.area, found.mean_aspect), (0, 0.0, 1.0));
        let none = measures(&mesh(&[], &[]));
        assert_eq!(
            (none.min_angle, none.mean_min_angle, none.mean_aspect, none.area),
            (60.0, 60.0, 1.0, 0.0)
        );
    }

    #[test]
    fn the_smallest_angle_is_that_of_all_angles() {
        for family in ["random 40", "uvsphere 20", "strips 30"] {
            let mesh = by_name(family).unwrap();
            let (found, all) = (measures(&mesh), angles(&mesh, 1));
            assert!((found.min_angle - all.min).abs() < 1e-9, "{family}");
            assert!((found.mean_min_angle - all.mean_min).abs() < 1e-9, "{family}");
        }
    }

    #[cfg(feature = "threads")]
    #[test]
    fn measures_are_the_same_on_any_number_of_threads() {
        let mesh = by_name("uvsphere 60").unwrap();
        let on = |count| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
            pool.install(|| format!("{:?}", measures(&mesh)))
        };
        for count in 2..5 {
            assert_eq!(on(count), on(1));
        }
    }

    #[test]
    fn a_rotated_triangle_has_not_moved() {
        assert_eq!(moved(&[0, 1, 2, 3, 4, 5, 6, 7, 8], &[1, 2, 0, 3, 5, 4, 6, 7, 9]), [1, 2]);
    }

    /// A flat square with one corner lifted by h: its diagonals are h / 2 apart in their middles.
    #[test]
    fn a_flip_moves_the_surface_by_the_distance_of_the_diagonals() {
        let [before, after] = [[0, 1, 2, 0, 2, 3], [0, 1, 3, 1, 2, 3]];
        for h in [0.0, 1e-3] {
            let square = mesh(&[0., 0., 0., 1., 0., 0., 1., 1., h, 0., 1., 0.], &before);
            let found = distance(&square, &after);
            // The middle of a diagonal has about this distance from the other surface.
            assert!(found <= h / 2.0 && found >= 0.99 * h / 2.0, "{found}");
            assert_eq!(distance(&square, &before), 0.0);
            for scale in [1e300, 1e-300] {
                let scaled: Vec<f64> = square.positions().iter().map(|x| x * scale).collect();
                let found = distance(&mesh(&scaled, &before), &after) / scale;
                assert!(found <= h / 1.999 && found >= 0.99 * h / 2.0, "{found}");
            }
        }
    }

    #[test]
    fn the_distance_is_that_to_the_nearest_of_all_triangles() {
        let sphere = by_name("uvsphere 8").unwrap();
        let turned: Vec<u32> = sphere.triangles().iter().rev().copied().collect();
        assert!(distance(&sphere, &turned) < 1e-12);
        for (point, expected) in [([0.25, 0.25, 3.0], 9.0), ([2.0, 0.0, 0.0], 1.0), ([-1.0, -1.0, 1.0], 3.0)]
        {
            let patch = Patch([DVec3::ZERO, DVec3::X, DVec3::Y]);
            assert_eq!(patch.distance_2(&point), expected);
            assert_eq!(Patch([DVec3::ZERO; 3]).distance_2(&[3.0, 4.0, 0.0]), 25.0);
        }
    }
}
