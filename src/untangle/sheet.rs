//! A mesh in the plane during a repair: some vertices are out, and their triangles are empty slots.

use super::constant::Constant;
use super::divide::divide;
use crate::mesh::half_edge::{CREASE, FLAGS, LOCKED, next, prev, triangle_of, unflagged};
use crate::mesh::star::{Fans, Star};
use crate::mesh::winding::Winding;
use crate::predicates::{area_sign, in_circle_sign};
use crate::{Mesh, NONE};
use std::cmp::Ordering;
use std::mem;

/// Flag in the entry of a side: the rest is the index of the entry in [`Sheet::cuts`]. No edge in the plane is a crease.
pub(super) const CUT: u32 = CREASE;

/// A side of a ring around a hole in the mesh: the vertex that it starts at, and the entry in the twins of the triangle
/// that will fill the hole there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Side {
    pub(super) vertex: u32,
    pub(super) outer: u32,
}

/// A vertex that is out. A vertex inside a disc has two triangles of its own: the disc without it has two fewer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loose {
    pub(super) vertex: u32,
    pub(super) slots: [u32; 2],
    /// A slot near it.
    pub(super) near: u32,
}

/// A locked edge that the mesh does not have at present.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lost {
    pub(super) edge: [u32; 2],
    /// The component that had it; [`NONE`] if that was in an earlier repair.
    pub(super) component: u32,
}

pub(super) struct Sheet<'a> {
    pub(super) mesh: &'a Mesh,
    constant: &'a Constant,
    pub(super) winding: &'a Winding,
    /// An empty slot has the corners [`NONE`], a slot near it, and [`NONE`].
    pub(super) triangles: Vec<u32>,
    /// With the flags of locked edges.
    pub(super) twins: Vec<u32>,
    pub(super) loose: Vec<Loose>,
    /// Locked edges that the mesh does not have at present.
    pub(super) lost: Vec<Lost>,
    /// Slots whose corners or twins may have changed, once each.
    pub(super) touched: Vec<u32>,
    is_touched: Vec<bool>,
    /// For each side of a cut the half-edge of the triangle there, once it is known. Cuts have two sides each.
    pub(super) cuts: Vec<u32>,
}

