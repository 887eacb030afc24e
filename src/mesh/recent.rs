//! Twins of a mesh in the plane, on one thread, in one pass over its triangles.
//!
//! Neighbours are mostly near each other in memory. So a half-edge waits for its twin in a small table, and gives its
//! place to a later half-edge if the twin has not come. The few that have lost their places are sorted.
//!
//! This pairs half-edges of opposite directions, but it does not see how many half-edges an edge has. The stars do:
//! whatever the pairs are, the triangles at a vertex whose star is embedded lie in different directions. So there is at
//! most one half-edge from this vertex to another one, and at most one back. Only edges between two vertices without
//! embedded stars are counted, half-edge by half-edge.

use super::adjacency::{Adjacency, twin_of};
use super::buckets::visit_edges;
use super::embedded::Embedded;
use super::half_edge::next;
use super::winding::{Outline, Winding};
use crate::system::threads::Threads;
use crate::{Dimension, Mesh, NONE};

/// If more than one half-edge in so many has to be sorted, sorting all of them by [`Adjacency::of_triangles`] is faster.
const SORTED: usize = 16;

/// So many are always sorted.
const FEW: usize = 256;

/// The adjacency of a mesh, and what follows from it.
pub(crate) struct Joined {
    pub(crate) adjacency: Adjacency,
    pub(crate) winding: Winding,
    pub(crate) embedded: Embedded,
    /// Filled in if the winding depends on the components.
    pub(crate) outline: Option<Outline>,
}

impl Joined {
    /// Joins the triangles of a mesh.
    pub(crate) fn new(mesh: &Mesh, threads: &Threads) -> Self {
        let most = mesh.triangles().len() / SORTED + FEW;
        if threads.is_one()
            && mesh.dimension() == Dimension::Two
            && let Some(joined) = Self::of_recent(mesh, slots(mesh.triangle_count()), most)
        {
            return joined;
        }
        let adjacency = Adjacency::of_triangles(mesh.vertex_count(), mesh.triangles(), threads);
        Self::of(mesh, adjacency, threads)
    }

    fn of(mesh: &Mesh, adjacency: Adjacency, threads: &Threads) -> Self {
        let mut outline = None;
        let (winding, embedded) = Embedded::with_winding(mesh, &adjacency.twins, None, &mut outline, threads);
        Self { adjacency, winding, embedded, outline }
    }

    /// The same for a mesh in the plane, through a table of `slots` slots, a power of two. `None` if more than `most`
    /// half-edges have lost their places, or belong to edges that the stars leave unproven.
    fn of_recent(mesh: &Mesh, slots: usize, most: usize) -> Option<Self> {
        let triangles = mesh.triangles();
        let mut adjacency = Adjacency { twins: vec![0; triangles.len()], ..Adjacency::default() };
        let rest = pair_recent(triangles, slots, most, &mut adjacency.twins)?;
        adjacency.match_again(triangles, &rest);
        let threads = Threads::one();
        let joined = Self::of(mesh, adjacency, &threads);
        let embedded = |h: u32| joined.embedded.at(triangles[h as usize]);
        let unproven = unproven(triangles, &joined.embedded, most)?;
        let mut boundary = 0;
        for h in rest {
            let is_single = joined.adjacency.twins[h as usize] == NONE;
            boundary += usize::from(is_single && (embedded(h) || embedded(next(h))));
        }
        let half_edges = triangles.len() - unproven.len();
        let mut adjacency = Adjacency {
            twins: joined.adjacency.twins,
            edges: ((half_edges + boundary) / 2) as u32,
            boundary: boundary as u32,
            ..Adjacency::default()
        };
        if adjacency.match_again(triangles, &unproven) {
            return Some(Self::of(mesh, adjacency, &threads));
        }
        Some(Self { adjacency, ..joined })
    }
}

impl Adjacency {
    /// Counts the edges of these half-edges, as if their edges had no others, and writes their twins. Returns whether a
    /// twin has changed.
    fn match_again(&mut self, triangles: &[u32], half_edges: &[u32]) -> bool {
        let mut has_changed = false;
        by_edge(triangles, half_edges, &mut |edge| {
            let kind = self.count(edge, triangles);
            for &h in edge {
                let twin = twin_of(h, edge, kind);
                has_changed |= std::mem::replace(&mut self.twins[h as usize], twin) != twin;
            }
        });
        has_changed
    }
}

/// The slots for a mesh of so many triangles, in an order in which about as many edges are open as a grid has in a row.
/// With 40 slots for each of them, few lose their places.
fn slots(triangles: usize) -> usize {
    (40 * triangles.isqrt()).next_power_of_two()
}

