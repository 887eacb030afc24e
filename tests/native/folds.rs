//! A sheet whose vertices jump across edges gives the triangles that the npm package gives.
#![cfg(feature = "threads")]

use crate::simulation::Digest;
use edgeflip::{Backend, Dimension, Mesh, Options, Session};
use pollster::block_on;
use std::collections::HashSet;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;

/// Units from a vertex of the sheet at rest to the next.
const UNITS: u32 = 64;

/// As `sheet` in tests/package/folds.mjs.
struct Sheet {
    last: u32,
    at: Vec<[u32; 2]>,
    taken: HashSet<[u32; 2]>,
    seed: u32,
}

impl Sheet {
    fn new(size: u32) -> Self {
        let at: Vec<_> = (0..size * size).map(|v| [UNITS * (v % size), UNITS * (v / size)]).collect();
        let taken = at.iter().copied().collect();
        Self { last: UNITS * (size - 1), at, taken, seed: 1 }
    }

    fn below(&mut self, end: u32) -> u32 {
        self.seed = self.seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.seed >> 8) % end
    }

    /// Moves each vertex inside by up to `most` units in both directions, unless another one is there.
    fn jump(&mut self, most: u32) {
        for v in 0..self.at.len() {
            let from = self.at[v];
            if from.iter().any(|x| x % self.last == 0) {
                continue;
            }
            let to =
                from.map(|x| (x + self.below(2 * most + 1)).saturating_sub(most).clamp(1, self.last - 1));
            if self.taken.insert(to) {
                self.taken.remove(&from);
                self.at[v] = to;
            }
        }
    }

    fn positions(&self) -> Vec<f32> {
        self.at.as_flattened().iter().map(|&x| x as f32 / UNITS as f32).collect()
    }
}

fn triangles(size: u32) -> Vec<u32> {
    let cells = (0..size * (size - 1)).filter(|v| v % size < size - 1);
    cells.flat_map(|v| [v, v + 1, v + size + 1, v, v + size + 1, v + size]).collect()
}

/// `untangle.test.mjs` has the same digest.
#[test]
fn the_package_has_the_same_digest() {
    const SIZE: u32 = 186;
    for threads in [1, 2] {
        let (mut sheet, triangles) = (Sheet::new(SIZE), triangles(SIZE));
        let mut digest = Digest::default();
        digest.feed(&triangles);
        let locked_edges = triangles.chunks(33).map(|corners| [corners[0], corners[1]]).collect();
        let options = Options {
            backend: Backend::Cpu,
            threads: NonZeroUsize::new(threads),
            locked_edges,
            ..Options::default()
        };
        let mesh = Mesh::new(Dimension::Two, sheet.positions(), triangles).unwrap();
        let mut session = block_on(Session::new(mesh, options)).unwrap();
        for most in [20, 90] {
            sheet.jump(most);
            block_on(session.set_positions(sheet.positions())).unwrap();
            block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
            let outcome = block_on(session.outcome()).unwrap();
            assert_eq!((outcome.inverted, outcome.flat), (0, 0));
            digest.feed(&outcome.triangles);
            digest.feed(outcome.lost_edges.as_flattened());
        }
        assert_eq!(digest.to_string(), "ccd193cd60795706");
    }
}
