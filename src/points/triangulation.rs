//! `triangulate`: from points to triangles, twins and the hull.

use super::columns::Columns;
use super::constraints::Constraints;
use super::halves::{Network, slots_of};
use super::numbering::{numbered, numbered_hull};
use super::options::PointOptions;
use super::stars::Stars;
use crate::mesh::MAX_TRIANGLES;
use crate::system::memory;
use crate::system::threads::Threads;
use crate::{Dimension, Error, LeftOut, Positions};

/// The most points: with the triangles beyond the hull, V of them have up to 2V - 2 triangles.
const MAX_POINTS: usize = MAX_TRIANGLES / 2 + 1;

/// The most bytes that a point takes at a time: its index (4), two slots (64) and their numbers (8), two triangles with
/// their twins (48), the half-edges with which these begin (8), and what the loops count (4).
const BYTES_PER_POINT: u64 = 136;

/// The most bytes that a constraint of one edge takes: its ends (8), its edge (12), the same to look for the edge that
/// another crosses (24), and the edge in the result (8).
const BYTES_PER_CONSTRAINT: u64 = 52;

/// The most bytes that a constraint takes that is left out: its ends (8), itself in a list that grows (36), and its reason
/// (160).
const BYTES_PER_SKIPPED: u64 = 204;

/// A Delaunay triangulation of points in the plane, from [`triangulate`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Triangulation {
    /// Three indices of points per triangle, counter-clockwise. The first is the smallest, and the triangles are sorted
    /// by their indices: first by the first, then by the second.
    pub triangles: Vec<u32>,
    /// For each half-edge, the half-edge on the other side; [`NONE`](crate::NONE) on the hull.
    pub twins: Vec<u32>,
    /// The indices of the points on the hull, counter-clockwise, from the smallest. Points on a side of the hull count as
    /// points of the hull. If there is no triangle, these are all distinct points, by x and then by y.
    pub hull: Vec<u32>,
    /// For each point that equals another with a smaller index: its index, and the smallest of the indices. Only the
    /// smallest is in triangles. Sorted.
    pub duplicates: Vec<[u32; 2]>,
    /// The edges of the constraints, in their order and direction: for [`regions`](crate::regions). A constraint through
    /// points is several edges.
    pub constraint_edges: Vec<[u32; 2]>,
    /// The constraints that were left out, in ascending order.
    pub left_out: Vec<LeftOut>,
}

impl Triangulation {
    /// Whether there is no triangle: fewer than three distinct points, or all of them are on one line.
    pub fn is_flat(&self) -> bool {
        self.triangles.is_empty()
    }
}

/// The Delaunay triangulation of points in the plane: 2 numbers per point.
///
/// No point is inside the circumcircle of a triangle. If four points are on one circle, the least of them, by x and then
/// by y, is joined to the other three: so the points alone determine the triangles, whatever their order. Every decision
/// is exact, and the time is O(n log n) for any points. It uses all cores. [`triangulate_with`] takes constraints and a
/// number of threads, which does not change the result.
///
/// The points are sorted into columns, and sets of points are merged as Guibas and Stolfi do ("Primitives for the
/// manipulation of general subdivisions", 1985), with triangles to a symbolic vertex along the hull as Shewchuk has them
/// ("Triangle", 1996).
///
/// ```
/// use edgeflip::{NONE, Positions, triangulate};
///
/// let points = Positions::from(vec![0.0, 0.0, 4.0, 0.0, 4.0, 3.0, 0.0, 3.0, 4.0, 0.0]);
/// let triangulation = triangulate(&points)?;
/// assert_eq!(triangulation.triangles, [0, 1, 2, 0, 2, 3]);
/// assert_eq!(triangulation.twins, [NONE, NONE, 3, 2, NONE, NONE]);
/// assert_eq!(triangulation.hull, [0, 1, 2, 3]);
/// assert_eq!(triangulation.duplicates, [[4, 1]]);
/// # Ok::<(), edgeflip::Error>(())
/// ```
///
/// # Errors
/// [`Error::RaggedArray`] for an odd number of coordinates, [`Error::NonFinite`] for the first coordinate that is NaN or
/// infinite, [`Error::TooLarge`] or [`Error::OutOfMemory`] for too many points. Points without a triangle are no error.
pub fn triangulate(points: &Positions) -> Result<Triangulation, Error> {
    triangulate_with(points, &PointOptions::default())
}

