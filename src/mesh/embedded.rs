//! Embedded stars in the plane: the triangles at a vertex are positive and go round it once.
//!
//! The old edge of a flip crosses the new edge c-d. An embedded star has one triangle in each direction. So if the star
//! of c or d is embedded, it has no other edge c-d, and no other flip of the iteration makes one. Flips of strictly
//! convex quads keep stars embedded.

use crate::mesh::star::Fans;
use crate::mesh::winding::{Outline, Signs, Winding};
use crate::predicates::area_sign;
use crate::system::threads::Threads;
use crate::{Dimension, Mesh, NONE, Positions};
use glam::DVec2;
use std::cmp::Ordering;
use std::ops::Range;
use std::sync::atomic::{AtomicU8, Ordering::Relaxed};

/// How often the triangles at each vertex cross the direction of the x axis, capped at 2. An open star, and a star with
/// a triangle that is not positive, also has 2. Empty in 3D.
#[derive(Clone, Debug, Default)]
pub(crate) struct Embedded {
    turns: Vec<u8>,
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
        let mut turns = vec![0u8; vertices];
        let words: &mut [AtomicU8] = zerocopy::transmute_mut!(turns.as_mut_slice());
        let is_alone = threads.is_one();
        let turn = |v: u32, by: u8| {
            let word = &words[v as usize];
            if is_alone {
                word.store((word.load(Relaxed) + by).min(2), Relaxed);
            } else if by == 2 || by == 1 && word.swap(1, Relaxed) != 0 {
                // Each thread whose swap finds an earlier turn writes 2 after it. So the last write is a 2, whatever
                // other threads swap.
                word.store(2, Relaxed);
            }
        };
        let add = |piece| add_turns(shape, winding, has_infinite, piece, turn);
        let pieces = threads.map(shape.triangles.len() / 3, add);
        (pieces.into_iter().fold(Signs::default(), Signs::and), Self { turns })
    }

    /// The fans of the mesh. `twins` are its twins.
    pub(crate) fn fans(&self, mesh: &Mesh, twins: &[u32], threads: &Threads) -> Fans {
        let (vertices, triangles) = (mesh.vertex_count(), mesh.triangles());
        Fans::of_vertices(|v| !self.at(v), vertices, triangles, twins, threads)
    }

    /// Whether the star of vertex `v` is known to be embedded.
    #[inline]
    pub(crate) fn at(&self, v: u32) -> bool {
        self.turns.get(v as usize) == Some(&1)
    }
}

/// A mesh in the plane, between two iterations.
#[derive(Clone, Copy)]
pub(crate) struct Shape<'a> {
    pub(crate) positions: &'a Positions,
    pub(crate) triangles: &'a [u32],
    pub(crate) twins: &'a [u32],
}

/// The signs of a piece of the triangles. Calls `turn` with each vertex and the turns that a triangle adds to it.
fn add_turns(
    Shape { positions, triangles, twins }: Shape,
    winding: Option<&Winding>,
    has_infinite: bool,
    piece: Range<usize>,
    turn: impl Fn(u32, u8),
) -> Signs {
    let mut signs = Signs::default();
    // Whether v is below the horizontal line through u, or on this line to the right of u. Of an edge and its reverse,
    // exactly one goes down.
    let goes_down = |u: DVec2, v: DVec2| (v.y < u.y) | ((v.y == u.y) & (v.x > u.x));
    let (triangles, _) = triangles.as_chunks();
    let (sides, _) = twins.as_chunks::<3>();
    for t in piece {
        let [a, b, c] = triangles[t];
        for (twin, ends) in sides[t].iter().zip([[a, b], [b, c], [c, a]]) {
            if *twin == NONE {
                ends.into_iter().for_each(|v| turn(v, 2));
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
                turn(v, 2);
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
        turn(corner, u8::from(first & second | second & third | third & first));
    }
    signs
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroUsize;

    /// Sixteen triangles around the first vertex. The other vertices are on the boundary.
    #[test]
    fn a_star_that_goes_round_twice_is_not_embedded() {
        for (rounds, is_embedded) in [(1, true), (2, false), (4, false)] {
            let at = |i: u32| f64::from(i * rounds) * std::f64::consts::TAU / 16.0;
            let positions: Vec<f64> =
                [0.0; 2].into_iter().chain((0..16).flat_map(|i| [at(i).cos(), at(i).sin()])).collect();
            let triangles: Vec<u32> = (0..16).flat_map(|i| [0, i + 1, (i + 1) % 16 + 1]).collect();
            let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
            for threads in 1..=4 {
                let threads = Threads::new(NonZeroUsize::new(threads), usize::MAX).unwrap();
                let twins = crate::Adjacency::new(&mesh).twins;
                let (_, embedded) = Embedded::with_winding(&mesh, &twins, None, &mut None, &threads);
                assert_eq!(embedded.at(0), is_embedded);
                assert!((1..17).all(|v| !embedded.at(v)));
            }
        }
    }
}
