//! The star of a vertex: the triangles around it. A star consists of fans: runs of triangles joined by twins, open at
//! the boundary or closed. A flip neither joins nor splits fans, so the number of fans of each vertex never changes.

use crate::NONE;
use crate::mesh::half_edge::{next, prev, unflagged};
use crate::system::threads::{Threads, Word, shared};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// The anchors of the vertices that have several fans. An anchor is a half-edge that starts at the vertex, one for each
/// fan. The table has a word for each vertex: [`NONE`], or the index in the table of its list of anchors, which ends
/// with [`NONE`]. If every vertex has one fan, the table is empty: any half-edge that starts at a vertex is an anchor
/// of its fan.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Fans {
    pub(crate) table: Vec<u32>,
}

impl Fans {
    /// Walks every fan of the mesh once.
    pub(crate) fn new(vertices: usize, triangles: &[u32], twins: &[u32]) -> Self {
        Self::of_corners(&mut (0..triangles.len() as u32), vertices, triangles, twins)
    }

    /// Walks one fan of each vertex that `may` have several, and all fans of each vertex that has several.
    pub(crate) fn of_vertices(
        may: impl Fn(u32) -> bool + Sync,
        vertices: usize,
        triangles: &[u32],
        twins: &[u32],
        threads: &Threads,
    ) -> Self {
        let mut lengths = threads.zeros(vertices);
        let words = shared(&mut lengths);
        let is_alone = threads.is_one();
        let unvisited = threads.map(triangles.len(), |piece| {
            let mut count = 0u32;
            for h in piece {
                let v = triangles[h];
                if !may(v) {
                    continue;
                }
                count = count.wrapping_add(1);
                let word = &words[v as usize];
                if word.get() == 0 && (is_alone || word.compare_exchange(0, 1, Relaxed, Relaxed).is_ok()) {
                    let length = Star::of_fan(twins, h as u32).count() as u32;
                    word.set(length);
                    count = count.wrapping_sub(length);
                }
            }
            count
        });
        if unvisited.into_iter().fold(0, u32::wrapping_add) == 0 {
            return Self::default();
        }
        // Subtracts every corner from the length of the fan that was walked. A vertex whose length does not become 0
        // has further fans.
        for &v in triangles {
            lengths[v as usize] = lengths[v as usize].wrapping_sub(1);
        }
        let has_several = |v: u32| may(v) && lengths[v as usize] != 0;
        let mut corners = (0..triangles.len() as u32).filter(|&h| has_several(triangles[h as usize]));
        Self::of_corners(&mut corners, vertices, triangles, twins)
    }

    /// Walks the fans of some vertices. `corners` are all half-edges that start at them, in ascending order. Every
    /// other vertex has one fan.
    fn of_corners(
        corners: &mut dyn Iterator<Item = u32>,
        vertices: usize,
        triangles: &[u32],
        twins: &[u32],
    ) -> Self {
        let mut first = vec![NONE; vertices];
        let mut visited = vec![false; triangles.len()];
        let mut further = Vec::new();
        for h in corners {
            let v = triangles[h as usize];
            if visited[h as usize] {
                continue;
            }
            for corner in Star::of_fan(twins, h) {
                visited[corner as usize] = true;
            }
            if first[v as usize] == NONE {
                first[v as usize] = h;
            } else {
                further.push((v, h));
            }
        }
        if further.is_empty() {
            return Self::default();
        }
        further.sort_unstable();
        let mut table = vec![NONE; vertices];
        for fans in further.chunk_by(|x, y| x.0 == y.0) {
            let v = fans[0].0 as usize;
            table[v] = table.len() as u32;
            table.push(first[v]);
            table.extend(fans.iter().map(|&(_, h)| h));
            table.push(NONE);
        }
        Self { table }
    }

    /// The rest of the table from the first anchor of a vertex; `None` if the vertex has one fan.
    #[inline]
    fn of(&self, vertex: u32) -> Option<&[u32]> {
        let list = self.table.get(vertex as usize).copied().unwrap_or(NONE);
        (list != NONE).then(|| &self.table[list as usize..])
    }

    /// Whether a vertex has several fans.
    #[inline]
    pub(crate) fn has_several(&self, vertex: u32) -> bool {
        self.of(vertex).is_some()
    }

    /// As [`move_anchor`].
    pub(crate) fn move_anchor(&mut self, vertex: u32, from: u32, to: u32) {
        move_anchor(shared(&mut self.table), vertex, from, to);
    }
}

/// Replaces `from` by `to` in the anchors of `vertex`, if `from` is one of them. `table` is that of [`Fans`]. Several
/// threads may move different anchors.
pub(crate) fn move_anchor(table: &[AtomicU32], vertex: u32, from: u32, to: u32) {
    let list = table.get(vertex as usize).map_or(NONE, Word::get);
    if list != NONE {
        let anchors = table[list as usize..].iter().take_while(|anchor| anchor.get() != NONE);
        for anchor in anchors.filter(|anchor| anchor.get() == from) {
            anchor.set(to);
        }
    }
}

/// Iterates over the corners at a vertex: the half-edges that start there.
pub(crate) struct Star<'a> {
    twins: &'a [u32],
    start: u32,
    at: u32,
    clockwise: bool,
    further: &'a [u32],
}

impl<'a> Star<'a> {
    /// All corners at the vertex that `corner` starts at.
    pub(crate) fn new(triangles: &[u32], twins: &'a [u32], fans: &'a Fans, corner: u32) -> Self {
        match fans.of(triangles[corner as usize]) {
            None => Self::of_fan(twins, corner),
            Some(anchors) => Self { further: &anchors[1..], ..Self::of_fan(twins, anchors[0]) },
        }
    }