/// As [`triangulate`], with options.
///
/// # Errors
/// Those of [`triangulate`], and [`Error::Option`] for a constraint that joins a point which does not exist or, without
/// `skips_constraints`, crosses an earlier one; for more threads than [`MOST_THREADS`](crate::MOST_THREADS); and if the
/// threads cannot be started.
pub fn triangulate_with(points: &Positions, options: &PointOptions) -> Result<Triangulation, Error> {
    let count = count_of(points)?;
    options.check(count)?;
    let threads = Threads::new(options.threads, 2 * count)?;
    points.refuse_non_finite(Dimension::Two, &threads)?;
    let bytes = if options.skips_constraints { BYTES_PER_SKIPPED } else { BYTES_PER_CONSTRAINT };
    memory::check(BYTES_PER_POINT * count as u64 + bytes * options.constraints.len() as u64)?;
    let triangulation = threads.enter(|| triangulated(points, options, &threads));
    let triangulation = triangulation.map_err(|bytes| Error::OutOfMemory { bytes, limit: memory::LIMIT })?;
    match triangulation.left_out.first() {
        Some(LeftOut { reason, .. }) if !options.skips_constraints => {
            Err(Error::Option { option: "constraints", message: reason.clone() })
        }
        _ => Ok(triangulation),
    }
}

/// The number of points.
///
/// # Errors
/// [`Error::RaggedArray`], [`Error::TooLarge`].
pub(super) fn count_of(points: &Positions) -> Result<usize, Error> {
    let (length, stride) = (points.len(), Dimension::Two.stride());
    if length % stride != 0 {
        return Err(Error::RaggedArray { array: "positions", length, stride });
    }
    refuse_many(length / stride)?;
    Ok(length / stride)
}

/// # Errors
/// [`Error::TooLarge`] for more points than 32-bit indices allow.
pub(super) fn refuse_many(count: usize) -> Result<(), Error> {
    if count > MAX_POINTS {
        return Err(Error::TooLarge { what: "vertices", count, limit: MAX_POINTS });
    }
    Ok(())
}

/// # Errors
/// Those of [`Constraints::bring_in`].
pub(super) fn triangulated(
    points: &Positions,
    options: &PointOptions,
    threads: &Threads,
) -> Result<Triangulation, u64> {
    let Columns { points: sorted, indices, starts, duplicates } = Columns::of(points, threads);
    let mut slots = slots_of(sorted.len(), threads);
    let mut vertices = Network::new(&sorted, &mut slots, threads).of_columns(&starts);
    let (mut constraint_edges, mut left_out) = Default::default();
    if options.constraints.is_empty() {
        drop(sorted);
    } else {
        let mut stars = Stars::new(sorted, slots);
        (constraint_edges, left_out) = brought_in(options, &mut stars, &indices, &duplicates)?;
        slots = stars.slots.slots;
    }
    let numbered = numbered(&slots, &indices, points.len() / 2, threads);
    let (triangles, twins) = numbered.with_twins(&slots, threads);
    let hull = if triangles.is_empty() {
        // There and back along the line.
        vertices.truncate(indices.len());
        vertices.into_iter().map(|vertex| indices[vertex as usize]).collect()
    } else {
        numbered_hull(vertices, &indices)
    };
    Ok(Triangulation { triangles, twins, hull, duplicates, constraint_edges, left_out })
}

/// Brings the constraints in. Returns their edges, and those that were left out.
fn brought_in(
    options: &PointOptions,
    stars: &mut Stars,
    indices: &[u32],
    duplicates: &[[u32; 2]],
) -> Result<(Vec<[u32; 2]>, Vec<LeftOut>), u64> {
    let PointOptions { constraints, skips_constraints, .. } = options;
    let mut vertices = vec![0; indices.len() + duplicates.len()];
    for (vertex, &index) in (0..).zip(indices) {
        vertices[index as usize] = vertex;
    }
    for &[index, first] in duplicates {
        vertices[index as usize] = vertices[first as usize];
    }
    let given: Vec<_> = constraints.iter().map(|ends| ends.map(|index| vertices[index as usize])).collect();
    let brought = Constraints { given: &given, skips: *skips_constraints }.bring_in(stars)?;
    let edges = brought.edges.iter().map(|&[_, a, b]| [a, b].map(|vertex| indices[vertex as usize]));
    Ok((edges.collect(), brought.left_out(constraints)))
}
