//! Another order of the vertices and triangles of a mesh, in which neighbours are close to each other in memory. Nothing
//! that a caller sees depends on it: the keys of edges are those of the caller's order.

use super::half_edge::{FLAGS, triangle_of};
use crate::system::threads::{Threads, Word, shared};
use crate::{Dimension, Mesh, NONE, Positions};
use std::borrow::Cow;
use std::sync::Arc;

/// The fewest triangles that are arranged. Fewer fit into the cache in any order. In debug builds the number is small,
/// so that the tests arrange most meshes.
const FEWEST: usize = if cfg!(debug_assertions) { 8 } else { 1 << 17 };

/// The most triangles that are looked at to find out whether a mesh needs an arrangement.
const SAMPLES: usize = 1 << 12;

/// The order of an arranged mesh. Both lists are empty if it is the caller's.
#[derive(Default)]
pub(crate) struct Arrangement {
    /// The caller's index of each vertex.
    vertices: Vec<u32>,
    /// The caller's index of each triangle.
    triangles: Vec<u32>,
}

impl Arrangement {
    /// Arranges a mesh whose neighbours are far from each other in memory.
    pub(crate) fn of(mesh: &Mesh, threads: &Threads) -> Option<(Self, Mesh)> {
        Self::is_needed(mesh).then(|| Self::along_a_curve(mesh, threads))
    }

    /// Whether a quarter of the triangles are far from the next one, or have corners that are far from each other.
    pub(crate) fn is_needed(mesh: &Mesh) -> bool {
        let (count, far) = (mesh.triangle_count(), mesh.vertex_count() as u32 / 16);
        if count < FEWEST {
            return false;
        }
        let corners = |t: usize| [0, 1, 2].map(|k| mesh.triangles()[3 * t + k]);
        let is_far = |&t: &usize| {
            let ([a, b, c], [next, ..]) = (corners(t), corners(t + 1));
            [b, c, next].iter().any(|v| v.abs_diff(a) > far)
        };
        let samples = (0..count - 1).step_by(count.div_ceil(SAMPLES));
        4 * samples.clone().filter(is_far).count() > samples.len()
    }

    /// Bytes of the arrangement of a mesh and of the arranged mesh.
    pub(crate) fn bytes(mesh: &Mesh) -> u64 {
        16 * mesh.triangle_count() as u64 + 4 * mesh.vertex_count() as u64 + mesh.positions().bytes()
    }

    /// Sorts the vertices along a Morton curve, and the triangles by their first vertex.
    pub(crate) fn along_a_curve(mesh: &Mesh, threads: &Threads) -> (Self, Mesh) {
        let vertices = sorted(codes(mesh, threads), threads);
        let mut ranks = threads.zeros(vertices.len());
        let words = shared(&mut ranks);
        threads.map(vertices.len(), |piece| {
            piece.for_each(|rank| words[vertices[rank] as usize].set(rank as u32));
        });
        let (corners, _) = mesh.triangles().as_chunks::<3>();
        // Not `map`, which is not always inlined.
        let ranked = |t: usize| {
            let [a, b, c] = corners[t];
            [ranks[a as usize], ranks[b as usize], ranks[c as usize]]
        };
        let first = |t: usize| {
            let [a, b, c] = ranked(t);
            a.min(b).min(c)
        };
        let triangles = sorted(threads.collect(corners.len(), first), threads);
        let arranged = threads.collect(corners.len(), |i| ranked(triangles[i] as usize));
        let arrangement = Self { vertices, triangles };
        let positions = arrangement.arranged(Cow::Borrowed(mesh.positions()), threads);
        let mesh = mesh.reordered(positions, arranged.into_flattened());
        (arrangement, mesh)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.triangles.is_empty()
    }

    /// The caller's index of a half-edge.
    #[inline(always)]
    pub(crate) fn name(&self, h: u32) -> u32 {
        if self.is_empty() {
            return h;
        }
        let t = triangle_of(h);
        3 * self.triangles[t as usize] + (h - 3 * t)
    }

