//! The wall times of a run, for its report.

use edgeflip::Timings;
use serde::Serialize;
use std::mem;

/// Wall times in milliseconds. All parts add up to the total. `null` for a part that was skipped.
#[derive(Default, Serialize)]
pub struct Milliseconds {
    pub start: f64,
    pub load: f64,
    pub prepare: f64,
    pub device: f64,
    pub constraints: f64,
    pub upload: f64,
    pub adjacency: f64,
    pub flip: f64,
    pub count: f64,
    pub measure: Option<f64>,
    pub verify: Option<f64>,
    pub save: Option<f64>,
    pub total: f64,
}

impl Milliseconds {
    /// Adds the times of the library, rounded to microseconds. What is left of `lap` counts as `count`.
    pub fn of_run(&mut self, &Timings { constraints, upload, adjacency, flip, .. }: &Timings, lap: f64) {
        let count = lap - constraints - upload - adjacency - flip;
        let [constraints, upload, adjacency, flip, count] =
            [constraints, upload, adjacency, flip, count].map(|ms| (ms * 1e3).round() / 1e3);
        *self = Self { constraints, upload, adjacency, flip, count, ..mem::take(self) };
    }

    /// The parts that were done, with their names.
    pub fn parts(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let &Self { start, load, prepare, device, constraints, upload, adjacency, flip, count, .. } = self;
        let all = [
            ("start", Some(start)),
            ("load", Some(load)),
            ("prepare", Some(prepare)),
            ("device", Some(device)),
            ("constraints", Some(constraints)),
            ("upload", Some(upload)),
            ("adjacency", Some(adjacency)),
            ("flips", Some(flip)),
            ("count", Some(count)),
            ("measure", self.measure),
            ("verify", self.verify),
            ("save", self.save),
        ];
        all.into_iter().filter_map(|(name, ms)| Some((name, ms?)))
    }
}