    /// The corners of the fan that `corner` belongs to.
    pub(crate) fn of_fan(twins: &'a [u32], corner: u32) -> Self {
        Self { twins, start: corner, at: corner, clockwise: false, further: &[NONE] }
    }

    fn begin_next_fan(&mut self) {
        self.start = self.further[0];
        self.at = self.start;
        self.clockwise = false;
        if self.start != NONE {
            self.further = &self.further[1..];
        }
    }

    #[inline(always)]
    fn advance(&mut self) {
        if !self.clockwise {
            self.at = unflagged(self.twins[prev(self.at) as usize]);
            if self.at == self.start {
                return self.begin_next_fan();
            }
            if self.at != NONE {
                return;
            }
            // The fan is open: return to the corner where the walk began, and walk clockwise.
            self.clockwise = true;
            self.at = self.start;
        }
        match unflagged(self.twins[self.at as usize]) {
            NONE => self.begin_next_fan(),
            twin => self.at = next(twin),
        }
    }
}

impl Iterator for Star<'_> {
    type Item = u32;

    #[inline(always)]
    fn next(&mut self) -> Option<u32> {
        (self.at != NONE).then(|| {
            let corner = self.at;
            self.advance();
            corner
        })
    }
}

/// Whether an edge joins the vertices at which two corners start, or both vertices are the same. After `most` steps around
/// each of them it is as if one did.
pub(crate) fn are_joined(
    triangles: &[u32],
    twins: &[u32],
    fans: &Fans,
    corners: [u32; 2],
    most: u32,
) -> bool {
    let star = |i: usize| Star::new(triangles, twins, fans, corners[i]);
    let joins_to = |i: usize| {
        let to = triangles[corners[i] as usize];
        move |corner| triangles[next(corner) as usize] == to || triangles[prev(corner) as usize] == to
    };
    let mut steps = 0;
    let second = |corner| {
        steps += 1;
        steps > most || joins_to(0)(corner)
    };
    triangles[corners[0] as usize] == triangles[corners[1] as usize]
        || any_in_either((star(0), joins_to(1)), (star(1), second))
}

/// Whether a corner of two stars passes the test of its star. Both stars must give the same answer, so the walk ends
/// with the first star that has one. It alternates between the stars: its cost is at most twice that of the smaller
/// star.
pub(crate) fn any_in_either(
    mut first: (Star, impl Fn(u32) -> bool),
    mut second: (Star, impl FnMut(u32) -> bool),
) -> bool {
    loop {
        match first.0.next() {
            None => return false,
            Some(corner) if first.1(corner) => return true,
            Some(_) => {}
        }
        match second.0.next() {
            None => return false,
            Some(corner) if second.1(corner) => return true,
            Some(_) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Adjacency;
    use crate::system::threads::Threads;

    /// The two other vertices of each triangle in the star of `v`, sorted.
    fn around(vertices: usize, triangles: &[u32], v: u32) -> Vec<[u32; 2]> {
        let twins = Adjacency::of_triangles(vertices, triangles, &Threads::default()).twins;
        let fans = Fans::new(vertices, triangles, &twins);
        let corner = triangles.iter().position(|&u| u == v).map_or(NONE, |h| h as u32);
        let ends = |x| [next(x), prev(x)].map(|h| triangles[h as usize]);
        let mut ends: Vec<_> = Star::new(triangles, &twins, &fans, corner).map(ends).collect();
        ends.sort_unstable();
        ends
    }

    /// ```text
    ///   3---2
    ///   | \ | \      vertex 1 has an open fan of three triangles; the walk may start in each of them
    ///   0---1--4
    /// ```
    #[test]
    fn an_open_fan_is_walked_in_both_directions() {
        for triangles in
            [[0, 1, 3, 1, 2, 3, 4, 2, 1], [1, 2, 3, 4, 2, 1, 0, 1, 3], [4, 2, 1, 0, 1, 3, 1, 2, 3]]
        {
            assert_eq!(around(5, &triangles, 1), [[2, 3], [3, 0], [4, 2]]);
        }
    }

    #[test]
    fn a_closed_fan_is_walked_once() {
        assert_eq!(around(4, &[0, 1, 2, 0, 2, 3, 0, 3, 1], 0), [[1, 2], [2, 3], [3, 1]]);
    }

    /// ```text
    ///   1       3
    ///   | \   / |
    ///   |   0   |    a bow-tie: two fans at vertex 0
    ///   | /   \ |
    ///   2       4
    /// ```
    #[test]
    fn all_fans_of_a_bow_tie_are_walked() {
        let triangles = [0, 1, 2, 0, 4, 3];
        assert_eq!(around(5, &triangles, 0), [[1, 2], [4, 3]]);
        assert_eq!(around(5, &triangles, 1), [[2, 0]]);
        let fans = Fans::new(5, &triangles, &[NONE; 6]);
        assert_eq!(fans.table, [5, NONE, NONE, NONE, NONE, 0, 3, NONE]);
    }

    /// The triangles (0, 1, 2), (0, 2, 3), … (0, n, 1) are the star of 0. Walks around 0 and 1 in turns end with the
    /// shorter star.
    #[test]
    fn the_shorter_star_decides() {
        let triangles: Vec<u32> = (1..=100).flat_map(|i| [0, i, i % 100 + 1]).collect();
        let twins = Adjacency::of_triangles(101, &triangles, &Threads::default()).twins;
        let fans = Fans::default();
        let star = |corner| Star::new(&triangles, &twins, &fans, corner);
        let steps = std::cell::Cell::new(0);
        let never = |_| {
            steps.set(steps.get() + 1);
            false
        };
        assert!(!any_in_either((star(0), never), (star(1), never)));
        assert!(steps.get() <= 2 * 2 + 1, "{}", steps.get());
    }
}