    /// The caller's index of a vertex.
    #[inline(always)]
    pub(crate) fn vertex(&self, v: u32) -> u32 {
        self.vertices.get(v as usize).copied().unwrap_or(v)
    }

    /// The half-edges of an edge, first the one with the lower name.
    #[inline(always)]
    pub(crate) fn ordered(&self, [h, g]: [u32; 2]) -> [u32; 2] {
        if self.name(h) < self.name(g) { [h, g] } else { [g, h] }
    }

    /// The half-edges with these names.
    pub(crate) fn half_edges(&self, names: Vec<u32>) -> Vec<u32> {
        if self.is_empty() {
            return names;
        }
        let mut places = vec![0; self.triangles.len()];
        for (place, &t) in (0..).zip(&self.triangles) {
            places[t as usize] = place;
        }
        let place = |h: u32| 3 * places[triangle_of(h) as usize] + (h - 3 * triangle_of(h));
        names.into_iter().map(place).collect()
    }

    /// Positions in this order, from positions in the caller's.
    pub(crate) fn arranged(&self, positions: Cow<Positions>, threads: &Threads) -> Positions {
        if self.is_empty() {
            return positions.into_owned();
        }
        let mut arranged = positions.into_owned();
        self.move_points(&mut arranged, threads, false);
        arranged
    }

    /// A mesh in this order, from its positions in the caller's order and its triangles in this one.
    pub(crate) fn mesh(&self, mesh: Arc<Mesh>, triangles: &[u32], threads: &Threads) -> Arc<Mesh> {
        if self.is_empty() {
            return mesh;
        }
        let positions = self.arranged(Cow::Borrowed(mesh.positions()), threads);
        Arc::new(mesh.reordered(positions, triangles.to_vec()))
    }

    /// Positions in the caller's order.
    pub(crate) fn named_positions(&self, positions: &Positions, threads: &Threads) -> Positions {
        let mut named = positions.clone();
        if !self.is_empty() {
            self.move_points(&mut named, threads, true);
        }
        named
    }

    /// Moves the point of each vertex from its place in the caller's order to that in this one, or back.
    fn move_points(&self, positions: &mut Positions, threads: &Threads, is_back: bool) {
        let points = positions.words_mut();
        let (from, stride) = (points.to_vec(), points.len() / self.vertices.len());
        let points = shared(points);
        threads.map(self.vertices.len(), |piece| {
            for place in piece {
                let (place, name) = (stride * place, stride * self.vertices[place] as usize);
                let (old, new) = if is_back { (place, name) } else { (name, place) };
                for k in 0..stride {
                    points[new + k].set(from[old + k]);
                }
            }
        });
    }

    /// Triangles in the caller's order, with the caller's vertices.
    pub(crate) fn named_triangles(&self, triangles: &[u32], threads: &Threads) -> Vec<u32> {
        self.named(triangles, threads, |v| self.vertices[v as usize])
    }

    /// Twins in the caller's order.
    pub(crate) fn named_twins(&self, twins: &[u32], threads: &Threads) -> Vec<u32> {
        self.named(
            twins,
            threads,
            |twin| {
                if twin == NONE { NONE } else { self.name(twin & !FLAGS) | twin & FLAGS }
            },
        )
    }

    /// The words of half-edges in the caller's order, each after `name`.
    fn named(&self, words: &[u32], threads: &Threads, name: impl Fn(u32) -> u32 + Sync) -> Vec<u32> {
        if self.is_empty() {
            return threads.copied(words);
        }
        let mut named = threads.zeros(words.len());
        let all = shared(&mut named);
        threads.map(self.triangles.len(), |piece| {
            for t in piece {
                let to = 3 * self.triangles[t] as usize;
                for k in 0..3 {
                    all[to + k].set(name(words[3 * t + k]));
                }
            }
        });
        named
    }

