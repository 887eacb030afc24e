//! A mesh in the plane whose edges are locked, and make way for others.

use crate::mesh::embedded::Embedded;
use crate::mesh::half_edge::{LOCKED, lock, next, prev, unflagged};
use crate::mesh::star::{Fans, Star};
use crate::predicates::area_sign;
use crate::system::threads::{Threads, shared};
use crate::{Adjacency, Mesh, NONE};
use std::cmp::Ordering;
use std::sync::OnceLock;
use std::sync::atomic::AtomicU32;

pub(super) struct State<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) triangles: Vec<u32>,
    /// With the flags of locked edges.
    twins: Vec<u32>,
    hubs: Vec<Hub>,
    /// The embedded stars. Constraints keep them embedded.
    pub(super) embedded: Embedded,
    /// Filled in at the first vertex that turns out to have several fans: most meshes have none.
    fans: OnceLock<Fans>,
}

/// What is known of a vertex.
#[derive(Clone, Default)]
struct Hub {
    /// A half-edge that starts there, if the vertex has triangles.
    corner: u32,
    /// The number of its triangles.
    degree: u32,
}

/// The triangles of a mesh, and how they are joined.
#[derive(Clone, Copy)]
pub(super) struct Links<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) triangles: &'a [AtomicU32],
    pub(super) twins: &'a [AtomicU32],
    /// The table of [`Fans`](crate::mesh::star::Fans).
    pub(super) fans: &'a [AtomicU32],
}

impl<'a> State<'a> {
    /// `locked`: both half-edges of each edge that may not flip.
    pub(super) fn new(mesh: &'a Mesh, locked: &[u32], threads: &Threads) -> Self {
        let (vertices, triangles) = (mesh.vertex_count(), mesh.triangles().to_vec());
        let mut twins = Adjacency::of_triangles(vertices, &triangles, threads).twins;
        let (_, embedded) = Embedded::with_winding(mesh, &twins, None, &mut None, threads);
        lock(&mut twins, locked);
        let hubs = vec![Hub::default(); vertices];
        let mut state = Self { mesh, triangles, twins, hubs, embedded, fans: OnceLock::new() };
        state.enter(0..mesh.triangle_count() as u32);
        state
    }

    /// Adds triangles to their vertices.
    pub(super) fn enter(&mut self, triangles: impl IntoIterator<Item = u32>) {
        for h in triangles.into_iter().flat_map(|t| 3 * t..3 * t + 3) {
            let hub = &mut self.hubs[self.triangles[h as usize] as usize];
            *hub = Hub { corner: h, degree: hub.degree + 1 };
        }
    }

    /// Removes triangles from their vertices. They may then make way for others.
    pub(super) fn leave(&mut self, triangles: impl IntoIterator<Item = u32>) {
        for h in triangles.into_iter().flat_map(|t| 3 * t..3 * t + 3) {
            self.hubs[self.triangles[h as usize] as usize].degree -= 1;
        }
    }

    /// What makes triangles of a region.
    pub(super) fn links(&mut self) -> Links<'_> {
        let fans = self.fans.get_mut().map(|fans| fans.table.as_mut_slice()).unwrap_or_default();
        Links {
            mesh: self.mesh,
            triangles: shared(&mut self.triangles),
            twins: shared(&mut self.twins),
            fans: shared(fans),
        }
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

    /// The triangles beside triangle `t`.
    pub(super) fn beside(&self, t: u32) -> impl Iterator<Item = u32> {
        (3 * t..3 * t + 3).map(|h| self.twin(h)).filter(|&twin| twin != NONE).map(|twin| twin / 3)
    }

    /// Locks both half-edges of an edge.
    pub(super) fn lock(&mut self, h: u32) {
        let twin = self.twin(h);
        let both = [h, twin];
        lock(&mut self.twins, if twin == NONE { &both[..1] } else { &both });
    }

    /// The number of triangles of a vertex.
    pub(super) fn degree(&self, v: u32) -> u32 {
        self.hubs[v as usize].degree
    }

    pub(super) fn is_used(&self, v: u32) -> bool {
        self.degree(v) > 0
    }

    /// The half-edges that start at a vertex that has triangles.
    pub(super) fn star(&self, v: u32) -> Star<'_> {
        let Hub { corner, degree } = self.hubs[v as usize];
        if self.fans.get().is_none() && Star::of_fan(&self.twins, corner).count() == degree as usize {
            return Star::of_fan(&self.twins, corner);
        }
        let fans =
            self.fans.get_or_init(|| Fans::new(self.mesh.vertex_count(), &self.triangles, &self.twins));
        Star::new(&self.triangles, &self.twins, fans, corner)
    }

    /// A half-edge of the edge between two vertices, of which the first has triangles.
    pub(super) fn half_edge(&self, [u, v]: [u32; 2]) -> Option<u32> {
        self.star(u).flat_map(|h| [h, prev(h)]).find(|&h| self.ends(h).contains(&v))
    }

    pub(super) fn sign(&self, corners: [u32; 3]) -> Ordering {
        area(self.mesh, corners)
    }
}

/// The sign of the area of a triangle.
pub(super) fn area(mesh: &Mesh, corners: [u32; 3]) -> Ordering {
    let [a, b, c] = corners.map(|v| mesh.point2(v));
    area_sign(a, b, c)
}
