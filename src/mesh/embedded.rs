//! Embedded stars in the plane: the triangles at a vertex are positive and do not overlap.
//!
//! The old edge of a flip crosses the new edge c-d. An embedded star has at most one triangle in each direction. So if
//! the star of c or d is embedded, it has no other edge c-d, and no other flip of the iteration makes one. Flips of
//! strictly convex quads keep stars embedded.
//!
//! Counting proves it. The triangles of a closed fan cross the direction of the x axis once for each time that they go
//! round. An open fan that does not cross it goes less than once round, and one boundary half-edge starts at its vertex.
//! So a star of positive triangles is embedded if these crossings and half-edges are one: it is one fan of either kind.

use crate::mesh::star::Fans;
use crate::mesh::winding::{Outline, Signs, Winding};
use crate::predicates::area_sign;
use crate::system::threads::Threads;
use crate::{Dimension, Mesh, NONE, Positions};
use glam::DVec2;
use std::cmp::Ordering;
use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// The crossings and boundary half-edges of each vertex, capped at 2. A star with a triangle that is not positive also
/// has 2. Empty in 3D.
#[derive(Clone, Debug, Default)]
pub(crate) struct Embedded {
    counts: Vec<u8>,
}

impl Embedded {
    /// The winding of a mesh with these twins, and its embedded stars. A right guess, such as the winding of earlier
    /// positions, saves time. Fills in the outline if it is needed.
    pub(crate) fn with_winding(
        mesh: &Mesh,
        twins: &[u32],
        mut guess: Option<Winding>,
        outline: &mut Option<Outline>,
        threads: &Threads,
    ) -> (Winding, Self) {
        if mesh.dimension() == Dimension::Three {
            return Default::default();
        }
        let triangles = mesh.triangle_count();
        loop {
            let shape = Shape { positions: mesh.positions(), triangles: mesh.triangles(), twins };
            let (signs, embedded) =
                Self::of_triangles(shape, mesh.vertex_count(), guess.as_ref(), false, threads);
            let by_signs = signs.winding(triangles);
            // Without a guess, each triangle counted by its own sign.
            let is_alike = guess.is_none() && by_signs.is_some();
            let winding = by_signs.unwrap_or_else(|| {
                outline.get_or_insert_with(|| Outline::new(mesh.triangles(), twins)).winding(mesh)
            });
            if is_alike || guess.is_some_and(|guess| guess.equals(&winding, triangles)) {
                return (winding, embedded);
            }
            guess = Some(winding);
        }
    }

    /// The signs of the triangles, and the embedded stars. Without a `winding`, each triangle counts as
    /// counter-clockwise or clockwise by its own sign. A triangle with a number that is not finite counts as flat;
    /// `has_infinite`: whether there may be one.
    pub(crate) fn of_triangles(
        shape: Shape,
        vertices: usize,
        winding: Option<&Winding>,
        has_infinite: bool,
        threads: &Threads,
    ) -> (Signs, Self) {
        let mut counts = vec![0u8; vertices];
        let words: &mut [AtomicU8] = zerocopy::transmute_mut!(counts.as_mut_slice());
        let is_alone = threads.is_one();
        let count = |v: u32, by: u8| {
            let word = &words[v as usize];
            if is_alone {
                word.store((word.load(Relaxed) + by).min(2), Relaxed);
            } else if by == 2 || by == 1 && word.swap(1, Relaxed) != 0 {
                // Each thread whose swap finds an earlier count writes 2 after it. So the last write is a 2, whatever
                // other threads swap.
                word.store(2, Relaxed);
            }
        };
        let add = |piece| add_counts(shape, winding, has_infinite, piece, count);
        let pieces = threads.map(shape.triangles.len() / 3, add);
        (pieces.into_iter().fold(Signs::default(), Signs::and), Self { counts })
    }

    /// The fans of the mesh. `twins` are its twins.
    pub(crate) fn fans(&self, mesh: &Mesh, twins: &[u32], threads: &Threads) -> Fans {
        let (vertices, triangles) = (mesh.vertex_count(), mesh.triangles());
        Fans::of_vertices(|v| !self.at(v), vertices, triangles, twins, threads)
    }

    /// Whether the star of vertex `v` is known to be embedded.
    #[inline]
    pub(crate) fn at(&self, v: u32) -> bool {
        self.counts.get(v as usize) == Some(&1)
    }
}

/// A mesh in the plane, between two iterations.
#[derive(Clone, Copy)]
pub(crate) struct Shape<'a> {
    pub(crate) positions: &'a Positions,
    pub(crate) triangles: &'a [u32],
    pub(crate) twins: &'a [u32],
}

