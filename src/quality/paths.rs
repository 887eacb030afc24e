//! Paths of edges along a line: what a constraint has become.

use super::audit_exact::{ahead, near, turn};
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

/// The line between two vertices, and how far from it a vertex counts as on it.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) ends: [u32; 2],
    pub(super) tolerance: f64,
}

/// Takes the path along a line off the start of `edges`: its vertices count as on the line, each further along it than
/// the one before. Its edges may be missing in the surface. `None` if `edges` does not start with such a path.
pub(super) fn take_path<'e>(
    surface: &Surface,
    edges: &mut &'e [[u32; 2]],
    line: Line,
) -> Option<&'e [[u32; 2]]> {
    let [u, v] = line.ends;
    if u.max(v) as usize >= surface.mesh.vertex_count() {
        return None;
    }
    let (all, mut at) = (*edges, u);
    for (i, &[from, to]) in all.iter().enumerate() {
        if from != at || !line.leads(surface, [at, to]) {
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
    pub fn along(&mut self, Line { ends: [u, v], tolerance }: Line) -> Option<Vec<[u32; 2]>> {
        if u.max(v) as usize >= self.reached.len() {
            return None;
        }
        let degree = |v| around(&self.neighbours, v).len();
        let is_turned = degree(v) < degree(u);
        let [from, to] = if is_turned { [v, u] } else { [u, v] };
        let line = Line { ends: [from, to], tolerance };
        self.searches += 1;
        let mut open = vec![from];
        while let Some(at) = open.pop() {
            for &(_, next) in around(&self.neighbours, at) {
                let (search, before) = &mut self.reached[next as usize];
                if *search != self.searches && line.leads(self.surface, [at, next]) {
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

impl Line {
    /// Whether a path along the line may go from one of its vertices to another.
    fn leads(self, surface: &Surface, [at, next]: [u32; 2]) -> bool {
        let [_, v] = self.ends;
        let lies_in = |from: f64, at: f64, to: f64| (from < at && at < to) || (from > at && at > to);
        let is_on = || {
            let [p, q, r] = [at, next, v].map(|vertex| surface.coord(vertex));
            if self.tolerance == 0.0 {
                return turn([p, q, r]).is_eq() && (lies_in(p.x, q.x, r.x) || lies_in(p.y, q.y, r.y));
            }
            let line = self.ends.map(|vertex| surface.coord(vertex));
            let [along, across] = ahead(line, [p, q]);
            let is_inside = ahead(line, [line[0], q])[0].is_gt() && ahead(line, [q, r])[0].is_gt();
            along.then(across).is_gt() && is_inside && near(line, q, self.tolerance)
        };
        next == v || ((next as usize) < surface.mesh.vertex_count() && is_on())
    }
}
