//! The oracle for the engines: the rules of the flips, one after another, as plainly as possible.
//! It collects the edges again before every iteration, and every number is an integer of any size.

mod digest;
mod predicates;

pub use digest::{Digest, Expected, digests_path, expected};
pub use predicates::{Predicates, Verdict};

use edgeflip::quality::RemainingEdge;
use edgeflip::{Dimension, Mesh, Options, Reason, Reasons};
use num_bigint::{BigInt, Sign};
use std::collections::{BTreeMap, HashMap, HashSet};

/// More iterations than any test needs.
const ENDLESS: u32 = 100_000;

/// One iteration that flipped something.
#[derive(Clone, Debug, PartialEq)]
pub struct IterationRecord {
    /// Non-Delaunay edges that may flip, before it.
    pub labelled: u32,
    /// Edges flipped.
    pub flips: u32,
    /// Non-Delaunay edges between two consistent triangles that may not flip, before it: `angle`, `fold`,
    /// `duplicate`, `locked` and `deviation` only.
    pub blocked: Reasons,
    /// The digest of the triangles of the input and after every iteration up to this one.
    pub digest: Digest,
}

/// A whole run.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    pub iterations: Vec<IterationRecord>,
    /// The triangles after the last iteration.
    pub triangles: Vec<u32>,
    /// Non-Delaunay edges after the last iteration.
    pub remaining: Reasons,
    /// The digest of the triangles of the input and after every iteration.
    pub digest: Digest,
}

impl Simulation {
    pub fn flips(&self) -> u64 {
        self.iterations.iter().map(|record| u64::from(record.flips)).sum()
    }

    pub fn labelled(&self) -> u64 {
        self.iterations.iter().map(|record| u64::from(record.labelled)).sum()
    }
}

fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

fn prev(h: u32) -> u32 {
    next(next(h))
}

fn pair(u: u32, v: u32) -> (u32, u32) {
    (u.min(v), u.max(v))
}

/// A bijection of the 32-bit numbers: no two edges have the same key.
fn key(edge: u32, iteration: u32) -> u32 {
    let mut x = edge ^ iteration.wrapping_mul(0x9E37_79B9);
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ x >> 16
}

/// All half-edges of each pair of vertices.
fn edges(triangles: &[u32]) -> HashMap<(u32, u32), Vec<u32>> {
    let mut edges: HashMap<(u32, u32), Vec<u32>> = HashMap::new();
    for h in 0..triangles.len() as u32 {
        let ends = pair(triangles[h as usize], triangles[next(h) as usize]);
        edges.entry(ends).or_default().push(h);
    }
    edges
}

/// The class of the half-edges of one pair of vertices.
enum Kind {
    Boundary,
    /// The lower half-edge first.
    Twins(u32, u32),
    Frozen(Reason),
}

fn kind(triangles: &[u32], half_edges: &[u32]) -> Kind {
    match *half_edges {
        [_] => Kind::Boundary,
        [h, g] if h / 3 == g / 3 => Kind::Frozen(Reason::NonManifold),
        [h, g] if triangles[h as usize] == triangles[g as usize] => Kind::Frozen(Reason::Inconsistent),
        [h, g] => Kind::Twins(h, g),
        _ => Kind::Frozen(Reason::NonManifold),
    }
}

/// a, b, c, d of the twins h < g: the triangles are (a, b, c) and (b, a, d).
fn quad(triangles: &[u32], h: u32, g: u32) -> [u32; 4] {
    [h, next(h), prev(h), prev(g)].map(|x| triangles[x as usize])
}

