//! Millions of ordinary and adversarial quads: every engine decides them as integers of any size do.
//!
//! `EDGEFLIP_QUADS` is the number of quads for each GPU engine; the CPU gets ten times as many. The tests read no files
//! except their own.
#![cfg(feature = "gpu")]

mod batch;
mod kinds;
mod report;

use crate::runs::on_all_cores;
use batch::{Batch, Tally, batch, batch_count, is_wide};
use edgeflip::{Backend, Error, Options, Reason, Reasons, Session};
use pollster::block_on;
use report::Report;
use serde_json::json;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

/// The number of quads for each GPU engine.
fn quads() -> usize {
    std::env::var("EDGEFLIP_QUADS").map_or(100_000, |quads| quads.parse().unwrap())
}

/// One iteration: the edges that could flip before it, those that could not, and the triangles after it.
async fn iterate(batch: &Batch, backend: Backend) -> Result<(u64, Reasons, Vec<u32>), Error> {
    let options = Options {
        backend,
        max_normal_angle: batch.beta,
        max_deviation: batch.deviation,
        max_iterations: Some(1),
        ..Options::default()
    };
    let mut session = Session::new(batch.mesh.clone(), options).await?;
    let (labelled, blocked) = match session.step().await? {
        Some(iteration) => (u64::from(iteration.labelled), iteration.blocked),
        None => (0, session.outcome().await?.remaining),
    };
    Ok((labelled, blocked, session.triangles().await?))
}

/// The quads that the engine flips or keeps wrongly. If there are none, the first quad that it counts wrongly.
fn mismatches(batch: &Batch, backend: Backend) -> Vec<(usize, String)> {
    let (triangles, is_miscounted) = run(batch, backend);
    let expected = batch.triangles_after();
    let pairs = triangles.chunks(6).zip(expected.chunks(6)).enumerate();
    let mut wrong: Vec<_> = pairs
        .filter(|(_, (found, expected))| found != expected)
        .map(|(quad, (found, _))| (quad, format!("{}, but becomes {found:?}", batch.describe(quad))))
        .collect();
    if is_miscounted && wrong.is_empty() {
        let mut suspects = 0..batch.verdicts.len();
        while suspects.len() > 1 {
            let middle = suspects.start + suspects.len() / 2;
            let (first, second) = (suspects.start..middle, middle..suspects.end);
            suspects = if run(&batch.part(first.clone()), backend).1 { first } else { second };
        }
        let quad = suspects.start;
        wrong.push((quad, format!("{}, but is counted otherwise", batch.describe(quad))));
    }
    wrong
}

/// The triangles after an iteration, and whether the edges are counted wrongly.
fn run(batch: &Batch, backend: Backend) -> (Vec<u32>, bool) {
    let (labelled, blocked, triangles) = block_on(iterate(batch, backend)).unwrap();
    let tally = batch.tally(0..batch.verdicts.len());
    let mut reasons = Reasons::default();
    for (reason, count) in
        [(Reason::Angle, tally.angle), (Reason::Fold, tally.fold), (Reason::Deviation, tally.deviation)]
    {
        reasons[reason] = count as u64;
    }
    (triangles, (labelled, blocked) != (tally.labelled as u64, reasons))
}

/// Makes all batches on all cores, and calls `work` with each. `beyond`: as in [`batch`].
fn for_each_batch(quads: usize, beyond: bool, work: impl Fn(Batch) + Sync) {
    let batches = batch_count(quads);
    on_all_cores(batches, |index| work(batch(index, quads.div_ceil(batches), beyond)));
}

/// Runs all batches on an engine.
fn check(engine: &str, backend: Backend, quads: usize, beyond: bool) {
    let start = Instant::now();
    let report = Mutex::new(Report::default());
    for_each_batch(quads, beyond, |batch| {
        let mismatches = mismatches(&batch, backend);
        report.lock().unwrap().add(&batch, mismatches);
    });
    let report = report.into_inner().unwrap();
    println!("{}", report.table(engine, start.elapsed().as_secs_f64()));
    assert!(report.mismatches.is_empty(), "{}", report.mismatches.join("\n"));
    assert!(report.quads() >= quads);
}

#[test]
fn cpu_decides_as_big_integers_do() {
    check("CPU", Backend::Cpu, 10 * quads(), true);
}

#[test]
fn gpu_decides_as_big_integers_do_within_its_span_and_refuses_the_rest() {
    for index in 0..2 {
        let beyond = batch(index, 1000, true);
        let refused = block_on(iterate(&beyond, Backend::Gpu));
        assert!(matches!(refused, Err(Error::BackendLimit { .. })), "{refused:?}");
    }
    check("GPU", Backend::Gpu, quads(), false);
}

/// Writes files that `quads/browsers.mjs` reads: for each batch `positions` (f64) and `verdicts` (a byte per quad), and
/// one `batches.json` with everything else.
#[test]
fn batches_for_browsers() {
    let folder = Path::new("target/quads");
    fs::create_dir_all(folder).unwrap();
    let index = Mutex::new(BTreeMap::new());
    for_each_batch(quads(), false, |batch| {
        let positions: Vec<_> = batch.mesh.positions().iter().flat_map(f64::to_le_bytes).collect();
        let verdicts: Vec<_> = batch.verdicts.iter().map(|&(verdict, _)| verdict as u8).collect();
        fs::write(folder.join(format!("{}.positions", batch.index)), positions).unwrap();
        fs::write(folder.join(format!("{}.verdicts", batch.index)), verdicts).unwrap();
        let tallies = batch.kinds.iter().map(|(kind, quads)| {
            let Tally { quads, ties, labelled, angle, fold, deviation } = batch.tally(quads.clone());
            json!({ "kind": kind, "quads": quads, "ties": ties, "labelled": labelled, "angle": angle, "fold": fold, "deviation": deviation })
        });
        let tallies: Vec<_> = tallies.collect();
        let dimension = batch.mesh.dimension().stride();
        let deviation = batch.deviation.is_finite().then_some(batch.deviation);
        let entry = json!({ "index": batch.index, "dimension": dimension, "isWide": is_wide(batch.index), "beta": batch.beta, "deviation": deviation, "tallies": tallies });
        index.lock().unwrap().insert(batch.index, entry);
    });
    let entries: Vec<_> = index.into_inner().unwrap().into_values().collect();
    fs::write(folder.join("batches.json"), json!(entries).to_string()).unwrap();
}
