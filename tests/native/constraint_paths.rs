//! Constraints in folded, flat and non-manifold meshes: the audit accepts every result, and finds every edge that is
//! taken away. `EDGEFLIP_ROUNDS=100000 cargo test --release --test native -- constraint_paths::` tries more of them.

use crate::meshes::plane;
use crate::runs::{on_all_cores, rounds, unwatched};
use edgeflip::quality::{Audit, Violation, audit, audit_outcome};
use edgeflip::{Backend, Dimension, Mesh, Options, Order, Outcome, families};
use oorandom::Rand64;
use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

type Pair = [u32; 2];

fn ordered([u, v]: Pair) -> Pair {
    [u.min(v), u.max(v)]
}

fn edges(triangles: &[u32]) -> BTreeSet<Pair> {
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]].map(ordered);
    triangles.as_chunks().0.iter().flat_map(sides).collect()
}

/// The edges that are on a path from the first vertex of a constraint to its second: all vertices that count as on the
/// line, in their order, and what the edges between them reach from either end. The coordinates are small integers, and
/// so is twice the tolerance.
fn oracle(points: &[[i64; 2]], edges: &BTreeSet<Pair>, [u, v]: Pair, tolerance: f64) -> BTreeSet<Pair> {
    let from_u = |w: u32| [0, 1].map(|axis| points[w as usize][axis] - points[u as usize][axis]);
    let [dx, dy] = from_u(v);
    let square = dx * dx + dy * dy;
    let place = |w: u32| {
        let [x, y] = from_u(w);
        let (along, across) = (x * dx + y * dy, dx * y - dy * x);
        let reach = (2.0 * tolerance) as i64;
        (4 * across.pow(2) <= reach.pow(2) * square).then_some((along, across))
    };
    let inside = (0..points.len() as u32).filter(|&w| w != u && w != v);
    let inside =
        inside.filter_map(|w| Some((place(w)?, w))).filter(|&((along, _), _)| 0 < along && along < square);
    let mut inside: Vec<_> = inside.collect();
    inside.sort_unstable();
    let line: Vec<_> = [((0, 0), u)].into_iter().chain(inside).chain([((square, 0), v)]).collect();
    let steps =
        |i: usize, j: usize| line[i].0 < line[j].0 && edges.contains(&ordered([line[i].1, line[j].1]));
    let last = line.len() - 1;
    let (mut from_start, mut to_end) = (vec![false; line.len()], vec![false; line.len()]);
    (from_start[0], to_end[last]) = (true, true);
    for j in 1..=last {
        from_start[j] = (0..j).any(|i| from_start[i] && steps(i, j));
        to_end[last - j] = (last - j + 1..=last).any(|k| to_end[k] && steps(last - j, k));
    }
    let pairs = (0..=last).flat_map(|i| (i + 1..=last).map(move |j| (i, j)));
    let is_on_path = |&(i, j): &(usize, usize)| from_start[i] && to_end[j] && steps(i, j);
    pairs.filter(is_on_path).map(|(i, j)| ordered([line[i].1, line[j].1])).collect()
}

/// The points of a mesh, times a factor and rounded.
fn scaled(mesh: &Mesh, factor: f64) -> Vec<[i64; 2]> {
    let numbers: Vec<i64> = mesh.positions().iter().map(|x| (factor * x).round() as i64).collect();
    numbers.as_chunks().0.to_vec()
}