/// For each triangle whether the signed area of its edge-connected component is negative (2D).
fn clockwise(mesh: &Mesh, predicates: &Predicates) -> Vec<bool> {
    let triangles = mesh.triangles();
    if mesh.dimension() == Dimension::Three {
        return vec![false; mesh.triangle_count()];
    }
    let mut neighbours = vec![Vec::new(); mesh.triangle_count()];
    for half_edges in edges(triangles).values() {
        if let Kind::Twins(h, g) = kind(triangles, half_edges) {
            neighbours[h as usize / 3].push(g as usize / 3);
            neighbours[g as usize / 3].push(h as usize / 3);
        }
    }
    let mut clockwise = vec![false; mesh.triangle_count()];
    let mut seen = vec![false; mesh.triangle_count()];
    for start in 0..mesh.triangle_count() {
        if seen[start] {
            continue;
        }
        let (mut component, mut stack) = (HashSet::from([start]), vec![start]);
        while let Some(t) = stack.pop() {
            stack.extend(neighbours[t].iter().filter(|&&s| component.insert(s)));
        }
        let area: BigInt =
            component.iter().map(|&t| predicates.area([0, 1, 2].map(|k| triangles[3 * t + k]))).sum();
        for t in component {
            seen[t] = true;
            clockwise[t] = area.sign() == Sign::Minus;
        }
    }
    clockwise
}

/// The edges of one state.
struct Labels {
    /// For every edge that may flip, by its lower half-edge: the two vertices that the flip would join.
    labelled: BTreeMap<u32, (u32, u32)>,
    /// For these edges: the upper half-edge by the lower one.
    twins: BTreeMap<u32, u32>,
    /// Non-Delaunay edges with twins that may not flip, by their ends.
    blocked: BTreeMap<(u32, u32), Reason>,
    /// Non-Delaunay edges that are frozen.
    frozen: BTreeMap<(u32, u32), Reason>,
}

impl Labels {
    /// All non-Delaunay edges, in ascending order of their ends.
    fn remaining(&self, triangles: &[u32]) -> Vec<RemainingEdge> {
        let ends = |(&h, &g): (&u32, &u32)| pair(triangles[h as usize], triangles[g as usize]);
        let stopped = self.twins.iter().map(|twins| (ends(twins), Reason::Stopped)).collect();
        let all: BTreeMap<_, _> = [&self.blocked, &self.frozen, &stopped].into_iter().flatten().collect();
        all.into_iter().map(|(&(u, v), &reason)| RemainingEdge { u, v, reason }).collect()
    }
}

struct Rules {
    predicates: Predicates,
    clockwise: Vec<bool>,
    /// Edges of the input over β: they stay.
    creases: HashSet<(u32, u32)>,
    /// Locked edges: they stay.
    locked: HashSet<(u32, u32)>,
    /// The verdicts found so far. A verdict depends only on the four vertices and the orientation.
    verdicts: HashMap<([u32; 4], bool), Verdict>,
}

impl Rules {
    fn new(mesh: &Mesh, options: &Options) -> Self {
        let triangles = mesh.triangles();
        let predicates = Predicates::new(mesh, options.max_normal_angle, options.max_deviation);
        let clockwise = clockwise(mesh, &predicates);
        let creases = edges(triangles)
            .into_iter()
            .filter(|(_, half_edges)| match kind(triangles, half_edges) {
                Kind::Twins(h, g) => predicates.is_sharp(quad(triangles, h, g)),
                _ => false,
            })
            .map(|(ends, _)| ends)
            .collect();
        let locked = options.locked_edges.iter().map(|&[u, v]| pair(u, v)).collect();
        Self { predicates, clockwise, creases, locked, verdicts: HashMap::new() }
    }

    fn label(&mut self, triangles: &[u32]) -> Labels {
        let edges = edges(triangles);
        let mut labels = Labels {
            labelled: BTreeMap::new(),
            twins: BTreeMap::new(),
            blocked: BTreeMap::new(),
            frozen: BTreeMap::new(),
        };
        for (&ends, half_edges) in &edges {
            match kind(triangles, half_edges) {
                Kind::Boundary => {}
                Kind::Frozen(reason) => {
                    if self.frozen_excess(triangles, half_edges) {
                        labels.frozen.insert(ends, reason);
                    }
                }
                Kind::Twins(h, g) => {
                    let quad = quad(triangles, h, g);
                    let clockwise = self.clockwise[h as usize / 3];
                    let predicates = &self.predicates;
                    let verdict = *self
                        .verdicts
                        .entry((quad, clockwise))
                        .or_insert_with(|| predicates.verdict(quad, clockwise));
                    let [_, _, c, d] = quad;
                    let mut block = |reason| _ = labels.blocked.insert(ends, reason);
                    let duplicate = c == d || edges.contains_key(&pair(c, d));
                    match verdict {
                        None => {}
                        Some(_) if self.locked.contains(&ends) => block(Reason::Locked),
                        Some(_) if self.creases.contains(&ends) => block(Reason::Angle),
                        Some(Err(reason)) => block(reason),
                        Some(Ok(())) if duplicate => block(Reason::Duplicate),
                        Some(Ok(())) => {
                            labels.labelled.insert(h, pair(c, d));
                            labels.twins.insert(h, g);
                        }
                    }
                }
            }
        }
        labels
    }

