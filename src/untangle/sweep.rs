//! Fills the border of a region with triangles, as Hertel and Mehlhorn do: a line sweeps over it from left to right. The
//! region to the left of the line is filled, but for a chain of vertices in each of the gaps through which the line goes.
//!
//! A border is filled right if all triangles are positive, however they were found: they then cover each point as often
//! as the border goes round it. So the sweep only has to find them where the border does not cross itself. It may touch
//! itself in common vertices, and along sides of both directions.

use super::sheet::{CUT, Sheet, Side};
use super::status::Status;
use crate::NONE;
use crate::mesh::half_edge::{next, triangle_of};
use std::cmp::Ordering;

/// What is on the other side of an edge of a new triangle.
#[derive(Clone, Copy, Debug)]
enum Across {
    /// An entry in the twins, as in [`Side`].
    Outer(u32),
    /// A half-edge of a new triangle: they are counted from 0.
    New(u32),
    /// A side of a cut: an edge that has no triangle yet on either side.
    Cut(u32),
}

/// Triangles that fill a border.
#[derive(Default)]
pub(super) struct Filling {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Half-edges of these triangles, or sides of cuts, and what is on the other side.
    joins: Vec<[Across; 2]>,
    cuts: u32,
}

/// A vertex of a chain.
#[derive(Clone, Copy)]
struct Link {
    vertex: u32,
    below: u32,
    above: u32,
    /// What is across the edge to the link above.
    across: Across,
}

/// A side that the line crosses, from left to right.
#[derive(Clone, Copy)]
struct Crossing {
    left: u32,
    right: u32,
    across: Across,
    /// The corners of the border at its ends.
    corners: [u32; 2],
    /// Whether the region is above it: whether the side leads from left to right.
    is_lower: bool,
}

/// A part of the line in the region. Between it and what is filled is a chain, from the left end of the side below to
/// that of the side above. It turns left at each vertex, so its last vertex in the order sees each point of the gap.
#[derive(Clone, Copy)]
struct Gap {
    lower: Crossing,
    upper: Crossing,
    bottom: u32,
    top: u32,
    last: u32,
}

struct Sweep<'a> {
    sheet: &'a Sheet<'a>,
    /// A triangle of the component.
    t: u32,
    links: Vec<Link>,
    gaps: Status<Gap>,
    filling: Filling,
}

impl Sheet<'_> {
    /// Fills a border, whose rings all have the region on their left. `None` if the sweep ends before, or a triangle were
    /// not positive.
    pub(super) fn filling(&self, rings: &[Vec<Side>], t: u32) -> Option<Filling> {
        let mut vertices: Vec<u32> = rings.iter().flatten().map(|side| side.vertex).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut rank = vec![0; vertices.len()];
        let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
        order.sort_unstable_by(|&i, &k| self.compare(t, [i, k].map(|i| vertices[i as usize])));
        if order
            .windows(2)
            .any(|pair| self.compare(t, [pair[0], pair[1]].map(|i| vertices[i as usize])).is_eq())
        {
            return None;
        }
        (0..).zip(&order).for_each(|(place, &i)| rank[i as usize] = place);
        let place = |v: u32| vertices.binary_search(&v).map_or(0, |i| rank[i]);
        let mut starts: Vec<(u32, Crossing)> = Vec::new();
        let mut ends = vec![0u32; vertices.len()];
        for ring in rings {
            let first = starts.len();
            for (i, side) in ring.iter().enumerate() {
                let after = (i + 1) % ring.len();
                let (from, to) = (side.vertex, ring[after].vertex);
                let [mut ends_at, mut corners] = [[from, to], [first + i, first + after].map(|x| x as u32)];
                let is_lower = place(from) < place(to);
                if !is_lower {
                    ends_at.reverse();
                    corners.reverse();
                }
                let [left, right] = ends_at;
                let across = Across::Outer(side.outer);
                starts.push((place(left), Crossing { left, right, across, corners, is_lower }));
                ends[place(right) as usize] += 1;
            }
        }
        starts.sort_unstable_by(|(p, one), (q, other)| {
            let turn = || self.sign(t, [one.left, other.right, one.right]);
            p.cmp(q).then_with(turn).then(one.is_lower.cmp(&other.is_lower))
        });
        let mut sweep =
            Sweep { sheet: self, t, links: Vec::new(), gaps: Status::new(), filling: Filling::default() };
        let mut rest = &starts[..];
        for (place, &i) in (0..).zip(&order) {
            let count = rest.partition_point(|&(p, _)| p == place);
            sweep.pass(vertices[i as usize], &rest[..count], ends[place as usize])?;
            rest = &rest[count..];
        }
        Some(sweep.filling)
    }

    /// The order of the vertices from left to right, and upwards, where positive triangles turn left.
    fn compare(&self, t: u32, ends: [u32; 2]) -> Ordering {
        let [p, q] = self.mesh.positions().points2(ends).map(|point| point + glam::DVec2::ZERO);
        p.x.total_cmp(&q.x).then(self.winding.relative(t, p.y.total_cmp(&q.y)))
    }

    /// Fills a border. `slots` are at least as many as the triangles; the rest become empty. Returns a slot at the border.
    pub(super) fn put_filling(&mut self, Filling { triangles, joins, cuts }: &Filling, slots: &[u32]) -> u32 {
        let first = self.cuts.len() as u32;
        self.cuts.resize((first + cuts) as usize, NONE);
        for (corners, &slot) in triangles.iter().zip(slots) {
            self.triangles[3 * slot as usize..3 * slot as usize + 3].copy_from_slice(corners);
        }
        let entry = |across: &Across| match *across {
            Across::Outer(entry) => entry,
            Across::New(h) => 3 * slots[triangle_of(h) as usize] + h % 3,
            Across::Cut(cut) => (first + cut) | CUT,
        };
        for [one, other] in joins {
            self.join(entry(one), entry(other));
        }
        for &slot in &slots[triangles.len()..] {
            self.clear(slot, slots[0]);
        }
        slots[0]
    }
}

