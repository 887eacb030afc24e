//! Sessions that get any calls in any order, right and wrong ones. After each call, integers decide whether the mesh is
//! legal, whether the counts are right, and whether a mesh that is wrong says so. A second session gets only what changes
//! the first, and has to have the same bits.

use super::census::{Census, census};
use super::components::{Component, components};
use super::motions::Random;
use super::setup::{Places, below, options, ordered};
use super::wild::{moved, outlines, right, scene};
use crate::runs::on_all_cores;
use edgeflip::quality::problems;
use edgeflip::{
    Backend, Dimension, EdgeState, Error, Mesh, Options, Order, Outcome, Positions, Reason, Session, Status,
};
use pollster::block_on;
use std::collections::HashSet;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

struct Game {
    name: String,
    random: Random,
    tested: Session,
    /// Gets no call that fails or only asks.
    witness: Session,
    options: Options,
    /// Whether the session gets 32-bit floats, and whether it may get both.
    is_single: bool,
    takes_both: bool,
    /// The components at the start.
    before: Vec<Component>,
    /// All edges that were locked at the start, each with the smaller vertex first. Sorted.
    locked: Vec<[u32; 2]>,
    /// The positions that the session began with, and those at each later rest.
    rests: Vec<Places>,
    now: Places,
    updates: u64,
    changes: Vec<u32>,
    /// The triangles with which the last rest began.
    at_rest: Vec<u32>,
    /// The locked edges that were lost at the last rest.
    lost: Vec<[u32; 2]>,
    /// Whether the present positions have been untangled.
    is_mended: bool,
    /// What was seen: states at rest of meshes that could be right, and those where something was wrong.
    possible: u64,
    wrong: u64,
}

fn go_on(_: u32, _: u64) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn sides(triangles: &[u32]) -> impl Iterator<Item = [u32; 2]> {
    triangles.chunks(3).flat_map(super::oracle::sides).map(ordered)
}

impl Game {
    fn new(name: String, start: Places, triangles: &[u32], mut random: Random, on_gpu: bool) -> Self {
        let (mut options, mut locked) = options(triangles, &mut random);
        let is_single = matches!(start.positions, Positions::F32(_));
        let mesh = Mesh::new(Dimension::Two, start.positions.clone(), triangles.to_vec()).unwrap();
        let session = |options: &Options| block_on(Session::new(mesh.clone(), options.clone()));
        let mut tested = session(&options).unwrap_or_else(|error| {
            // Constraints may be refused where the mesh is dirty.
            assert!(!options.constraints.is_empty(), "{name}: {error}");
            options.constraints.clear();
            session(&options).unwrap()
        });
        let gpu = on_gpu && is_single && options.order == Order::Reproducible;
        let threads = NonZeroUsize::new(1);
        let backend = if gpu { Backend::Gpu } else { Backend::Cpu };
        let witness = session(&Options { backend, threads, ..options.clone() }).unwrap();
        let outcome = block_on(tested.outcome()).unwrap();
        locked.extend(outcome.constraint_edges.iter().chain(&outcome.lost_edges));
        let mut locked: Vec<_> = locked.into_iter().map(ordered).collect();
        locked.sort_unstable();
        locked.dedup();
        let before = components(triangles);
        let at_start = components(&outcome.triangles);
        assert_eq!(outlines(&before), outlines(&at_start), "{name}");
        let is_mended = options.untangle == Some(true);
        let mut game = Self {
            name,
            random,
            tested,
            witness,
            is_single,
            takes_both: !gpu,
            before: at_start,
            locked,
            rests: vec![start.clone()],
            now: start,
            updates: 0,
            changes: vec![0; if options.track_changes { triangles.len() / 3 } else { 0 }],
            at_rest: outcome.triangles,
            lost: Vec::new(),
            options,
            is_mended,
            possible: 0,
            wrong: 0,
        };
        game.check();
        game
    }

    fn below(&mut self, count: usize) -> usize {
        below(&mut self.random, count)
    }

    fn triangles(&mut self) -> Vec<u32> {
        block_on(self.tested.triangles()).unwrap()
    }

    /// Other positions.
    fn places(&mut self) -> Places {
        let (start, triangles) = (self.rests[0].finite().unwrap(), self.triangles());
        let last = self.now.finite().unwrap_or_else(|| self.rests[0].finite().unwrap());
        if self.below(4) == 0 {
            // Those of an earlier rest.
            let i = self.below(self.rests.len());
            return self.rests[i].clone();
        }
        let mut points = moved(&start, &last, &triangles, &mut self.random);
        if self.below(25) == 0 {
            points = vec![points[0]; points.len()];
        }
        let is_other = self.takes_both && self.below(5) == 0;
        Places::new(points, self.is_single != is_other, &mut self.random)
    }

