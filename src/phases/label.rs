//! Label: each triangle tests its three edges, and keeps the best of those that may flip.

use super::state::{BLOCKED, Geometry, Thresholds, Topology, key};
use crate::mesh::half_edge::{CREASE, FLAGS, LOCKED, next, prev, triangle_of, unflagged};
use crate::mesh::star::are_joined;
use crate::predicates::{Quad, area_sign, in_circle_filter, in_circle_sign};
use crate::{Dimension, NONE, Positions, Reason};
use std::array;
use std::ops::Range;

/// The result of testing an interior edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    Delaunay,
    /// Not Delaunay, and may not flip.
    Blocked(Reason),
    /// Not Delaunay, and may flip.
    Labelled,
}

/// For each triangle, the half-edge on the other side of its labelled edge with the smallest key. Without a labelled
/// edge: [`BLOCKED`] if an edge is blocked as a duplicate, otherwise [`NONE`].
pub(crate) fn label(geometry: &Geometry, mesh: Topology, iteration: u32) -> Vec<u32> {
    let best = |t: u32| {
        let mut choice = NONE;
        let mut smallest = u32::MAX;
        for h in 3 * t..3 * t + 3 {
            let g = mesh.twins[h as usize];
            if g >= LOCKED {
                // No twin, or a locked edge or a crease.
                continue;
            }
            match verdict(geometry, mesh, h) {
                Verdict::Labelled => {
                    let key = key(h.min(g), iteration);
                    if choice >= BLOCKED || key < smallest {
                        (choice, smallest) = (g, key);
                    }
                }
                Verdict::Blocked(Reason::Duplicate) if choice == NONE => choice = BLOCKED,
                _ => {}
            }
        }
        choice
    };
    (0..mesh.triangles.len() as u32 / 3).map(best).collect()
}

/// A quad by indices: an interior edge with its two triangles (a, b, c) and (b, a, d). `predicates::Quad`
/// has its points.
#[derive(Clone, Copy, Default)]
pub(crate) struct Diamond {
    /// The half-edge from a to b.
    pub(crate) h: u32,
    /// Its entry in the twins.
    pub(crate) twin: u32,
    /// a, b, c, d.
    pub(crate) vertices: [u32; 4],
}

impl Diamond {
    /// The diamond of half-edge `h`.
    #[inline(always)]
    pub(crate) fn new(mesh: Topology, h: u32) -> Self {
        let twin = mesh.twin(h);
        let vertices = [h, next(h), prev(h), prev(unflagged(twin))].map(|x| mesh.vertex(x));
        Self { h, twin, vertices }
    }

    /// Writes the diamonds of the edges between two triangles of `mesh` whose lower half-edge is in a triangle of
    /// `piece`. `piece` counts from the first triangle of `mesh`. Returns the number of diamonds. `diamonds` needs
    /// three slots per triangle.
    #[inline(always)]
    pub(crate) fn write(mesh: Topology, piece: Range<usize>, diamonds: &mut [Self]) -> usize {
        let [(triangles, _), (twins, _)] = [mesh.triangles, mesh.twins].map(|words| words.as_chunks::<3>());
        let first = mesh.first + 3 * piece.start as u32;
        let end = mesh.first + mesh.twins.len() as u32;
        let mut count = 0;
        let both = triangles[piece.clone()].iter().zip(&twins[piece]);
        for (h, (&[a, b, c], &[x, y, z])) in (first..).step_by(3).zip(both) {
            for (h, twin, vertices) in
                [(h, x, [a, b, c, 0]), (h + 1, y, [b, c, a, 0]), (h + 2, z, [c, a, b, 0])]
            {
                diamonds[count] = Self { h, twin, vertices };
                // Counts if h < twin < end. NONE is not below the end.
                count += usize::from((twin & !FLAGS).wrapping_sub(h + 1) < end - (h + 1));
            }
        }
        for diamond in &mut diamonds[..count] {
            diamond.vertices[3] = mesh.vertex(prev(diamond.twin & !FLAGS));
        }
        count
    }

    /// Writes the diamonds of the four edges around a flipped edge, except edges with only one triangle in `mesh`.
    /// Returns their number. Before the flip, the diamond had the vertices a, b, c and d; its triangles now are (a, d,
    /// c) and (b, c, d). `sides` are the half-edges from a, c, b and d, and `outer` are their twin entries.
    #[inline(always)]
    pub(crate) fn write_around(
        mesh: Topology,
        sides: [u32; 4],
        outer: [u32; 4],
        [a, b, c, d]: [u32; 4],
        diamonds: &mut [Self],
    ) -> usize {
        let triangles = [[a, d, c], [c, a, d], [b, c, d], [d, b, c]];
        let mut count = 0;
        for i in 0..4 {
            let (h, twin, [from, to, apex]) = (sides[i], outer[i], triangles[i]);
            let is_here = mesh.has(twin & !FLAGS);
            // A branch would be unpredictable.
            let g = if is_here { twin & !FLAGS } else { h };
            diamonds[count] = Self { h, twin, vertices: [from, to, apex, mesh.vertex(prev(g))] };
            count += usize::from(is_here);
        }
        count
    }
}

/// Tests the interior edge of half-edge `h`. The tests are exact, so both half-edges give the same result.
pub(crate) fn verdict(geometry: &Geometry, mesh: Topology, h: u32) -> Verdict {
    let diamond = Diamond::new(mesh, h);
    if keep_non_delaunay(geometry, &mut [diamond]) == 0 {
        return Verdict::Delaunay;
    }
    match verdict_of_shape(geometry, &diamond) {
        Verdict::Labelled if makes_duplicate(geometry, mesh, h) => Verdict::Blocked(Reason::Duplicate),
        verdict => verdict,
    }
}