/// The signs of a piece of the triangles. Calls `count` with each vertex and what a triangle adds to it.
fn add_counts(
    Shape { positions, triangles, twins }: Shape,
    winding: Option<&Winding>,
    has_infinite: bool,
    piece: Range<usize>,
    count: impl Fn(u32, u8),
) -> Signs {
    let mut signs = Signs::default();
    // Whether v is below the horizontal line through u, or on this line to the right of u. Of an edge and its reverse,
    // exactly one goes down.
    let goes_down = |u: DVec2, v: DVec2| (v.y < u.y) | ((v.y == u.y) & (v.x > u.x));
    let (triangles, _) = triangles.as_chunks();
    let (sides, _) = twins.as_chunks::<3>();
    for t in piece {
        let [a, b, c] = triangles[t];
        for (twin, v) in sides[t].iter().zip([a, b, c]) {
            if *twin == NONE {
                count(v, 1);
            }
        }
        let [p, q, r] = positions.points2([a, b, c]);
        let is_finite = !has_infinite || [p, q, r].iter().all(|point| point.is_finite());
        let sign = if is_finite { area_sign(p, q, r) } else { Ordering::Equal };
        let is_clockwise = winding.map_or(sign.is_lt(), |winding| winding.is_clockwise(t as u32));
        let is_positive = sign == if is_clockwise { Ordering::Less } else { Ordering::Greater };
        signs.add(sign, is_positive);
        if !is_positive {
            for v in [a, b, c] {
                count(v, 2);
            }
            continue;
        }
        // A counter-clockwise triangle crosses the axis at the corner between two edges that go down. Never all three
        // do.
        let [first, second, third] = [(p, q), (q, r), (r, p)].map(|(u, v)| goes_down(u, v) != is_clockwise);
        let corner = if first & second {
            b
        } else if second & third {
            c
        } else {
            a
        };
        count(corner, u8::from(first & second | second & third | third & first));
    }
    signs
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroUsize;

    /// Triangles around the first vertex, an eighth of a round each: `count` from direction `first` on. The last one
    /// meets the first if the fan is closed.
    fn round_one_vertex(first: u32, count: u32, is_closed: bool, is_clockwise: bool) -> Mesh {
        let directions = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
        let ends = if is_closed { count } else { count + 1 };
        let points = (0..ends).map(|i| directions[((first + i) % 8) as usize]);
        let points = points.map(|[x, y]| if is_clockwise { [x, -y] } else { [x, y] });
        let positions: Vec<f64> = [[0, 0]].into_iter().chain(points).flatten().map(f64::from).collect();
        let triangle = |i: u32| [0, 1 + i, 1 + (i + 1) % ends];
        Mesh::new(Dimension::Two, positions, (0..count).flat_map(triangle).collect()).unwrap()
    }

    fn embedded(mesh: &Mesh, threads: usize) -> Embedded {
        let threads = Threads::new(NonZeroUsize::new(threads), usize::MAX).unwrap();
        Embedded::with_winding(mesh, &crate::Adjacency::new(mesh).twins, None, &mut None, &threads).1
    }

    #[test]
    fn a_star_is_embedded_if_it_goes_round_once_at_most() {
        for (first, is_clockwise) in (0..8).flat_map(|first| [(first, false), (first, true)]) {
            for threads in 1..=4 {
                for rounds in 1..4 {
                    let mesh = round_one_vertex(first, 8 * rounds, true, is_clockwise);
                    assert_eq!(embedded(&mesh, threads).at(0), rounds == 1);
                }
                let at =
                    |count| embedded(&round_one_vertex(first, count, false, is_clockwise), threads).at(0);
                assert!((8..25).all(|count| !at(count)), "an open fan that overlaps itself");
                // It is not found if the open fan crosses the direction of the x axis.
                let most = (1..8).filter(|&count| at(count)).count() as u32;
                assert!(most + 1 >= (8 - first) % 8 && most <= 7, "{first} {most}");
            }
        }
    }

    #[test]
    fn a_star_of_two_fans_is_not_embedded() {
        let directions = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        let positions = [[0.0; 2]].into_iter().chain(directions).flatten().collect::<Vec<f64>>();
        let mesh = Mesh::new(Dimension::Two, positions, vec![0, 1, 2, 0, 3, 4]).unwrap();
        let embedded = embedded(&mesh, 1);
        // An edge at vertex 3 has the direction of the axis.
        assert_eq!([0, 1, 2, 3, 4].map(|v| embedded.at(v)), [false, true, true, false, true]);
    }
}
