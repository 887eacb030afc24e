//! Paths of edges along a line: what a constraint has become.

use super::audit_exact::turn;
use super::surface::Surface;

/// The neighbours of each vertex.
pub(super) struct Paths<'a> {
    surface: &'a Surface<'a>,
    /// Both directions of every edge, sorted.
    neighbours: Vec<(u32, u32)>,
}

impl<'a> Paths<'a> {
    pub fn new(surface: &'a Surface<'a>) -> Self {
        let edges = surface.table.edges();
        let mut neighbours: Vec<_> = edges.flat_map(|edge| [(edge.u, edge.v), (edge.v, edge.u)]).collect();
        neighbours.sort_unstable();
        Self { surface, neighbours }
    }

    /// The edges of the path from `u` to `v` whose vertices are all on the line between them, each nearer to `v` than
    /// the one before. Each edge has its smaller end first. `None` if there is no such path.
    pub fn along(&self, u: u32, v: u32) -> Option<Vec<(u32, u32)>> {
        let vertices = self.surface.mesh.vertex_count();
        if u.max(v) as usize >= vertices {
            return None;
        }
        let mut path = Vec::new();
        let mut at = u;
        while at != v {
            let next = self.around(at).find(|&w| self.is_between(at, w, v))?;
            path.push((at.min(next), at.max(next)));
            at = next;
        }
        Some(path)
    }

    fn around(&self, u: u32) -> impl Iterator<Item = u32> {
        let first = self.neighbours.partition_point(|&(from, _)| from < u);
        self.neighbours[first..].iter().take_while(move |&&(from, _)| from == u).map(|&(_, to)| to)
    }

    /// Whether `w` is `v`, or on the open line from `u` to `v`.
    fn is_between(&self, u: u32, w: u32, v: u32) -> bool {
        let [p, q, r] = [u, w, v].map(|vertex| self.surface.coord(vertex));
        let lies_in = |from: f64, at: f64, to: f64| (from < at && at < to) || (from > at && at > to);
        w == v || (turn([p, q, r]).is_eq() && (lies_in(p.x, q.x, r.x) || lies_in(p.y, q.y, r.y)))
    }
}
