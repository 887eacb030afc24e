//! The audit's own table of edges: all half-edges, sorted by smaller end, larger end and index.

/// The class of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// One half-edge.
    Boundary,
    /// Two half-edges, in opposite directions, of different triangles; the lower one first.
    Twins(u32, u32),
    /// Three or more half-edges, or two of one triangle.
    NonManifold,
    /// Two half-edges in the same direction.
    Inconsistent,
}

/// One edge: its ends, u <= v, and its half-edges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge<'a> {
    pub u: u32,
    pub v: u32,
    pub class: Class,
    /// Half-edges from u to v, and from v to u.
    pub directed: [usize; 2],
    entries: &'a [u64],
}

impl Edge<'_> {
    /// Half-edges in ascending order.
    pub fn half_edges(&self) -> impl Iterator<Item = u32> + Clone + '_ {
        self.entries.iter().map(|&entry| entry as u32)
    }
}

/// All edges of a mesh.
pub(super) struct EdgeTable<'a> {
    triangles: &'a [u32],
    /// For each vertex, the index of the first entry whose smaller end it is.
    first: Vec<u32>,
    /// Larger end in the upper word, half-edge in the lower.
    entries: Vec<u64>,
}

pub(super) fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

pub(super) fn prev(h: u32) -> u32 {
    next(next(h))
}

impl<'a> EdgeTable<'a> {
    /// Indices must be below `vertices`.
    pub fn new(triangles: &'a [u32], vertices: usize) -> Self {
        let ends = |h: u32| {
            let (from, to) = (triangles[h as usize], triangles[next(h) as usize]);
            (from.min(to), from.max(to))
        };
        let mut first = vec![0u32; vertices + 2];
        for h in 0..triangles.len() as u32 {
            first[ends(h).0 as usize + 2] += 1;
        }
        for v in 2..first.len() {
            first[v] += first[v - 1];
        }
        let mut entries = vec![0u64; triangles.len()];
        for h in 0..triangles.len() as u32 {
            let (u, v) = ends(h);
            let next = &mut first[u as usize + 1];
            entries[*next as usize] = u64::from(v) << 32 | u64::from(h);
            *next += 1;
        }
        for u in 0..vertices {
            entries[first[u] as usize..first[u + 1] as usize].sort_unstable();
        }
        Self { triangles, first, entries }
    }

    fn at(&self, u: u32) -> &[u64] {
        &self.entries[self.first[u as usize] as usize..self.first[u as usize + 1] as usize]
    }

    /// The edges in ascending order of (u, v).
    pub fn edges(&self) -> impl Iterator<Item = Edge<'_>> {
        (0..self.first.len() as u32 - 2).flat_map(move |u| {
            let groups = self.at(u).chunk_by(|x, y| x >> 32 == y >> 32);
            groups.map(move |entries| self.edge(u, entries))
        })
    }

    fn edge<'t>(&'t self, u: u32, entries: &'t [u64]) -> Edge<'t> {
        let v = (entries[0] >> 32) as u32;
        let forward = entries.iter().filter(|&&entry| self.triangles[entry as u32 as usize] == u).count();
        let directed = [forward, entries.len() - forward];
        let class = match *entries {
            [_] => Class::Boundary,
            [x, y] if x as u32 / 3 == y as u32 / 3 => Class::NonManifold,
            [x, y] if directed == [1, 1] => Class::Twins(x as u32, y as u32),
            [_, _] => Class::Inconsistent,
            _ => Class::NonManifold,
        };
        Edge { u, v, class, directed, entries }
    }

    /// Whether an edge joins the two vertices.
    pub fn contains(&self, p: u32, q: u32) -> bool {
        let around = self.at(p.min(q));
        let largest = u64::from(p.max(q));
        let index = around.partition_point(|&entry| entry >> 32 < largest);
        around.get(index).is_some_and(|&entry| entry >> 32 == largest)
    }
}
