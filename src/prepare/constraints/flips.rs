//! Flips of single edges. Several threads may flip edges of different triangles; edges of triangles that share an edge
//! belong to one thread.

use crate::mesh::half_edge::{FLAGS, next, prev, unflagged};
use crate::mesh::star::move_anchor;
use crate::predicates::area_sign;
use crate::system::threads::Word;
use crate::{Mesh, NONE};
use std::cmp::Ordering;
use std::sync::atomic::AtomicU32;

#[derive(Clone, Copy)]
pub(super) struct Flips<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) triangles: &'a [AtomicU32],
    pub(super) twins: &'a [AtomicU32],
    /// The table of [`Fans`](crate::mesh::star::Fans).
    pub(super) fans: &'a [AtomicU32],
}

impl Flips<'_> {
    pub(super) fn vertex(&self, h: u32) -> u32 {
        self.triangles[h as usize].get()
    }

    /// The half-edge on the other side of an edge that has one.
    pub(super) fn twin(&self, h: u32) -> u32 {
        unflagged(self.twins[h as usize].get())
    }

    /// The vertices a, b, c, d of the edge of `h`: its ends, and the third corners of its triangle and of the other.
    pub(super) fn diamond(&self, h: u32) -> [u32; 4] {
        let g = self.twin(h);
        [h, g, prev(h), prev(g)].map(|x| self.vertex(x))
    }

    pub(super) fn sign(&self, corners: [u32; 3]) -> Ordering {
        sign(self.mesh, corners)
    }

    /// Flips the edge of `h`, which has two triangles (a, b, c) and (b, a, d); they become (a, d, c) and (b, c, d). The
    /// half-edge after `h` becomes the new edge from d to c. Of the outer half-edges, the one after each of the two old
    /// ones moves to the index of the other old one.
    pub(super) fn flip(&self, h: u32) {
        let g = self.twin(h);
        let [a, b, c, d] = self.diamond(h);
        let [hn, gn] = [h, g].map(next);
        move_anchor(self.fans, b, hn, g);
        move_anchor(self.fans, a, gn, h);
        self.move_twins([gn, hn], [h, g]);
        self.triangles[hn as usize].set(d);
        self.triangles[gn as usize].set(c);
        self.twins[hn as usize].set(gn);
        self.twins[gn as usize].set(hn);
    }

    /// Undoes the last flip, that of the edge of `h`.
    pub(super) fn undo(&self, h: u32) {
        let hn = next(h);
        let gn = self.twin(hn);
        let g = prev(gn);
        let [a, b, c, d] = [h, g, gn, hn].map(|x| self.vertex(x));
        move_anchor(self.fans, d, hn, prev(g));
        move_anchor(self.fans, c, gn, prev(h));
        self.move_twins([h, g], [gn, hn]);
        self.triangles[hn as usize].set(b);
        self.triangles[gn as usize].set(a);
        self.twins[h as usize].set(g);
        self.twins[g as usize].set(h);
    }

    /// Moves the outer sides of two half-edges to two others.
    fn move_twins(&self, from: [u32; 2], to: [u32; 2]) {
        let outer = from.map(|x| self.twins[x as usize].get());
        for (inner, outer) in to.into_iter().zip(outer) {
            self.twins[inner as usize].set(outer);
            if outer != NONE {
                self.twins[(outer & !FLAGS) as usize].set(inner | outer & FLAGS);
            }
        }
    }
}

/// The sign of the area of a triangle.
pub(super) fn sign(mesh: &Mesh, corners: [u32; 3]) -> Ordering {
    let [a, b, c] = corners.map(|v| mesh.point2(v));
    area_sign(a, b, c)
}