    /// A word of each triangle, in the caller's order.
    pub(crate) fn named_words(&self, words: &[u32]) -> Vec<u32> {
        let mut named = words.to_vec();
        for (&t, &word) in self.triangles.iter().zip(words) {
            named[t as usize] = word;
        }
        named
    }
}

/// For each vertex its place on a Morton curve.
pub(crate) fn codes(mesh: &Mesh, threads: &Threads) -> Vec<u32> {
    let (stride, positions) = (mesh.dimension().stride(), mesh.positions());
    let ends = threads.map(mesh.vertex_count(), |piece| {
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for v in piece {
            for (axis, [lowest, highest]) in ends.iter_mut().take(stride).enumerate() {
                let x = positions.at(stride * v + axis);
                (*lowest, *highest) = (lowest.min(x), highest.max(x));
            }
        }
        ends
    });
    let mut all = ends[0];
    for ends in &ends {
        for (all, ends) in all.iter_mut().zip(ends) {
            *all = [all[0].min(ends[0]), all[1].max(ends[1])];
        }
    }
    let extent =
        all.iter().take(stride).fold(0.0, |extent: f64, [lowest, highest]| extent.max(highest - lowest));
    let scale = if stride == 2 { 65535.0 } else { 1023.0 } / extent;
    threads.collect(mesh.vertex_count(), |v| {
        // Casts saturate, also those of NaN.
        let cell = |axis: usize| ((positions.at(stride * v + axis) - all[axis][0]) * scale) as u32;
        match mesh.dimension() {
            Dimension::Two => spread_by_one(cell(0)) | spread_by_one(cell(1)) << 1,
            Dimension::Three => {
                spread_by_two(cell(0)) | spread_by_two(cell(1)) << 1 | spread_by_two(cell(2)) << 2
            }
        }
    })
}

/// Bits of a digit of [`sorted`].
const DIGIT: u32 = 11;

/// The indices of `keys` by ascending key; of equal keys, the lower index first. Sorts by one digit after another.
fn sorted(mut keys: Vec<u32>, threads: &Threads) -> Vec<u32> {
    let mut order = threads.collect(keys.len(), |i| i as u32);
    let (mut next_keys, mut next_order) = (threads.zeros(keys.len()), threads.zeros(keys.len()));
    let most = keys.iter().fold(0, |all, key| all | key);
    for shift in (0..u32::BITS - most.leading_zeros()).step_by(DIGIT as usize) {
        let digit = |key: u32| (key >> shift) as usize % (1 << DIGIT);
        let mut starts = threads.map(keys.len(), |piece| {
            let mut counts = [0u32; 1 << DIGIT];
            keys[piece.clone()].iter().for_each(|&key| counts[digit(key)] += 1);
            (piece, counts)
        });
        let mut start = 0;
        for digit in 0..1 << DIGIT {
            for (_, counts) in &mut starts {
                start += std::mem::replace(&mut counts[digit], start);
            }
        }
        let (to_keys, to_order) = (shared(&mut next_keys), shared(&mut next_order));
        threads.each(&mut starts, |(piece, starts)| {
            for i in piece.clone() {
                let at = &mut starts[digit(keys[i])];
                to_keys[*at as usize].set(keys[i]);
                to_order[*at as usize].set(order[i]);
                *at += 1;
            }
        });
        std::mem::swap(&mut keys, &mut next_keys);
        std::mem::swap(&mut order, &mut next_order);
    }
    order
}

/// The 16 bits of a number, a zero after each.
fn spread_by_one(x: u32) -> u32 {
    let x = (x | x << 8) & 0x00ff_00ff;
    let x = (x | x << 4) & 0x0f0f_0f0f;
    let x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
}

/// The 10 bits of a number, two zeros after each.
fn spread_by_two(x: u32) -> u32 {
    let x = (x | x << 16) & 0x0300_00ff;
    let x = (x | x << 8) & 0x0300_f00f;
    let x = (x | x << 4) & 0x030c_30c3;
    (x | x << 2) & 0x0924_9249
}