    fn frozen_excess(&self, triangles: &[u32], half_edges: &[u32]) -> bool {
        let corners = |h: u32| [h, next(h), prev(h)].map(|x| triangles[x as usize]);
        let pairs = half_edges.iter().flat_map(|&h| half_edges.iter().map(move |&g| (h, g)));
        pairs.filter(|(h, g)| h / 3 < g / 3).any(|(h, g)| self.predicates.exceeds_pi(corners(h), corners(g)))
    }
}

/// The edges to flip. Each is the best of both its triangles. Of edges whose flips would make the same new edge, only
/// the one with the smallest key flips.
fn select(labels: &Labels, iteration: u32) -> Vec<(u32, u32)> {
    let mut best: HashMap<u32, u32> = HashMap::new();
    for (&h, &g) in &labels.twins {
        for t in [h / 3, g / 3] {
            let edge = best.entry(t).or_insert(h);
            if key(h, iteration) < key(*edge, iteration) {
                *edge = h;
            }
        }
    }
    let selected = labels.twins.iter().filter(|&(h, g)| best[&(h / 3)] == *h && best[&(g / 3)] == *h);
    let mut makers: BTreeMap<(u32, u32), (u32, u32)> = BTreeMap::new();
    for (&h, &g) in selected {
        let maker = makers.entry(labels.labelled[&h]).or_insert((h, g));
        if key(h, iteration) < key(maker.0, iteration) {
            *maker = (h, g);
        }
    }
    makers.into_values().collect()
}

/// Runs the rules on `mesh` with the threshold β to the end, or for `max_iterations`.
pub fn simulate(mesh: &Mesh, beta_deg: f64, max_iterations: Option<u32>) -> Simulation {
    let options = Options { max_normal_angle: beta_deg, max_iterations, ..Options::default() };
    simulate_with(mesh, &options)
}

/// The same with all options that affect the flips, except locked triangles and groups.
pub fn simulate_with(mesh: &Mesh, options: &Options) -> Simulation {
    let mut triangles = mesh.triangles().to_vec();
    let mut rules = Rules::new(mesh, options);
    let mut digest = Digest::default();
    digest.feed(&triangles);
    let mut iterations = Vec::new();
    for iteration in 0.. {
        assert!(iteration < ENDLESS, "the simulation does not end");
        let labels = rules.label(&triangles);
        let flips =
            if options.max_iterations == Some(iteration) { Vec::new() } else { select(&labels, iteration) };
        if flips.is_empty() {
            let remaining = labels.remaining(&triangles).iter().map(|edge| edge.reason).collect();
            return Simulation { iterations, triangles, remaining, digest };
        }
        for &(h, g) in &flips {
            let [_, _, c, d] = quad(&triangles, h, g);
            triangles[next(h) as usize] = d;
            triangles[next(g) as usize] = c;
        }
        digest.feed(&triangles);
        iterations.push(IterationRecord {
            labelled: labels.labelled.len() as u32,
            flips: flips.len() as u32,
            blocked: labels.blocked.into_values().collect(),
            digest,
        });
    }
    unreachable!("the iterations have no upper end")
}

/// The non-Delaunay edges of `triangles`, a state that flips of `mesh` led to, in ascending order of their ends.
pub fn remaining_edges(mesh: &Mesh, triangles: &[u32], options: &Options) -> Vec<RemainingEdge> {
    Rules::new(mesh, options).label(triangles).remaining(triangles)
}