impl<'a> Sheet<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        constant: &'a Constant,
        winding: &'a Winding,
        twins: &[u32],
        lost: Vec<[u32; 2]>,
    ) -> Self {
        let (triangles, twins) = (mesh.triangles().to_vec(), twins.to_vec());
        let is_touched = vec![false; mesh.triangle_count()];
        let lost = lost.into_iter().map(|edge| Lost { edge, component: NONE }).collect();
        let (loose, touched, cuts) = Default::default();
        Self { mesh, constant, winding, triangles, twins, loose, lost, touched, is_touched, cuts }
    }

    /// Whether a vertex of triangle `t` stays in its component.
    pub(super) fn is_pinned(&self, v: u32, t: u32) -> bool {
        self.constant.is_pinned(v, self.components()[t as usize])
    }

    /// The component of each triangle.
    pub(super) fn components(&self) -> &'a [u32] {
        self.constant.outline.components()
    }

    /// The number of triangles of each component.
    pub(super) fn sizes(&self) -> &'a [u32] {
        &self.constant.sizes
    }

    /// The fans, when no vertex is out.
    pub(super) fn fans(&self) -> Fans {
        if !self.constant.has_fans {
            return Fans::default();
        }
        Fans::new(self.mesh.vertex_count(), &self.triangles, &self.twins)
    }

    /// Notes that the mesh loses a locked edge.
    pub(super) fn lose(&mut self, h: u32) {
        let component = self.components()[triangle_of(h) as usize];
        self.lost.push(Lost { edge: [h, next(h)].map(|x| self.vertex(x)), component });
    }

    /// Looks for two edges that join the same vertices. Makes their components Delaunay, which may remove such edges; else
    /// takes their triangles of `before` back. `before` are the twins of the mesh.
    pub(super) fn undo_doubled(&mut self, before: &[u32]) {
        let (old, components) = (self.mesh.triangles(), self.components());
        let mut is_flipped: Vec<bool> = Vec::new();
        loop {
            let fans = self.fans();
            // A new edge is an edge of two touched triangles. Those of the boundary are as before, so their component has
            // nothing to take back.
            let is_new = |h: u32| h < self.twin(h) && self.twin(h) != NONE;
            let is_doubled = |&t: &u32| (3 * t..3 * t + 3).any(|h| is_new(h) && self.is_doubled(h, &fans));
            let doubled: Vec<u32> = self.touched.iter().copied().filter(is_doubled).collect();
            if doubled.is_empty() {
                return;
            }
            let count = self.sizes().len();
            is_flipped.resize(count, false);
            let (mut flips, mut is_undone) = (false, vec![false; count]);
            for t in doubled {
                let component = components[t as usize] as usize;
                flips |= !is_flipped[component];
                is_undone[component] = true;
            }
            let all = (0..components.len()).filter(|&t| is_undone[components[t] as usize]);
            if flips {
                let open = all.flat_map(|t| 3 * t as u32..3 * t as u32 + 3).collect();
                self.flip_all(open);
                (0..count).for_each(|component| is_flipped[component] |= is_undone[component]);
                continue;
            }
            for t in all {
                self.triangles[3 * t..3 * t + 3].copy_from_slice(&old[3 * t..3 * t + 3]);
                self.twins[3 * t..3 * t + 3].copy_from_slice(&before[3 * t..3 * t + 3]);
            }
            self.lost.retain(|lost| lost.component == NONE || !is_undone[lost.component as usize]);
        }
    }

    /// Whether other half-edges than its twin join the vertices of `h`, and not all of them are on the boundary.
    fn is_doubled(&self, h: u32, fans: &Fans) -> bool {
        let ends = [h, next(h)].map(|x| self.vertex(x));
        // The sides that each star has, and those of them with a twin. The shorter star decides: it ends the walk.
        let mut counts = [[0; 2]; 2];
        let mut stars = [h, next(h)].map(|corner| Star::new(&self.triangles, &self.twins, fans, corner));
        while let [Some(one), Some(other)] = stars.each_mut().map(Iterator::next) {
            for (end, corner) in [one, other].into_iter().enumerate() {
                for (x, far) in [(corner, next(corner)), (prev(corner), prev(corner))] {
                    if self.vertex(far) == ends[1 - end] {
                        counts[end][0] += 1;
                        counts[end][1] += u32::from(self.twin(x) != NONE);
                    }
                }
            }
        }
        ends[0] != ends[1]
            && counts.iter().any(|count| count[0] > 2)
            && counts.iter().any(|count| count[1] > 0)
    }

    pub(super) fn vertex(&self, h: u32) -> u32 {
        self.triangles[h as usize]
    }

    pub(super) fn corners(&self, t: u32) -> [u32; 3] {
        [3 * t, 3 * t + 1, 3 * t + 2].map(|h| self.vertex(h))
    }

    /// The half-edge on the other side, or [`NONE`].
    pub(super) fn twin(&self, h: u32) -> u32 {
        unflagged(self.twins[h as usize])
    }

    pub(super) fn is_locked(&self, h: u32) -> bool {
        let entry = self.twins[h as usize];
        entry != NONE && entry & LOCKED != 0
    }

    /// The sign of a triangle, reversed if the component of triangle `t` is clockwise.
    pub(super) fn sign(&self, t: u32, corners: [u32; 3]) -> Ordering {
        let [a, b, c] = self.mesh.positions().points2(corners);
        self.winding.relative(t, area_sign(a, b, c))
    }

    /// Whether slot `t` has a positive triangle, or is empty.
    pub(super) fn is_right(&self, t: u32) -> bool {
        self.is_empty(t) || self.sign(t, self.corners(t)).is_gt()
    }

    pub(super) fn is_empty(&self, t: u32) -> bool {
        self.vertex(3 * t) == NONE
    }

    /// A slot with a triangle near `slot`. A slot points to one that was not empty when it became so itself.
    pub(super) fn filled(&self, mut slot: u32) -> u32 {
        while self.is_empty(slot) {
            slot = self.vertex(3 * slot + 1);
        }
        slot
    }

    /// Lets two entries meet: each half-edge becomes the twin of the other. A locked edge stays locked.
    pub(super) fn join(&mut self, one: u32, other: u32) {
        for (side, inner) in [(one, other), (other, one)] {
            if side != NONE && side & CUT != 0 {
                let side = (side ^ CUT) as usize;
                self.cuts[side] = inner;
                let across = self.cuts[side ^ 1];
                if across != NONE {
                    self.join(inner, across);
                }
                return;
            }
        }
        let flags =
            [one, other].iter().fold(0, |all, &entry| if entry == NONE { all } else { all | entry & FLAGS });
        for (entry, twin) in [(one, other), (other, one)] {
            if entry != NONE {
                let twin = if twin == NONE { NONE } else { twin & !FLAGS | flags };
                self.twins[(entry & !FLAGS) as usize] = twin;
                self.touch(triangle_of(entry & !FLAGS));
            }
        }
    }

    /// Fills a ring with triangles, each from a corner k of the ring and its neighbours i and j at that time, as `ears`
    /// has them. `slots` has at least as many slots; the rest of them become empty. Returns a slot at the ring.
    pub(super) fn fill(&mut self, ring: &mut [Side], ears: &[[usize; 3]], slots: &[u32]) -> u32 {
        let mut last = [0, 1];
        for (&[i, k, j], &slot) in ears.iter().zip(slots) {
            let h = 3 * slot;
            for (n, corner) in [i, k, j].into_iter().enumerate() {
                self.triangles[h as usize + n] = ring[corner].vertex;
            }
            self.join(h, ring[i].outer);
            self.join(h + 1, ring[k].outer);
            ring[i].outer = h + 2;
            last = [i, j];
        }
        let near = match slots[..ears.len()] {
            [slot, ..] => slot,
            [] => triangle_of(unflagged(if ring[0].outer == NONE { ring[1].outer } else { ring[0].outer })),
        };
        let [one, other] = last.map(|i| ring[i].outer);
        self.join(one, other);
        for &slot in &slots[ears.len()..] {
            self.clear(slot, near);
        }
        near
    }

    fn touch(&mut self, slot: u32) {
        if !mem::replace(&mut self.is_touched[slot as usize], true) {
            self.touched.push(slot);
        }
    }

    pub(super) fn clear(&mut self, slot: u32, near: u32) {
        self.touch(slot);
        let h = 3 * slot as usize;
        self.triangles[h..h + 3].copy_from_slice(&[NONE, near, NONE]);
        self.twins[h..h + 3].fill(NONE);
    }

    /// Puts a vertex into triangle `t`, with two slots of its own, as [`divide`].
    pub(super) fn split(&mut self, t: u32, &Loose { vertex, slots: [s, u], .. }: &Loose) {
        for side in 3 * t..3 * t + 3 {
            if self.twin(side) != NONE {
                self.touch(triangle_of(self.twin(side)));
            }
        }
        for slot in [t, s, u] {
            self.touch(slot);
        }
        divide(&mut self.triangles, &mut self.twins, [t, s, u], vertex);
    }

    /// Flips the edge of `h`, which has two triangles (a, b, c) and (b, a, d); they become (a, d, c) and (b, c, d).
    pub(super) fn flip(&mut self, h: u32) {
        let g = self.twin(h);
        let [hn, gn] = [h, g].map(next);
        let [c, d] = [prev(h), prev(g)].map(|x| self.vertex(x));
        let outer = [gn, hn].map(|x| self.twins[x as usize]);
        self.triangles[hn as usize] = d;
        self.triangles[gn as usize] = c;
        self.join(h, outer[0]);
        self.join(g, outer[1]);
        self.join(hn, gn);
    }

    /// Flips edges that are not Delaunay and whose flips make positive triangles, first those of `open`.
    pub(super) fn flip_all(&mut self, mut open: Vec<u32>) {
        while let Some(h) = open.pop() {
            let g = self.twin(h);
            if g == NONE || self.is_locked(h) {
                continue;
            }
            let [a, b, c, d] =
                self.mesh.positions().points2([h, g, prev(h), prev(g)].map(|x| self.vertex(x)));
            let relative = |sign| self.winding.relative(triangle_of(h), sign);
            if relative(in_circle_sign(a, b, c, d)).is_lt()
                && relative(area_sign(a, d, c)).is_gt()
                && relative(area_sign(b, c, d)).is_gt()
            {
                self.flip(h);
                open.extend([h, prev(h), g, prev(g)]);
            }
        }
    }
}