/// Random numbers of one round.
struct Random(Rand64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0.rand_range(0..n as u64) as usize
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    fn vertex(&mut self, mesh: &Mesh) -> u32 {
        self.below(mesh.vertex_count()) as u32
    }

    /// The points and the triangles of a lattice with random diagonals.
    fn lattice(&mut self) -> (Vec<[i64; 2]>, Vec<[u32; 3]>) {
        let side = 3 + self.below(5) as u32;
        let points = (0..side * side).map(|v| [v % side, v / side].map(i64::from)).collect();
        let cells = (0..(side - 1) * (side - 1)).map(|i| i + i / (side - 1));
        let triangles = cells.flat_map(|v| {
            let [a, b, c, d] = [v, v + 1, v + side + 1, v + side];
            if self.one_in(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
        });
        (points, triangles.collect())
    }

    /// The points and the triangles of a mesh that is right.
    fn proper(&mut self) -> (Vec<[i64; 2]>, Vec<[u32; 3]>) {
        if self.one_in(2) {
            return self.lattice();
        }
        let mesh = families::by_name(&format!("random 7 seed={}", self.below(1 << 30))).unwrap();
        let factor = [8.0, 100.0][self.below(2)];
        (scaled(&mesh, factor), mesh.triangles().as_chunks().0.to_vec())
    }

    /// A mesh of one or two sheets, folded, flattened, torn, with joined vertices and with more triangles at its edges.
    fn mesh(&mut self) -> Mesh {
        let (mut points, mut triangles) = self.proper();
        if self.one_in(3) {
            let (more, others) = self.proper();
            let offset = points.len() as u32;
            let flip = self.one_in(2);
            triangles.extend(others.into_iter().map(|t| {
                let [a, b, c] = t.map(|v| v + offset);
                if flip { [b, a, c] } else { [a, b, c] }
            }));
            points.extend(more);
        }
        // Paper is folded along lines, some points are moved, or all are drawn together.
        for _ in 0..self.below(3) {
            let (axis, at) = (self.below(2), self.below(7) as i64);
            points.iter_mut().for_each(|point| point[axis] = (point[axis] - at).abs());
        }
        for _ in 0..self.below(6) {
            let at = self.below(points.len());
            points[at] = [self.below(7) as i64, self.below(7) as i64];
        }
        if self.one_in(5) {
            let axis = self.below(2);
            points.iter_mut().for_each(|point| point[axis] /= 2);
        }
        for _ in 0..self.below(5) {
            let [from, to] = [(); 2].map(|()| self.below(points.len()) as u32);
            triangles.as_flattened_mut().iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
        }
        for _ in 0..self.below(6) {
            let [a, b, _] = triangles[self.below(triangles.len())];
            triangles.push([a, b, self.below(points.len()) as u32]);
        }
        let torn = 2 + self.below(40);
        triangles.retain(|&[a, b, c]| a != b && b != c && c != a && !self.one_in(torn));
        if triangles.is_empty() {
            triangles.push([0, 1, 2]);
        }
        let positions: Vec<f64> = points.concat().into_iter().map(|x| x as f64).collect();
        Mesh::new(Dimension::Two, positions, triangles.concat()).unwrap()
    }

    /// Pairs of any vertices, of vertices on a line with others, and edges of the mesh.
    fn constraints(&mut self, mesh: &Mesh) -> Vec<Pair> {
        let most = [1, 4, 40, 400][self.below(4)];
        let count = 1 + self.below(most);
        let all: Vec<Pair> = edges(mesh.triangles()).into_iter().collect();
        let points = scaled(mesh, 1.0);
        let constraint = |_| {
            let u = self.vertex(mesh);
            match self.below(4) {
                0 => [u, self.vertex(mesh)],
                1 => all[self.below(all.len())],
                _ => {
                    let axis = self.below(2);
                    let is_on_line = |&v: &u32| points[v as usize][axis] == points[u as usize][axis];
                    let line: Vec<u32> = (0..points.len() as u32).filter(is_on_line).collect();
                    [u, line[self.below(line.len())]]
                }
            }
        };
        (0..count).map(constraint).collect()
    }

    /// The triangles without an edge: it is flipped, or its triangles get another corner.
    fn without(&mut self, mesh: &Mesh, triangles: &[u32], [a, b]: Pair) -> Vec<u32> {
        let mut changed = triangles.as_chunks::<3>().0.to_vec();
        let third = |corners: &[u32; 3]| corners.iter().copied().find(|&v| v != a && v != b);
        let has = |corners: &[u32; 3]| corners.contains(&a) && corners.contains(&b);
        let at: Vec<usize> = (0..changed.len()).filter(|&t| has(&changed[t])).collect();
        if let &[s, t] = &at[..]
            && self.one_in(2)
            && let (Some(c), Some(d)) = (third(&changed[s]), third(&changed[t]))
            && c != d
        {
            for (t, from, to) in [(s, b, d), (t, a, c)] {
                changed[t].iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
            }
            return changed.concat();
        }
        for t in at {
            let old = changed[t];
            let new = (0..).map(|_| self.vertex(mesh)).find(|v| !old.contains(v)).unwrap();
            let leaves = [a, b][self.below(2)];
            changed[t].iter_mut().filter(|v| **v == leaves).for_each(|v| *v = new);
        }
        changed.concat()
    }
}

/// The constraints that the audit misses, and its other violations. Triangles that are turned over are no matter here.
fn faults(audit: &Audit) -> (Vec<Pair>, Vec<&Violation>) {
    assert_eq!(audit.unlisted, 0);
    let (mut missing, mut others) = (Vec::new(), Vec::new());
    for violation in &audit.violations {
        match *violation {
            Violation::Constraint { u, v } => missing.push([u, v]),
            Violation::Inverted { .. } => {}
            _ => others.push(violation),
        }
    }
    (missing, others)
}

/// What the rounds have met.
#[derive(Default)]
struct Met {
    constraints: AtomicUsize,
    left_out: AtomicUsize,
    flips: AtomicUsize,
    long: AtomicUsize,
    several: AtomicUsize,
    taken: AtomicUsize,
    replaced: AtomicUsize,
}

/// One random mesh with constraints.
fn round(seed: usize, met: &Met) {
    let mut random =
        Random(Rand64::new((seed as u128).wrapping_mul(0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835)));
    let mesh = random.mesh();
    let constraints = random.constraints(&mesh);
    let options = Options {
        backend: Backend::Cpu,
        order: [Order::Reproducible, Order::Any][random.below(2)],
        threads: NonZeroUsize::new(1),
        constraints,
        constraint_tolerance: [0.0, 0.0, 0.5, 1.0, 2.0][random.below(5)],
        skips_constraints: true,
        ..Options::default()
    };
    let outcome = unwatched(&mesh, &options).unwrap();
    let add = |count: &AtomicUsize, by: usize| count.fetch_add(by, Relaxed);
    let is_in = |i: &usize| outcome.left_out.binary_search_by_key(i, |left| left.index).is_err();
    let kept: Vec<Pair> =
        (0..options.constraints.len()).filter(is_in).map(|i| options.constraints[i]).collect();
    add(&met.constraints, kept.len());
    add(&met.left_out, outcome.left_out.len());
    add(&met.flips, outcome.flips as usize);

    // The result is right.
    let (points, tolerance) = (scaled(&mesh, 1.0), options.constraint_tolerance);
    let present = edges(&outcome.triangles);
    let mut named = outcome.constraint_edges.iter();
    let mut paths = Vec::new();
    for &[u, v] in &kept {
        let (all, mut path, mut at) = (oracle(&points, &present, [u, v], tolerance), Vec::new(), u);
        while at != v {
            let &[from, to] = named.next().unwrap();
            assert_eq!(from, at, "seed {seed}");
            assert!(all.contains(&ordered([from, to])), "seed {seed}: {u}-{v} by {from}-{to}");
            path.push(ordered([from, to]));
            at = to;
        }
        add(&met.long, usize::from(path.len() > 1));
        add(&met.several, usize::from(all.len() > path.len()));
        paths.push(path);
    }
    assert!(named.next().is_none(), "seed {seed}");

    // The audit accepts it.
    let found = audit_outcome(&mesh, &outcome, &options);
    assert_eq!(faults(&found), (vec![], vec![]), "seed {seed}");
    assert_eq!(found.remaining, outcome.remaining, "seed {seed}");
    let alone = Options { constraints: kept.clone(), skips_constraints: false, ..options.clone() };
    assert_eq!(faults(&audit(&mesh, &outcome.triangles, &alone)), (vec![], vec![]), "seed {seed}");

    // It does not without one of the edges, nor if a constraint that was left out is not named.
    for _ in 0..2.min(outcome.constraint_edges.len()) {
        let edge = outcome.constraint_edges[random.below(outcome.constraint_edges.len())];
        let triangles = random.without(&mesh, &outcome.triangles, edge);
        let left = edges(&triangles);
        assert!(!left.contains(&ordered(edge)));
        let lost = kept.iter().zip(&paths).filter(|(_, path)| path.iter().any(|edge| !left.contains(edge)));
        let lost: Vec<Pair> = lost.map(|(&ends, _)| ends).collect();
        assert!(!lost.is_empty());
        let damaged = Outcome { triangles, ..outcome.clone() };
        if lost.len() < 60 {
            assert_eq!(faults(&audit_outcome(&mesh, &damaged, &options)).0, lost, "seed {seed}: {edge:?}");
        }
        let gone: Vec<Pair> =
            kept.iter().copied().filter(|&ends| oracle(&points, &left, ends, tolerance).is_empty()).collect();
        if gone.len() < 60 {
            assert_eq!(faults(&audit(&mesh, &damaged.triangles, &alone)).0, gone, "seed {seed}: {edge:?}");
        }
        add(&met.taken, 1);
        add(&met.replaced, usize::from(gone.len() < lost.len()));
    }
    if !outcome.left_out.is_empty() {
        let mut silent = outcome.clone();
        silent.left_out.remove(random.below(silent.left_out.len()));
        let found = audit_outcome(&mesh, &silent, &options);
        assert!(
            found.violations.iter().any(|found| matches!(found, Violation::Constraint { .. })),
            "seed {seed}"
        );
    }
}

#[test]
fn every_result_passes_and_every_lost_edge_is_found() {
    let (rounds, met) = (rounds(2000) as usize, Met::default());
    on_all_cores(rounds, |seed| round(seed, &met));
    let Met { constraints, left_out, flips, long, several, taken, replaced } = met;
    let [constraints, left_out, flips, long, several, taken, replaced] =
        [constraints, left_out, flips, long, several, taken, replaced].map(AtomicUsize::into_inner);
    println!(
        "{rounds} meshes: {constraints} constraints came in and {left_out} were left out, {flips} flips; {long} paths \
         have several edges, and {several} constraints several paths; {taken} edges were taken away, after {replaced} \
         of these another path was left"
    );
    // In a hundred meshes.
    for (count, least) in [
        (constraints, 1000),
        (left_out, 1000),
        (flips, 500),
        (long, 200),
        (several, 30),
        (taken, 100),
        (replaced, 3),
    ] {
        assert!(count * 100 > rounds * least, "{count} in {rounds} meshes");
    }
}

/// A mesh in the plane whose audit with these constraints names those that are missing. Its triangles are those of a run.
fn missing(mesh: &Mesh, constraints: Vec<Pair>) -> Vec<Pair> {
    faults(&audit(mesh, mesh.triangles(), &Options { constraints, ..Options::default() })).0
}

/// ```text
/// 0 --- 1 --- 2 --- 3 --- …     each edge belongs to a triangle with a corner of its own, and there is an edge from each
///  \_________/ \_________/      vertex to the next but one too
/// ```
#[test]
fn a_search_looks_at_each_vertex_once() {
    // There are more than 2^100 ways along the line. None leads to its end.
    let on_line = 150;
    let mut points: Vec<[f32; 2]> = (0..=on_line).map(|i| [i as f32, 0.0]).collect();
    let mut triangles = Vec::new();
    for (from, to) in (0..on_line - 1).flat_map(|i| [(i, i + 1), (i, i + 2)]).filter(|&(_, to)| to < on_line)
    {
        triangles.push([from, to, points.len() as u32]);
        points.push([from as f32, 1.0]);
    }
    triangles.push([on_line, points.len() as u32 - 1, points.len() as u32 - 2]);
    let mesh = plane(&points, &triangles);
    let (inside, beyond) = ([0, on_line - 1], [0, on_line]);
    assert_eq!(missing(&mesh, vec![inside, beyond]), [beyond]);
    triangles.push([1, on_line, points.len() as u32 - 1]);
    assert!(missing(&plane(&points, &triangles), vec![inside, beyond]).is_empty());
}

/// A fan: its rim is a line of 100,000 edges, and as many constraints end at its hub.
#[test]
fn long_paths_and_many_constraints_take_no_quadratic_time() {
    let count = 100_000;
    let mut points = vec![[0.0, 1.0]];
    points.extend((0..=count).map(|i| [i as f32, 0.0]));
    let triangles: Vec<_> = (1..=count).map(|i| [0, i, i + 1]).collect();
    let mesh = plane(&points, &triangles);
    let spokes = (1..=count + 1).map(|i| [0, i]);
    let rim = [[1, count + 1], [count + 1, 1]];
    assert!(missing(&mesh, spokes.chain(rim).collect()).is_empty());
    assert_eq!(missing(&mesh, vec![[0, 0], [3, count + 2]]), [[0, 0], [3, count + 2]]);
}
