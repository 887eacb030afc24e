//! The decisions of an engine, and its mismatches.

use super::batch::{Batch, Tally};
use std::collections::BTreeMap;

#[derive(Default)]
pub struct Report {
    /// The tally and the number of mismatches, by the form of the mesh, the index and the name of the kind.
    rows: BTreeMap<(String, usize, &'static str), (Tally, usize)>,
    /// A sentence for each mismatch.
    pub mismatches: Vec<String>,
}

impl Report {
    /// Adds a batch. `mismatches` are the wrongly decided quads, each with a sentence.
    pub fn add(&mut self, batch: &Batch, mismatches: Vec<(usize, String)>) {
        for (index, (kind, quads)) in batch.kinds.iter().enumerate() {
            let wrong = mismatches.iter().filter(|(quad, _)| quads.contains(quad)).count();
            let row = self.rows.entry((batch.form(), index, kind)).or_default();
            *row = sum([&*row, &(batch.tally(quads.clone()), wrong)].into_iter());
        }
        self.mismatches.extend(mismatches.into_iter().map(|(_, how)| how));
    }

    /// The number of quads of all kinds.
    pub fn quads(&self) -> usize {
        sum(self.rows.values()).0.quads
    }

    /// A row for each form of meshes and kind, and their sum.
    pub fn table(&self, engine: &str, seconds: f64) -> String {
        let row = |form: &str, kind: &str, (tally, mismatches): &(Tally, usize), seconds: &str| {
            let Tally { quads, ties, labelled, angle, fold, deviation } = tally;
            let of = format!("| {engine} | {form} | {kind} | {quads} | {ties} |");
            format!("{of} {labelled} | {angle} | {fold} | {deviation} | {mismatches} | {seconds} |\n")
        };
        let head = "| engine | mesh | kind | quads | exact ties | labelled | angle | fold | deviation | mismatches | seconds |";
        let rows: String =
            self.rows.iter().map(|((form, _, kind), sums)| row(form, kind, sums, "")).collect();
        let all = row("all", "all", &sum(self.rows.values()), &format!("{seconds:.1}"));
        format!("\n{head}\n|---|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n{rows}{all}")
    }
}

fn sum<'a>(rows: impl Iterator<Item = &'a (Tally, usize)>) -> (Tally, usize) {
    rows.fold(Default::default(), |(sum, wrong), (tally, more)| {
        let tally = Tally {
            quads: sum.quads + tally.quads,
            ties: sum.ties + tally.ties,
            labelled: sum.labelled + tally.labelled,
            angle: sum.angle + tally.angle,
            fold: sum.fold + tally.fold,
            deviation: sum.deviation + tally.deviation,
        };
        (tally, wrong + more)
    })
}