/// Moves the edges that are not Delaunay to the front, in their order. Returns their number.
pub(crate) fn keep_non_delaunay(geometry: &Geometry, diamonds: &mut [Diamond]) -> usize {
    let mut finite = diamonds.len();
    if geometry.has_infinite {
        finite = keep(0, diamonds, 0, |diamond| is_finite(geometry, diamond.vertices));
    }
    let diamonds = &mut diamonds[..finite];
    match (geometry.dimension, geometry.positions) {
        (Dimension::Two, Positions::F32(numbers)) => {
            let fours = diamonds.len() / 4;
            let count = keep_in_fours(geometry, numbers, fours, diamonds);
            keep(4 * fours, diamonds, count, |diamond| is_non_delaunay_in_plane(geometry, diamond))
        }
        (Dimension::Two, Positions::F64(_)) => {
            keep(0, diamonds, 0, |diamond| is_non_delaunay_in_plane(geometry, diamond))
        }
        (Dimension::Three, positions) => {
            keep(0, diamonds, 0, |diamond| quad(positions, diamond).is_non_delaunay())
        }
    }
}

/// Whether all coordinates of these vertices are finite.
pub(crate) fn is_finite(geometry: &Geometry, vertices: [u32; 4]) -> bool {
    let stride = geometry.dimension.stride();
    let mut numbers = vertices.iter().flat_map(|&v| stride * v as usize..stride * (v as usize + 1));
    numbers.all(|i| geometry.positions.at(i).is_finite())
}

/// Moves the kept edges from index `first` on to the indices from `count` on. Returns the new count. A branch on
/// `is_kept` would be unpredictable.
#[inline(always)]
fn keep(
    first: usize,
    diamonds: &mut [Diamond],
    mut count: usize,
    is_kept: impl Fn(&Diamond) -> bool,
) -> usize {
    for i in first..diamonds.len() {
        let diamond = diamonds[i];
        diamonds[count] = diamond;
        count += usize::from(is_kept(&diamond));
    }
    count
}

/// As [`keep_non_delaunay`], in the plane, for 32-bit floats, four edges at a time.
#[inline(always)]
fn keep_in_fours(geometry: &Geometry, numbers: &[f32], fours: usize, diamonds: &mut [Diamond]) -> usize {
    let (points, _) = numbers.as_chunks();
    let mut count = 0;
    for i in 0..fours {
        let (all, _) = diamonds.as_chunks::<4>();
        let four = &all[i];
        let quads = array::from_fn(|lane| array::from_fn(|k| &points[four[lane].vertices[k] as usize]));
        let [negative, positive] = in_circle_filter(&quads);
        let clockwise = geometry.winding.bits(array::from_fn(|lane| triangle_of(four[lane].h)));
        let mut bits = negative & !clockwise | positive & clockwise;
        let mut undecided = !(negative | positive) & 0xf;
        while undecided != 0 {
            let lane = undecided.trailing_zeros();
            undecided &= undecided - 1;
            bits |= u32::from(is_non_delaunay_in_plane(geometry, &four[lane as usize])) << lane;
        }
        for lane in 0..4 {
            diamonds[count] = diamonds[4 * i + lane];
            count += (bits >> lane & 1) as usize;
        }
    }
    count
}

#[inline(never)]
fn is_non_delaunay_in_plane(geometry: &Geometry, diamond: &Diamond) -> bool {
    let [a, b, c, d] = geometry.positions.points2(diamond.vertices);
    in_circle_sign(a, b, c, d) == geometry.winding.positive(diamond.h / 3).reverse()
}

#[inline(always)]
fn quad(positions: &Positions, diamond: &Diamond) -> Quad {
    let [a, b, c, d] = positions.points3(diamond.vertices);
    Quad::new(a, b, c, d)
}

/// Whether an edge that is not Delaunay may flip, and why not, as far as its two triangles decide.
pub(crate) fn verdict_of_shape(geometry: &Geometry, diamond: &Diamond) -> Verdict {
    if diamond.twin & LOCKED != 0 {
        return Verdict::Blocked(Reason::Locked);
    }
    match geometry.dimension {
        // With two positive triangles, the angles at a and b sum to less than π, so both new triangles are positive.
        Dimension::Two if geometry.winding.is_strict => {}
        Dimension::Two => {
            let [a, b, c, d] = geometry.positions.points2(diamond.vertices);
            let positive = geometry.winding.positive(diamond.h / 3);
            if area_sign(a, d, c) != positive || area_sign(b, c, d) != positive {
                return Verdict::Blocked(Reason::Fold);
            }
        }
        Dimension::Three => {
            let quad = quad(geometry.positions, diamond);
            let Thresholds { cos, deviation } = geometry.thresholds;
            if diamond.twin & CREASE != 0 || quad.exceeds_angle(cos) {
                return Verdict::Blocked(Reason::Angle);
            }
            if quad.turns_over() {
                return Verdict::Blocked(Reason::Fold);
            }
            if deviation.is_finite() && quad.deviates(deviation.into()) {
                return Verdict::Blocked(Reason::Deviation);
            }
        }
    }
    Verdict::Labelled
}

/// Whether an edge between the opposite vertices c and d exists already, or c is d.
pub(crate) fn makes_duplicate(geometry: &Geometry, mesh: Topology, h: u32) -> bool {
    let [at_c, at_d] = [prev(h), prev(unflagged(mesh.twins[h as usize]))];
    let [c, d] = [at_c, at_d].map(|h| mesh.triangles[h as usize]);
    if geometry.embedded.at(c) || geometry.embedded.at(d) {
        return false;
    }
    are_joined(mesh.triangles, mesh.twins, mesh.fans, [at_c, at_d], u32::MAX)
}
