//! A mesh in the plane whose edges flip one by one.

use crate::mesh::half_edge::{FLAGS, LOCKED, lock, next, prev, unflagged};
use crate::mesh::star::{Fans, Star};
use crate::predicates::area_sign;
use crate::system::threads::Threads;
use crate::{Adjacency, Mesh, NONE};
use std::cmp::Ordering;

pub(super) struct State<'a> {
    mesh: &'a Mesh,
    pub(super) triangles: Vec<u32>,
    /// With the flags of locked edges.
    twins: Vec<u32>,
    fans: Fans,
    /// A half-edge that starts at each vertex; [`NONE`] if no triangle has the vertex.
    corners: Vec<u32>,
    pub(super) flips: u64,
}

impl<'a> State<'a> {
    /// `locked`: both half-edges of each edge that may not flip.
    pub(super) fn new(mesh: &'a Mesh, locked: &[u32]) -> Self {
        let (vertices, triangles) = (mesh.vertex_count(), mesh.triangles().to_vec());
        let mut twins = Adjacency::of_triangles(vertices, &triangles, &Threads::default()).twins;
        let fans = Fans::new(vertices, &triangles, &twins);
        lock(&mut twins, locked);
        let mut corners = vec![NONE; vertices];
        for (h, &v) in (0..).zip(&triangles) {
            corners[v as usize] = h;
        }
        Self { mesh, triangles, twins, fans, corners, flips: 0 }
    }

    pub(super) fn vertex(&self, h: u32) -> u32 {
        self.triangles[h as usize]
    }

    /// Both ends of a half-edge.
    pub(super) fn ends(&self, h: u32) -> [u32; 2] {
        [h, next(h)].map(|x| self.vertex(x))
    }

    /// The half-edge on the other side of an edge that has one.
    pub(super) fn twin(&self, h: u32) -> u32 {
        unflagged(self.twins[h as usize])
    }

    pub(super) fn is_locked(&self, h: u32) -> bool {
        let entry = self.twins[h as usize];
        entry != NONE && entry & LOCKED != 0
    }

    /// Locks both half-edges of an edge.
    pub(super) fn lock(&mut self, h: u32) {
        let twin = self.twin(h);
        let both = [h, twin];
        lock(&mut self.twins, if twin == NONE { &both[..1] } else { &both });
    }

    /// The half-edges that start at a vertex.
    pub(super) fn star(&self, v: u32) -> impl Iterator<Item = u32> {
        let corner = Some(self.corners[v as usize]).filter(|&corner| corner != NONE);
        corner.into_iter().flat_map(|corner| Star::new(&self.triangles, &self.twins, &self.fans, corner))
    }

    /// The sign of the area of a triangle.
    pub(super) fn sign(&self, corners: [u32; 3]) -> Ordering {
        let [a, b, c] = corners.map(|v| self.mesh.point2(v));
        area_sign(a, b, c)
    }

    /// The vertices a, b, c, d of the edge of `h`: its ends, and the third corners of its triangle and of the other.
    pub(super) fn diamond(&self, h: u32) -> [u32; 4] {
        let g = self.twin(h);
        [h, g, prev(h), prev(g)].map(|x| self.vertex(x))
    }

    /// Flips the edge of `h`, which has two triangles (a, b, c) and (b, a, d); they become (a, d, c) and (b, c, d). The
    /// half-edge after `h` becomes the new edge from d to c. Of the outer half-edges, the one after each of the two old
    /// ones moves to the index of the other old one.
    pub(super) fn flip(&mut self, h: u32) {
        self.flips += 1;
        let g = self.twin(h);
        let [a, b, c, d] = self.diamond(h);
        let [hn, gn] = [h, g].map(next);
        self.fans.move_anchor(b, hn, g);
        self.fans.move_anchor(a, gn, h);
        self.corners[a as usize] = h;
        self.corners[b as usize] = g;
        let outer = [gn, hn].map(|x| self.twins[x as usize]);
        for (inner, outer) in [h, g].into_iter().zip(outer) {
            self.twins[inner as usize] = outer;
            if outer != NONE {
                self.twins[(outer & !FLAGS) as usize] = inner | outer & FLAGS;
            }
        }
        self.triangles[hn as usize] = d;
        self.triangles[gn as usize] = c;
        self.twins[hn as usize] = gn;
        self.twins[gn as usize] = hn;
    }

    pub(super) fn mesh(&self) -> &Mesh {
        self.mesh
    }
}