/// A half-edge that waits for its twin.
#[derive(Clone, Copy)]
struct Waiting {
    /// The ends of its twin.
    twin: u64,
    half_edge: u32,
}

/// An empty slot. No half-edge ends at [`NONE`].
const NOBODY: Waiting = Waiting { twin: u64::MAX, half_edge: NONE };

/// Pairs half-edges of opposite directions. Returns those that have lost their places, and those that still wait at the
/// end; `None` if more than `most` have lost their places.
#[inline(never)] // else the compiler runs out of registers
fn pair_recent(triangles: &[u32], slots: usize, most: usize, twins: &mut [u32]) -> Option<Vec<u32>> {
    let (corners, _) = triangles.as_chunks::<3>();
    let mut table = vec![NOBODY; slots];
    let mut rest = Vec::new();
    for (first, &[a, b, c]) in (0..).step_by(3).zip(corners) {
        for (from, to, h) in [(a, b, first), (b, c, first + 1), (c, a, first + 2)] {
            let place = &mut table[slot(from, to) & (slots - 1)];
            let Waiting { twin, half_edge } = *place;
            let ends = u64::from(from) << 32 | u64::from(to);
            let is_twin = twin == ends;
            // A branch on it would be unpredictable.
            *place = if is_twin { NOBODY } else { Waiting { twin: ends.rotate_left(32), half_edge: h } };
            twins[if is_twin { half_edge } else { h } as usize] = h;
            twins[h as usize] = if is_twin { half_edge } else { NONE };
            if !is_twin & (half_edge != NONE) {
                rest.push(half_edge);
                if rest.len() > most {
                    return None;
                }
            }
        }
    }
    for Waiting { half_edge, .. } in table {
        if half_edge != NONE {
            rest.push(half_edge);
        }
    }
    Some(rest)
}

/// Where a half-edge waits, and where its twin looks for it: the lower end plus a multiple of the distance to the higher
/// one. Where neighbouring edges have consecutive ends, they have consecutive slots, so that few lines of the cache are
/// in use.
#[inline(always)]
fn slot(from: u32, to: u32) -> usize {
    let place = from.wrapping_sub(to).wrapping_mul(0x9e37_79b1);
    // For a half-edge to the higher end, the distance has the other sign.
    (if from > to { to.wrapping_add(place) } else { from.wrapping_sub(place) }) as usize
}

/// Calls `visit` for each edge with those of these half-edges that belong to it.
fn by_edge(triangles: &[u32], half_edges: &[u32], visit: &mut dyn FnMut(&[u32])) {
    let ends = |h: u32| [h, next(h)].map(|x| triangles[x as usize]);
    let low = |&h: &u32| (ends(h)[0].min(ends(h)[1]), h);
    let mut by_low: Vec<_> = half_edges.iter().map(low).collect();
    by_low.sort_unstable();
    let (mut bucket, mut edge) = (Vec::new(), Vec::new());
    for entries in by_low.chunk_by(|x, y| x.0 == y.0) {
        bucket.clear();
        bucket.extend(entries.iter().map(|&(_, h)| (ends(h)[0].max(ends(h)[1]), h)));
        visit_edges(&mut bucket, &mut edge, &mut *visit);
    }
}

