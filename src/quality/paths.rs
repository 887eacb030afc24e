//! Paths of edges along a line: what a constraint has become.

use super::audit_exact::turn;
use super::surface::Surface;

/// What a run says of its constraints.
pub(crate) struct Named<'a> {
    /// As [`Outcome::constraint_edges`](crate::Outcome::constraint_edges).
    pub edges: &'a [[u32; 2]],
    /// The indices of the constraints that were left out, in ascending order.
    pub left_out: Vec<usize>,
    /// As [`Outcome::lost_edges`](crate::Outcome::lost_edges).
    pub lost_edges: &'a [[u32; 2]],
}

/// Takes the path from `u` to `v` off the start of `edges`: its vertices are on the line between them, each nearer to
/// `v` than the one before. Its edges may be missing in the surface. `None` if `edges` does not start with such a path.
pub(super) fn take_path<'e>(
    surface: &Surface,
    edges: &mut &'e [[u32; 2]],
    [u, v]: [u32; 2],
) -> Option<&'e [[u32; 2]]> {
    if u.max(v) as usize >= surface.mesh.vertex_count() {
        return None;
    }
    let (all, mut at) = (*edges, u);
    for (i, &[from, to]) in all.iter().enumerate() {
        if from != at || !is_between(surface, [at, to, v]) {
            return None;
        }
        at = to;
        if at == v {
            let (path, others) = all.split_at(i + 1);
            *edges = others;
            return Some(path);
        }
    }
    None
}

/// Searches for paths among all edges of a surface.
pub(super) struct Paths<'a> {
    surface: &'a Surface<'a>,
    /// Both directions of every edge, sorted.
    neighbours: Vec<(u32, u32)>,
    /// For each vertex, the number of the last search that has reached it, and the vertex before it on the way.
    reached: Vec<(u32, u32)>,
    searches: u32,
}

impl<'a> Paths<'a> {
    pub fn new(surface: &'a Surface<'a>) -> Self {
        let edges = surface.table.edges();
        let mut neighbours: Vec<_> = edges.flat_map(|edge| [(edge.u, edge.v), (edge.v, edge.u)]).collect();
        neighbours.sort_unstable();
        Self { surface, neighbours, reached: vec![(0, 0); surface.mesh.vertex_count()], searches: 0 }
    }

    /// The edges of a path as of [`take_path`]. `None` if there is no such path. A search visits each vertex at most
    /// once. It begins at the end with fewer edges, so that many constraints may end at one vertex.
    pub fn along(&mut self, [u, v]: [u32; 2]) -> Option<Vec<[u32; 2]>> {
        if u.max(v) as usize >= self.reached.len() {
            return None;
        }
        let degree = |v| around(&self.neighbours, v).len();
        let is_turned = degree(v) < degree(u);
        let [from, to] = if is_turned { [v, u] } else { [u, v] };
        self.searches += 1;
        let mut open = vec![from];
        while let Some(at) = open.pop() {
            for &(_, next) in around(&self.neighbours, at) {
                let (search, before) = &mut self.reached[next as usize];
                if *search != self.searches && is_between(self.surface, [at, next, to]) {
                    (*search, *before) = (self.searches, at);
                    open.push(next);
                }
            }
            if self.reached[to as usize].0 == self.searches {
                return Some(self.path_back([from, to], is_turned));
            }
        }
        None
    }

    /// The way of the last search.
    fn path_back(&self, [from, to]: [u32; 2], is_turned: bool) -> Vec<[u32; 2]> {
        let (mut path, mut at) = (Vec::new(), to);
        while at != from {
            let (_, before) = self.reached[at as usize];
            path.push(if is_turned { [at, before] } else { [before, at] });
            at = before;
        }
        if !is_turned {
            path.reverse();
        }
        path
    }
}

/// The edges at a vertex, among both directions of every edge, sorted.
fn around(neighbours: &[(u32, u32)], v: u32) -> &[(u32, u32)] {
    let first = neighbours.partition_point(|&(from, _)| from < v);
    let count = neighbours[first..].partition_point(|&(from, _)| from == v);
    &neighbours[first..first + count]
}

/// Whether `w` is `v`, or on the open line from `u` to `v`.
fn is_between(surface: &Surface, [u, w, v]: [u32; 3]) -> bool {
    let lies_in = |from: f64, at: f64, to: f64| (from < at && at < to) || (from > at && at > to);
    let is_inside = || {
        let [p, q, r] = [u, w, v].map(|vertex| surface.coord(vertex));
        turn([p, q, r]).is_eq() && (lies_in(p.x, q.x, r.x) || lies_in(p.y, q.y, r.y))
    };
    w == v || ((w as usize) < surface.mesh.vertex_count() && is_inside())
}