    /// Some numbers that are not finite.
    fn not_finite(&mut self, mut places: Places) -> Places {
        for _ in 0..1 + self.below(3) {
            let (v, axis, kind) = (self.below(places.points.len()), self.below(2), self.below(3));
            places.points[v] = None;
            let number = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY][kind];
            match &mut places.positions {
                Positions::F32(numbers) => numbers[2 * v + axis] = number as f32,
                Positions::F64(numbers) => numbers[2 * v + axis] = number,
            }
        }
        places
    }

    /// Brings the witness to rest at `places`, and notes that the session has counted from there.
    fn rest(&mut self, places: Places) {
        block_on(self.witness.set_positions(places.positions.clone())).unwrap();
        self.at_rest = block_on(self.witness.triangles()).unwrap();
        self.rests.push(places.clone());
        self.now = places;
        self.updates = 0;
        self.changes.fill(0);
        self.is_mended = self.options.untangle != Some(false);
    }

    fn set_positions(&mut self, places: Places) {
        block_on(self.tested.set_positions(places.positions.clone())).unwrap();
        self.rest(places);
    }

    fn update(&mut self, places: Option<Places>, iterations: u32) {
        let before = self.triangles();
        let positions = places.as_ref().map(|places| places.positions.clone());
        self.tested.update(positions.clone(), iterations).unwrap();
        self.witness.update(positions, iterations).unwrap();
        self.updates += 1;
        self.now = places.unwrap_or_else(|| self.now.clone());
        let (after, changes) = (self.triangles(), block_on(self.tested.changes()).unwrap());
        let pairs = before.chunks(3).zip(after.chunks(3)).map(|(one, other)| one != other);
        let only_flips = self.options.untangle == Some(false);
        assert!(iterations > 0 || !only_flips || before == after, "{}", self.name);
        assert_eq!(changes.len(), self.changes.len(), "{}", self.name);
        for (has_changed, (now, last)) in pairs.zip(changes.iter().zip(&self.changes)) {
            let is_now = u64::from(*now) == self.updates;
            assert!(is_now || now == last && !has_changed, "{}: {now} after {last}", self.name);
        }
        self.changes = changes;
    }

    /// A call that ends a motion. Returns its answer, or `None` where it may not and does not give one.
    fn at_rest<T>(&mut self, call: impl AsyncFnOnce(&mut Session) -> Result<T, Error>) -> Option<T> {
        let answer = block_on(call(&mut self.tested));
        if self.updates == 0 {
            return Some(answer.unwrap());
        }
        if self.now.finite().is_none() {
            let error = answer.err();
            assert!(matches!(error, Some(Error::NonFinite { .. })), "{}: {error:?}", self.name);
            return None;
        }
        let answer = answer.unwrap();
        self.rest(self.now.clone());
        Some(answer)
    }

    /// Calls that fail.
    fn fail(&mut self) {
        let places = self.places();
        let places = self.not_finite(places);
        let set = block_on(self.tested.set_positions(places.positions.clone()));
        assert!(matches!(set, Err(Error::NonFinite { .. })), "{}", self.name);
        let short: Positions = vec![0.0; 2 * places.points.len() + 1].into();
        let set = block_on(self.tested.set_positions(short.clone()));
        assert!(matches!(set, Err(Error::PositionCount { .. })), "{}", self.name);
        let update = self.tested.update(Some(short), 1);
        assert!(matches!(update, Err(Error::PositionCount { .. })), "{}", self.name);
        let update = self.tested.update(Some(places.positions), 65);
        assert!(matches!(update, Err(Error::Option { option: "iterations", .. })), "{}", self.name);
    }

    /// One call, or a few.
    fn turn(&mut self) {
        match self.below(17) {
            0..=2 => {
                let places = self.places();
                self.set_positions(places);
            }
            3..=6 => {
                let mut places = self.places();
                if self.below(5) == 0 {
                    places = self.not_finite(places);
                }
                let iterations = [0, 1, 3, 64][self.below(4)];
                self.update(Some(places), iterations);
            }
            7 => {
                let iterations = self.below(9) as u32;
                self.update(None, iterations);
            }
            8 => self.fail(),
            9 | 10 => {
                if self.at_rest(async |session| session.run(go_on).await).is_some() {
                    block_on(self.witness.run(go_on)).unwrap();
                }
            }
            11 => {
                let stop = |_, _| ControlFlow::Break(());
                self.go_some(async |session| session.run(stop).await);
            }
            12 => self.step(),
            13 => self.go_some(async |session| session.advance().await.map(drop)),
            14 => self.verify(),
            15 => self.ask_problems(),
            _ => self.ask_states(),
        }
        self.check();
    }

    /// Some iterations: engines differ in how many they do at once.
    fn go_some(&mut self, call: impl AsyncFnOnce(&mut Session) -> Result<(), Error>) {
        if self.at_rest(call).is_some() {
            while self.witness.iterations() < self.tested.iterations() {
                block_on(self.witness.step()).unwrap();
            }
        }
    }

    fn step(&mut self) {
        let Some(step) = self.at_rest(Session::step) else { return };
        let same = block_on(self.witness.step()).unwrap();
        let numbers = |step: edgeflip::Iteration| (step.index, step.labelled, step.flips, step.blocked);
        assert_eq!(step.map(numbers), same.map(numbers), "{}", self.name);
    }

    fn verify(&mut self) {
        let Some(audit) = self.at_rest(Session::verify) else { return };
        let outcome = block_on(self.tested.outcome()).unwrap();
        let name = &self.name;
        assert!(audit.violations.is_empty(), "{name}: {:?}", audit.violations);
        assert_eq!([outcome.inverted, outcome.flat], [&audit.inverted, &audit.flat].map(|t| t.len() as u32));
        assert_eq!(outcome.remaining, audit.remaining, "{name}");
        assert_eq!(audit.is_clean(), outcome.inverted == 0, "{name}");
    }

    fn ask_problems(&mut self) {
        let Some(found) = self.at_rest(Session::problems) else { return };
        let points = self.now.finite().unwrap();
        let is_possible = self.before.iter().all(|component| component.obstacle(&points).is_none());
        assert_eq!(found.is_empty(), is_possible, "{}: {found:?}", self.name);
        let (positions, triangles) = (self.now.positions.clone(), self.triangles());
        let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
        assert_eq!(problems(&mesh), found, "{}", self.name);
    }

    fn ask_states(&mut self) {
        let Some(states) = self.at_rest(Session::edge_states) else { return };
        let outcome = block_on(self.tested.outcome()).unwrap();
        let count = |state| states.iter().filter(|s| **s == state).count() as u64;
        let remaining = &outcome.remaining;
        assert_eq!(count(EdgeState::Boundary), outcome.boundary_edges, "{}", self.name);
        assert_eq!(count(EdgeState::Fold), 2 * remaining[Reason::Fold], "{}", self.name);
        assert_eq!(count(EdgeState::Locked), 2 * remaining[Reason::Locked], "{}", self.name);
        assert_eq!(count(EdgeState::Duplicate), 2 * remaining[Reason::Duplicate], "{}", self.name);
        let may_flip = count(EdgeState::Flips) + count(EdgeState::Waits);
        assert_eq!(may_flip, 2 * remaining[Reason::Stopped], "{}", self.name);
    }

    fn check(&mut self) {
        let triangles = self.triangles();
        let name = &self.name;
        assert!(triangles == block_on(self.witness.triangles()).unwrap(), "{name}: not the same triangles");
        let parts = components(&triangles);
        assert_eq!(outlines(&self.before), outlines(&parts), "{name}");
        let rest = self.rests.last().unwrap().finite().unwrap();
        let outcome = (self.updates == 0).then(|| block_on(self.tested.outcome()).unwrap());
        if let Some(outcome) = &outcome {
            self.lost.clone_from(&outcome.lost_edges);
        }
        let mut locked = self.locked.clone();
        locked.retain(|edge| self.lost.binary_search(edge).is_err());
        let exact = census(&parts, &triangles, &self.now.points, (&rest, &self.at_rest), &locked);
        let Some(outcome) = outcome else {
            let counters = block_on(self.tested.counters()).unwrap();
            assert_eq!(counters, block_on(self.witness.counters()).unwrap(), "{name}");
            assert_eq!((counters.updates, counters.too_wide), (self.updates, 0), "{name}");
            let Census { remaining, inverted, flat, undecided, skipped } = exact;
            assert_eq!(counters.remaining, remaining, "{name}");
            let counted = (counters.inverted, counters.flat, counters.undecided, counters.non_finite);
            assert_eq!(counted, (inverted, flat, undecided, skipped), "{name}");
            return;
        };
        let same = block_on(self.witness.outcome()).unwrap();
        let bits = |o: &Outcome| (o.status, o.flips, o.remaining, o.lost_edges.clone(), o.inverted, o.flat);
        assert_eq!(bits(&outcome), bits(&same), "{name}");
        assert_eq!(outcome.flips_per_iteration, same.flips_per_iteration, "{name}");
        self.judge(&parts, &outcome, &exact);
    }

    /// Checks a result.
    fn judge(&mut self, parts: &[Component], outcome: &Outcome, exact: &Census) {
        let name = &self.name;
        let points = self.now.finite().unwrap();
        assert_eq!((outcome.inverted, outcome.flat), (exact.inverted, exact.flat), "{name}");
        let mut remaining = outcome.remaining;
        (remaining[Reason::NonManifold], remaining[Reason::Inconsistent]) = (0, 0);
        assert_eq!(remaining, exact.remaining, "{name}");
        assert_eq!(outcome.status == Status::Done, remaining[Reason::Stopped] == 0, "{name}");
        let present: HashSet<[u32; 2]> = sides(&outcome.triangles).collect();
        let lost: Vec<_> = self.locked.iter().copied().filter(|edge| !present.contains(edge)).collect();
        // Flips may have made a lost edge again.
        assert!(lost.iter().all(|edge| self.lost.binary_search(edge).is_ok()), "{name}: {lost:?}");
        assert!(lost == self.lost || exact.inverted + exact.flat > 0, "{name}: {lost:?} {:?}", self.lost);
        let ends = (3 * outcome.triangles.len() / 3 + outcome.boundary_edges as usize) / 2;
        let frozen = outcome.non_manifold_edges + outcome.inconsistent_edges;
        assert!(frozen > 0 || outcome.edges as usize == ends, "{name}");
        if !self.is_mended {
            return;
        }
        if outcome.status == Status::Done {
            self.possible += right(name, &self.before, &points, outcome, &self.locked) as u64;
        } else {
            let shares = |part: &Component| {
                let others = parts.iter().filter(|other| other.boundary != part.boundary);
                let is_common = |v: &&u32| part.vertices.binary_search(v).is_ok();
                others.map(|other| other.vertices.iter().filter(is_common).count()).any(|n| n > 1)
            };
            for part in parts.iter().filter(|part| part.obstacle(&points).is_none() && !shares(part)) {
                let alone = std::slice::from_ref(part);
                let Census { inverted, flat, .. } =
                    census(alone, &part.triangles, &self.now.points, (&points, &part.triangles), &[]);
                assert_eq!((inverted, flat), (0, 0), "{name}");
            }
        }
        self.wrong += u64::from(exact.inverted + exact.flat > 0);
    }
}

