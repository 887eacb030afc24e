//! Distributes points among columns: intervals of x with about as many points as each other. Rounding only moves the
//! borders of the columns.

use crate::system::threads::{FEWEST, Threads};
use glam::DVec2;
use std::cmp::Ordering;
use std::mem::take;
use std::ops::Range;

/// The most intervals of x that columns are made of.
const MOST_BINS: usize = 1 << 16;

/// The width of a column, in distances of neighbouring points if these are spread evenly. Of a million uniform points,
/// widths from 2 to 4 take the least time.
const WIDTH: f64 = 3.0;

/// A point, and the index that the caller has given it.
#[derive(Clone, Copy, Default)]
pub(super) struct Record {
    pub(super) point: DVec2,
    pub(super) index: u32,
}

impl Record {
    /// The order in a column. The points are finite, and no coordinate is -0.
    #[inline(always)]
    pub(super) fn is_before(&self, other: &Self) -> bool {
        let (p, q) = (self.point, other.point);
        p.y < q.y || (p.y == q.y && (p.x < q.x || (p.x == q.x && self.index < other.index)))
    }

    fn compare(&self, other: &Self) -> Ordering {
        let (p, q) = (self.point, other.point);
        p.y.total_cmp(&q.y).then(p.x.total_cmp(&q.x)).then(self.index.cmp(&other.index))
    }

    /// A record that has the place of these numbers in their order.
    pub(super) fn of([first, second, third]: [u32; 3]) -> Self {
        Self { point: DVec2::new(second.into(), first.into()), index: third }
    }

    /// Sorts by comparing. All that has to do so sorts records, because each type that is sorted makes a module of the npm
    /// package 2 KB larger.
    #[inline(never)]
    pub(super) fn sort(records: &mut [Self]) {
        records.sort_unstable_by(Self::compare);
    }
}

/// Sorts pairs.
pub(super) fn sort_pairs(pairs: &mut [[u32; 2]]) {
    let mut records: Vec<Record> = pairs.iter().map(|&[a, b]| Record::of([a, b, 0])).collect();
    Record::sort(&mut records);
    for (pair, Record { point, .. }) in pairs.iter_mut().zip(records) {
        *pair = [point.y as u32, point.x as u32];
    }
}

/// Equal intervals between two numbers.
pub(super) struct Bins {
    low: f64,
    scale: f64,
    last: u32,
}

impl Bins {
    /// The halves of the numbers do not overflow.
    pub(super) fn new([low, high]: [f64; 2], count: usize) -> Self {
        let last = count as u32 - 1;
        let low = 0.5 * low;
        Self { low, scale: f64::from(last) / (0.5 * high - low), last }
    }

    /// The interval of a number. A larger number is never in a lower one, whatever is rounded: where the scale is
    /// infinite, the lowest number is in the first interval and all others are in the last.
    #[inline(always)]
    pub(super) fn of(&self, x: f64) -> usize {
        (((0.5 * x - self.low) * self.scale) as u32).min(self.last) as usize
    }
}

/// Distributes one or more records, of which `records` gives those in a range. Returns them column by column, and the
/// end of each column.
pub(super) fn distributed<I: Iterator<Item = Record>>(
    records: impl Fn(Range<usize>) -> I + Sync,
    count: usize,
    threads: &Threads,
) -> (Vec<Record>, Vec<u32>) {
    let bins = (2 * count).next_power_of_two().clamp(256, MOST_BINS);
    // The sizes of the bins are at most two words per point.
    let pieces = threads.pieces(count, FEWEST.max(bins / 2));
    let points = |piece: &Range<usize>| records(piece.clone()).map(|record| record.point);
    let empty = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    let extents = threads.map_each(pieces.iter().collect(), |piece| {
        points(piece).fold(empty, |(low, high), p| (low.min(p), high.max(p)))
    });
    let (low, high) =
        extents.into_iter().fold(empty, |(low, high), (lower, higher)| (low.min(lower), high.max(higher)));
    let bins = Bins::new([low.x, high.x], bins);
    // The number of points in each bin, for each piece.
    let sizes = threads.map_each(pieces.iter().collect(), |piece| {
        let mut sizes = vec![0; bins.last as usize + 1];
        points(piece).for_each(|p| sizes[bins.of(p.x)] += 1);
        sizes
    });
    let extent = 0.5 * high - 0.5 * low;
    let (column_of, ends) = columns_of_bins(&sum(&sizes), extent.x / extent.y, count);
    // The number of points in each column, for each piece.
    let sizes = threads.map_each(sizes, |of_bins| {
        let mut sizes = vec![0; ends.len()];
        of_bins.iter().zip(&column_of).for_each(|(size, &column)| sizes[column as usize] += size);
        sizes
    });
    let mut sorted = threads.collect(count, |_| Record::default());
    let parts = pieces.into_iter().zip(places(&mut sorted, &sizes)).collect();
    threads.map_each(parts, |(piece, mut places)| {
        for record in records(piece) {
            if let Some(place) = places[column_of[bins.of(record.point.x)] as usize].next() {
                *place = record;
            }
        }
    });
    (sorted, ends)
}

/// The sums of one or more lists.
fn sum(lists: &[Vec<u32>]) -> Vec<u32> {
    let [first, others @ ..] = lists else { return Vec::new() };
    let mut sums = first.clone();
    for list in others {
        sums.iter_mut().zip(list).for_each(|(sum, x)| *sum += x);
    }
    sums
}

/// The records of each column, for each list of sizes: those of the first list are the first in each column.
fn places<'a>(
    mut records: &'a mut [Record],
    sizes: &[Vec<u32>],
) -> Vec<Vec<std::slice::IterMut<'a, Record>>> {
    let columns = sizes.first().map_or(0, Vec::len);
    let mut places: Vec<_> = sizes.iter().map(|_| Vec::with_capacity(columns)).collect();
    for column in 0..columns {
        for (places, sizes) in places.iter_mut().zip(sizes) {
            let (these, others) = take(&mut records).split_at_mut(sizes[column] as usize);
            places.push(these.iter_mut());
            records = others;
        }
    }
    places
}

/// The column of each bin of the given sizes, and the end of each column. `aspect` is the width of all points divided by
/// their height; there is at least one point.
fn columns_of_bins(sizes: &[u32], aspect: f64, points: usize) -> (Vec<u32>, Vec<u32>) {
    let most = points as f64;
    // It is NaN if all points are equal, and `max` ignores NaN. `clamp` would bring Rust's formatter of floats into the
    // module of the npm package, for the message of a panic: 8 KB.
    let wanted = ((most * aspect.max(1.0 / most).min(most)).sqrt() / WIDTH) as u32;
    let wanted = wanted.clamp(1, sizes.len() as u32);
    let per_point = f64::from(wanted) / most;
    let mut ends = vec![0; wanted as usize];
    let mut column_of = Vec::with_capacity(sizes.len());
    let (mut before, mut column) = (0, 0);
    for &size in sizes {
        // The column of the middle point of the bin.
        let middle = ((f64::from(before) + 0.5 * f64::from(size)) * per_point) as u32;
        while column < middle.min(wanted - 1) {
            ends[column as usize] = before;
            column += 1;
        }
        column_of.push(column);
        before += size;
    }
    ends[column as usize..].fill(before);
    (column_of, ends)
}
