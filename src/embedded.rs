//! Stars in the plane that are embedded: the triangles at a vertex are positive and go round it once.
//!
//! An edge that may flip crosses its new edge c-d between the two, so at such a vertex c, or d, there is no other edge
//! c-d, and no other flip makes one: the star has one triangle in each direction. Flips of strictly convex quads leave
//! it so.

use crate::NONE;
use crate::adjacency::next;
use crate::mesh::{Dimension, Mesh};
use crate::predicates::area_sign;
use crate::winding::Winding;
use glam::DVec2;

/// How often the triangles at each vertex go across the direction of the x axis, twice standing for more, for an open
/// star and for one with a triangle that is not positive. Empty in 3D.
#[derive(Clone, Debug, Default)]
pub(crate) struct Embedded {
    turns: Vec<u8>,
}

impl Embedded {
    /// Of the vertices of a mesh with these twins.
    pub(crate) fn new(mesh: &Mesh, twins: &[u32], winding: &Winding) -> Self {
        if mesh.dimension() == Dimension::Three {
            return Self::default();
        }
        let mut turns = vec![0u8; mesh.vertex_count()];
        let mut turn = |v: u32, by: u8| turns[v as usize] = (turns[v as usize] + by).min(2);
        // Whether the edge from u to v goes to below the axis through u, or along it. Else the edge from v to u does.
        let goes_down = |u: DVec2, v: DVec2| (v.y < u.y) | ((v.y == u.y) & (v.x > u.x));
        let (triangles, _) = mesh.triangles().as_chunks();
        for (t, &[a, b, c]) in (0..).zip(triangles) {
            let [p, q, r] = mesh.positions().points2([a, b, c]);
            let is_clockwise = winding.is_clockwise(t);
            if !winding.is_strict && area_sign(p, q, r) != winding.positive(t) {
                for v in [a, b, c] {
                    turn(v, 2);
                }
                continue;
            }
            // At the corner between two edges that go down, a counter-clockwise triangle goes across; not all three do.
            let [first, second, third] =
                [(p, q), (q, r), (r, p)].map(|(u, v)| goes_down(u, v) != is_clockwise);
            let corner = if first & second {
                b
            } else if second & third {
                c
            } else {
                a
            };
            turn(corner, u8::from(first & second | second & third | third & first));
        }
        for h in (0..).zip(twins).filter(|&(_, &twin)| twin == NONE).map(|(h, _)| h) {
            turn(mesh.triangles()[h as usize], 2);
            turn(mesh.triangles()[next(h) as usize], 2);
        }
        Self { turns }
    }

    /// Whether the star of vertex `v` is known to be embedded.
    #[inline]
    pub(crate) fn at(&self, v: u32) -> bool {
        self.turns.get(v as usize) == Some(&1)
    }
}