/// Plays one session, or two: the second begins where the first was left.
fn play(seed: u64) -> [u64; 2] {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let (points, mut triangles) = scene(&mut random);
    if triangles.is_empty() {
        return [0; 2];
    }
    let is_single = below(&mut random, 2) == 0;
    let mut places = Places::new(points, is_single, &mut random);
    let mut seen = [0; 2];
    for life in 0..1 + below(&mut random, 2) {
        let name = format!("seed {seed}, life {life}");
        let own = Random(random.next().to_bits() | 1);
        let on_gpu = cfg!(feature = "gpu") && seed.is_multiple_of(40);
        let mut game = Game::new(name, places, &triangles, own, on_gpu);
        for turn in 0..8 + below(&mut random, 16) {
            game.name = format!("seed {seed}, life {life}, turn {turn}");
            game.turn();
        }
        (triangles, places) = (game.triangles(), game.now.clone());
        if places.finite().is_none() {
            places = game.rests[0].clone();
        }
        seen = [seen[0] + game.possible, seen[1] + game.wrong];
    }
    seen
}

#[test]
fn sessions_never_hide_what_is_wrong() {
    let from = std::env::var("EDGEFLIP_SEED").map_or(1, |seed| seed.parse().unwrap());
    let count = if super::is_full() { 20_000 } else { 500 };
    let [possible, wrong] = [0, 0].map(AtomicU64::new);
    on_all_cores(count, |i| {
        let [p, w] = play(from + i as u64);
        possible.fetch_add(p, Relaxed);
        wrong.fetch_add(w, Relaxed);
    });
    println!("{possible:?} components with a triangulation, {wrong:?} results that say what is wrong");
    assert!(possible.into_inner() > 3 * count as u64 && wrong.into_inner() > count as u64 / 2);
}

/// A run ends a motion, also one that may not do an iteration.
#[test]
fn a_run_of_no_iterations_ends_a_motion() {
    let at = |x: f64| vec![0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, x, 2.0];
    let mesh = Mesh::new(Dimension::Two, at(1.0), vec![0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]).unwrap();
    let options = Options { backend: Backend::Cpu, max_iterations: Some(0), ..Options::default() };
    let mut session = block_on(Session::new(mesh, options)).unwrap();
    session.update(Some(at(3.0).into()), 1).unwrap();
    block_on(session.run(go_on)).unwrap();
    assert_eq!(block_on(session.counters()).unwrap().updates, 0);
    session.update(Some(at(f64::NAN).into()), 1).unwrap();
    assert!(matches!(block_on(session.run(go_on)), Err(Error::NonFinite { .. })));
}