impl Filling {
    /// The pairs of vertices that new edges inside the border join.
    pub(super) fn chords(&self) -> impl Iterator<Item = [u32; 2]> {
        let vertex = |h: u32| self.triangles[triangle_of(h) as usize][h as usize % 3];
        self.joins.iter().filter_map(move |join| match *join {
            [Across::New(h), Across::New(_) | Across::Cut(_)] => Some([h, next(h)].map(vertex)),
            _ => None,
        })
    }
}

impl Sweep<'_> {
    /// Passes a vertex, at which these sides start, and `ends` sides end. Each part of the region around it has to belong
    /// to one corner of the border.
    fn pass(&mut self, v: u32, starts: &[(u32, Crossing)], ends: u32) -> Option<()> {
        let (sheet, t) = (self.sheet, self.t);
        let side = |side: &Crossing| sheet.sign(t, [side.left, side.right, v]);
        let mut at = self.gaps.find(|gap| side(&gap.lower).is_gt());
        let mut left = ends;
        // The gaps below and above the vertex, each with its corner there.
        let (mut low, mut high) = (None, None);
        if let Some(gap) = self.gaps.before(at).copied() {
            if gap.upper.right == v {
                self.gaps.take_before(&mut at);
                left = left.checked_sub(1)?;
                low = Some((self.with_top(gap, v, gap.upper.across), gap.upper.corners[1]));
            } else if side(&gap.upper).is_lt() && ends == 0 {
                self.gaps.take_before(&mut at);
                let [(_, first), (_, last)] = [starts.first()?, starts.last()?];
                let [under, over] = self.split(gap, v);
                (low, high) = (Some((under, last.corners[0])), Some((over, first.corners[0])));
            } else if side(&gap.upper).is_le() {
                return None;
            }
        }
        while let Some(gap) = self.gaps.at(at).copied()
            && side(&gap.lower).is_eq()
        {
            if gap.lower.right != v || high.is_some() {
                return None;
            }
            self.gaps.take(&mut at);
            left = left.checked_sub(1)?;
            let [lower, upper] = [gap.lower, gap.upper].map(|side| side.corners[1]);
            if gap.upper.right == v {
                left = left.checked_sub(1)?;
                self.close(gap, v).filter(|()| lower == upper)?;
            } else {
                high = Some((self.with_bottom(gap, v, gap.lower.across), lower));
            }
        }
        if left > 0 {
            return None;
        }
        let mut gaps: Vec<Gap> = Vec::with_capacity(starts.len());
        let mut open = low;
        for &(_, side) in starts {
            let corner = side.corners[0];
            match open.take() {
                Some((gap, expected)) if !side.is_lower && corner == expected => {
                    gaps.push(Gap { upper: side, ..gap });
                }
                None if side.is_lower => {
                    let link = self.link(v);
                    let gap = Gap { lower: side, upper: side, bottom: link, top: link, last: link };
                    open = Some((gap, corner));
                }
                _ => return None,
            }
        }
        match (open, high) {
            (None, None) => {}
            (Some((low, corner)), Some((high, expected))) if corner == expected => {
                gaps.push(if starts.is_empty() {
                    self.merge(low, high)
                } else {
                    Gap { lower: low.lower, ..high }
                });
            }
            _ => return None,
        }
        self.gaps.insert(at, gaps);
        Some(())
    }

    fn link(&mut self, vertex: u32) -> u32 {
        self.links.push(Link { vertex, below: NONE, above: NONE, across: Across::Outer(NONE) });
        self.links.len() as u32 - 1
    }

    /// Lets one link follow another, with an edge between them.
    fn tie(&mut self, below: u32, above: u32, across: Across) {
        (self.links[below as usize].above, self.links[below as usize].across) = (above, across);
        self.links[above as usize].below = below;
    }

    fn is_positive(&self, corners: [u32; 3]) -> bool {
        self.sheet.sign(self.t, corners.map(|link| self.links[link as usize].vertex)).is_gt()
    }

    /// Adds a triangle of a link p, a new one and the link q above p. Returns its half-edges without the one from q to p.
    fn add(&mut self, [p, new, q]: [u32; 3]) -> [Across; 2] {
        let h = 3 * self.filling.triangles.len() as u32;
        self.filling.triangles.push([p, new, q].map(|link| self.links[link as usize].vertex));
        self.filling.joins.push([Across::New(h + 2), self.links[p as usize].across]);
        [Across::New(h), Across::New(h + 1)]
    }

    /// Puts a vertex above a chain.
    fn with_top(&mut self, gap: Gap, v: u32, mut across: Across) -> Gap {
        let new = self.link(v);
        let mut q = gap.top;
        loop {
            let p = self.links[q as usize].below;
            if p == NONE || !self.is_positive([p, new, q]) {
                break;
            }
            let [under, over] = self.add([p, new, q]);
            self.filling.joins.push([over, across]);
            (across, q) = (under, p);
        }
        self.tie(q, new, across);
        Gap { top: new, last: new, ..gap }
    }

    /// Puts a vertex below a chain.
    fn with_bottom(&mut self, gap: Gap, v: u32, mut across: Across) -> Gap {
        let new = self.link(v);
        let mut p = gap.bottom;
        loop {
            let q = self.links[p as usize].above;
            if q == NONE || !self.is_positive([p, new, q]) {
                break;
            }
            let [under, over] = self.add([p, new, q]);
            self.filling.joins.push([under, across]);
            (across, p) = (over, q);
        }
        self.links[p as usize].below = NONE;
        self.tie(new, p, across);
        Gap { bottom: new, last: new, ..gap }
    }

    /// Fills a gap whose sides end at a vertex.
    fn close(&mut self, gap: Gap, v: u32) -> Option<()> {
        let filled = self.with_bottom(gap, v, gap.lower.across);
        if self.links[filled.bottom as usize].above != filled.top {
            return None;
        }
        self.filling.joins.push([self.links[filled.bottom as usize].across, gap.upper.across]);
        Some(())
    }

    /// Splits a gap at a vertex inside.
    fn split(&mut self, gap: Gap, v: u32) -> [Gap; 2] {
        let last = gap.last;
        let Link { vertex, above, across, .. } = self.links[last as usize];
        let copy = self.link(vertex);
        let mut top = gap.top;
        if above == NONE {
            top = copy;
        } else {
            self.tie(copy, above, across);
        }
        self.links[last as usize].above = NONE;
        let cut = self.filling.cuts;
        self.filling.cuts += 2;
        let low = self.with_top(Gap { top: last, ..gap }, v, Across::Cut(cut));
        [low, self.with_bottom(Gap { bottom: copy, top, ..gap }, v, Across::Cut(cut + 1))]
    }

    /// Joins two gaps with a common vertex between them.
    fn merge(&mut self, low: Gap, high: Gap) -> Gap {
        let Link { above, across, .. } = self.links[high.bottom as usize];
        let top = if above == NONE { low.top } else { high.top };
        if above != NONE {
            self.tie(low.top, above, across);
        }
        Gap { lower: low.lower, upper: high.upper, bottom: low.bottom, top, last: low.top }
    }
}