/// The half-edges between two vertices neither of which has an embedded star; `None` if they are more than `most`.
fn unproven(triangles: &[u32], embedded: &Embedded, most: usize) -> Option<Vec<u32>> {
    let mut unproven = Vec::new();
    let (corners, _) = triangles.as_chunks::<3>();
    for (h, &[a, b, c]) in (0..).step_by(3).zip(corners) {
        let [a, b, c] = [embedded.at(a), embedded.at(b), embedded.at(c)];
        if a & b | (a | b) & c {
            continue;
        }
        for (is_proven, h) in [(a | b, h), (b | c, h + 1), (c | a, h + 2)] {
            if !is_proven {
                unproven.push(h);
            }
        }
        if unproven.len() > most {
            return None;
        }
    }
    Some(unproven)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families;
    use proptest::collection::vec;
    use proptest::prelude::*;

    /// Compares with the adjacency from sorting all half-edges, for tables of several sizes.
    fn compare(mesh: &Mesh) {
        let threads = Threads::one();
        let adjacency = Adjacency::of_triangles(mesh.vertex_count(), mesh.triangles(), &threads);
        let expected = Joined::of(mesh, adjacency, &threads);
        for slots in [1, 4, 64, slots(mesh.triangle_count())] {
            let joined = Joined::of_recent(mesh, slots, usize::MAX).unwrap();
            assert_eq!(joined.adjacency, expected.adjacency);
            assert_eq!(joined.winding, expected.winding);
            assert!(
                (0..mesh.vertex_count() as u32).all(|v| joined.embedded.at(v) == expected.embedded.at(v))
            );
            let has_outline = |joined: &Joined| joined.outline.is_some();
            assert_eq!(has_outline(&joined), has_outline(&expected));
        }
    }

    fn mesh(points: &[(i8, i8)], triangles: Vec<u32>) -> Mesh {
        let positions: Vec<f64> = points.iter().flat_map(|&(x, y)| [x, y]).map(f64::from).collect();
        Mesh::new(Dimension::Two, positions, triangles).unwrap()
    }

    proptest! {
        /// Few vertices make nearly all edges non-manifold, many make nearly all boundary. Triangles may repeat a
        /// corner.
        #[test]
        fn any_triangles_are_joined(
            points in vec((-4i8..5, -4i8..5), 12),
            corners in (2u32..13).prop_flat_map(|vertices| vec(0..vertices, 0..60)),
        ) {
            compare(&mesh(&points, corners[..corners.len() / 3 * 3].to_vec()));
        }

        /// Grids, clockwise or not, in which some vertices have moved, and some triangles are there again, turned over,
        /// or gone. Then some edges have three half-edges or more, some two of one direction, and some stars overlap.
        #[test]
        fn dirty_grids_are_joined(
            size in 2u32..9,
            is_clockwise: bool,
            moves in vec((0usize..81, (-9i8..10, -9i8..10)), 0..4),
            dirt in vec((0usize..200, 0usize..200, 0..4), 0..8),
        ) {
            let mut points: Vec<(i8, i8)> = (0..size * size).map(|v| ((v % size) as i8, (v / size) as i8)).collect();
            for (v, to) in moves {
                let v = v % points.len();
                points[v] = to;
            }
            let mut triangles = Vec::new();
            for v in (0..size * (size - 1)).filter(|v| v % size < size - 1) {
                let [a, b, c, d] = [v, v + 1, v + size, v + size + 1];
                triangles.extend(if v % 3 == 0 { [[a, b, d], [a, d, c]] } else { [[a, b, c], [b, d, c]] });
            }
            for (from, to, kind) in dirt {
                let (from, to) = (from % triangles.len(), to % (triangles.len() + 1));
                let [a, b, c] = triangles[from];
                match kind {
                    0 => triangles.insert(to, [b, c, a]),
                    1 => triangles.insert(to, [b, a, c]),
                    2 => triangles[from] = [b, a, c],
                    _ if triangles.len() > 1 => _ = triangles.remove(from),
                    _ => {}
                }
            }
            if is_clockwise {
                triangles.iter_mut().for_each(|corners| corners.reverse());
            }
            compare(&mesh(&points, triangles.into_flattened()));
        }
    }

    /// Two times two triangles at the edge 0-1, one pair after the other: each half-edge finds a twin.
    #[test]
    fn an_edge_of_two_pairs_is_frozen() {
        let points = [(0, 0), (4, 0), (1, 3), (2, -3), (3, 3), (1, -3)];
        let mesh = mesh(&points, vec![0, 1, 2, 1, 0, 3, 0, 1, 4, 1, 0, 5]);
        compare(&mesh);
        let Adjacency { non_manifold, .. } = Joined::of_recent(&mesh, 64, usize::MAX).unwrap().adjacency;
        assert_eq!(non_manifold, 1);
    }

    #[test]
    fn families_are_joined() {
        for spec in
            ["random 40", "shear 30", "regular 20", "sweep 900", "fan2 50", "strips 40", "shuffled random 12"]
        {
            compare(&families::by_name(spec).unwrap());
        }
    }

    /// A boundary that is longer than the list, and a mesh none of whose stars is embedded.
    #[test]
    fn a_long_rest_is_not_sorted() {
        let mesh = families::by_name("strips 2000").unwrap();
        assert!(Joined::of_recent(&mesh, 1, 2000).is_none());
        assert!(Joined::of_recent(&mesh, 1, 20000).is_some());
        let points = (0..80).map(|x| (x, 0)).collect::<Vec<_>>();
        let flat = self::mesh(&points, (1..78).flat_map(|v| [0, v, v + 1]).collect());
        assert!(Joined::of_recent(&flat, 1 << 10, 200).is_none());
        compare(&flat);
    }
}
