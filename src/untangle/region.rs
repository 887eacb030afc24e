//! What rounds do not lift: a region around a turned triangle grows until its border can be filled with positive
//! triangles. All vertices inside it leave. At the latest the region is the whole component, whose border any polygon
//! with holes can fill.

use super::sheet::{Loose, Sheet, Side};
use crate::NONE;
use crate::mesh::half_edge::{next, triangle_of};

/// If more than one triangle in so many of a component is turned over, the whole component is filled anew.
const FEW: u32 = 4;

/// The longest border that a region is filled within, unless it is a whole component.
const LONGEST: usize = 256;

/// The most triangles of a region before it becomes the whole component.
const LARGEST: usize = 1 << 14;

/// The same in a component whose border cannot be filled: it keeps turned triangles in any case.
const LARGEST_HOPELESS: usize = 1 << 8;

/// What the search for regions remembers.
pub(super) struct Search {
    /// For each triangle, the last turned triangle whose region had it.
    marks: Vec<u32>,
    /// The components whose border cannot be filled, sorted.
    hopeless: Vec<u32>,
}

impl Search {
    pub(super) fn new(triangles: usize) -> Self {
        Self { marks: vec![NONE; triangles], hopeless: Vec::new() }
    }
}

impl Sheet<'_> {
    /// Fills components with many turned triangles anew. Returns their slots.
    pub(super) fn fill_anew(&mut self, turned: &[u32]) -> Vec<u32> {
        let (components, sizes) = (self.components(), self.sizes());
        let mut counts = vec![0u32; sizes.len()];
        turned.iter().for_each(|&t| counts[components[t as usize] as usize] += 1);
        let is_bad = |t: &u32| {
            let component = components[*t as usize] as usize;
            counts[component] > sizes[component] / FEW
        };
        if !turned.iter().any(is_bad) {
            return Vec::new();
        }
        let mut bad: Vec<u32> = (0..components.len() as u32).filter(is_bad).collect();
        bad.sort_by_key(|&t| components[t as usize]);
        let mut slots = Vec::new();
        for region in bad.chunk_by(|&t, &u| components[t as usize] == components[u as usize]) {
            let is_inside = |t: u32| components[t as usize] == components[region[0] as usize];
            if self.refill(region, &is_inside, usize::MAX) {
                slots.extend_from_slice(region);
            }
        }
        slots
    }

    /// Fills a region around turned triangle `t`, if any can be filled.
    pub(super) fn grow(&mut self, t: u32, search: &mut Search) {
        let component = self.components()[t as usize];
        let (largest, place) = match search.hopeless.binary_search(&component) {
            // Nothing was found around it before.
            Ok(_) if search.marks[t as usize] != NONE => return,
            Ok(_) => (LARGEST_HOPELESS, None),
            Err(place) => (LARGEST, Some(place)),
        };
        let marks = &mut search.marks;
        let (mut region, mark) = (vec![t], t);
        marks[t as usize] = mark;
        let (mut ring, mut tried) = (0, 0);
        while ring < region.len() && region.len() <= largest {
            let end = region.len();
            for i in ring..end {
                for h in 3 * region[i]..3 * region[i] + 3 {
                    let across = self.twin(h);
                    if across != NONE && marks[triangle_of(across) as usize] != mark {
                        marks[triangle_of(across) as usize] = mark;
                        region.push(triangle_of(across));
                    }
                }
            }
            ring = end;
            // Regions that grow by a quarter between attempts keep the sum of all attempts small.
            if tried + tried / 4 < region.len() {
                if self.refill(&region, &|t| marks[t as usize] == mark, LONGEST) {
                    return;
                }
                tried = region.len();
            }
        }
        let Some(place) = place else { return };
        let components = self.components();
        let is_found = if ring == region.len() {
            self.refill(&region, &|t| marks[t as usize] == mark, usize::MAX)
        } else {
            let is_inside = |t: u32| components[t as usize] == component;
            let all = (0..components.len() as u32).filter(|&t| is_inside(t) && !self.is_empty(t));
            self.refill(&all.collect::<Vec<_>>(), &is_inside, usize::MAX)
        };
        if !is_found {
            search.hopeless.insert(place, component);
        }
    }

    /// Fills the border of a region, of at most `longest` sides, with positive triangles, and takes the vertices inside it
    /// out. Returns whether that is possible: else nothing changes.
    fn refill(&mut self, region: &[u32], is_inside: &dyn Fn(u32) -> bool, longest: usize) -> bool {
        let rings = self.rings(region, is_inside);
        let (count, holes) = (rings.iter().map(Vec::len).sum::<usize>(), rings.len());
        if !(3..=longest).contains(&count) {
            return false;
        }
        let mut border: Vec<_> = rings.iter().flatten().map(|side| side.vertex).collect();
        border.sort_unstable();
        let mut inner: Vec<_> = region.iter().flat_map(|&t| self.corners(t)).collect();
        inner.sort_unstable();
        inner.dedup();
        inner.retain(|v| border.binary_search(v).is_err());
        // By Euler's formula: else the region is no disc with holes.
        let is_planar = count + 2 * holes + 2 * inner.len() == region.len() + 4;
        if holes == 0 || !is_planar || inner.iter().any(|&v| self.is_pinned(v, region[0])) {
            return false;
        }
        let Some(filling) = self
            .filling(&rings, region[0])
            .filter(|filling| filling.triangles.len() + 2 * inner.len() == region.len())
        else {
            return false;
        };
        for h in region.iter().flat_map(|t| 3 * t..3 * t + 3) {
            if self.is_locked(h) && is_inside(triangle_of(self.twin(h))) {
                self.lose(h);
            }
        }
        let mut slots = region.to_vec();
        slots.sort_unstable();
        let near = self.put_filling(&filling, &slots);
        let free = slots[filling.triangles.len()..].chunks_exact(2);
        self.loose.extend(inner.into_iter().zip(free).map(|(vertex, slots)| Loose {
            vertex,
            slots: [slots[0], slots[1]],
            near,
        }));
        true
    }

    /// The rings of half-edges around a region.
    fn rings(&self, region: &[u32], is_inside: &dyn Fn(u32) -> bool) -> Vec<Vec<Side>> {
        let is_border = |h: u32| {
            let across = self.twin(h);
            across == NONE || !is_inside(triangle_of(across))
        };
        let mut border: Vec<_> =
            region.iter().flat_map(|&t| 3 * t..3 * t + 3).filter(|&h| is_border(h)).collect();
        border.sort_unstable();
        let mut is_visited = vec![false; border.len()];
        let mut rings = Vec::new();
        for i in 0..border.len() {
            let (mut h, mut ring) = (border[i], Vec::new());
            while let Ok(at) = border.binary_search(&h)
                && !std::mem::replace(&mut is_visited[at], true)
            {
                ring.push(Side { vertex: self.vertex(h), outer: self.twins[h as usize] });
                h = next(h);
                while !is_border(h) {
                    h = next(self.twin(h));
                }
            }
            if !ring.is_empty() {
                rings.push(ring);
            }
        }
        rings
    }
}
