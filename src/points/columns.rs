//! Sorts points into columns: intervals of x with about as many points as each other, and in each the order by y, then
//! by x. Nothing here decides by a rounded number: rounding only moves the borders of the columns.

use super::insertion::insertion_sorts;
use crate::Positions;
use glam::DVec2;
use std::cmp::Ordering;
use std::ops::Range;

/// The most intervals of x that columns are made of.
const MOST_BINS: usize = 1 << 16;

/// The width of a column, in distances of neighbouring points if these are spread evenly. Of a million uniform points,
/// widths from 2 to 4 take the least time.
const WIDTH: f64 = 3.0;

/// A column that has more than so many times the mean is divided again, but not more often than the other number says:
/// each time, the scale of x is up to 2^16 times as fine.
const MOST_OF_MEAN: usize = 16;
const MOST_LEVELS: u32 = 4;

/// Distinct points, column by column.
pub(super) struct Columns {
    pub(super) points: Vec<DVec2>,
    /// The indices that the caller has given them.
    pub(super) indices: Vec<u32>,
    /// Where each column starts, and the number of points. Each column has at least two points, unless there is only
    /// one. The columns are apart in x.
    pub(super) starts: Vec<u32>,
    /// For each other point its index, and the index of the point that it equals. Sorted.
    pub(super) duplicates: Vec<[u32; 2]>,
}

#[derive(Clone, Copy)]
struct Record {
    point: DVec2,
    index: u32,
}

impl Record {
    /// The order in a column. The points are finite, and no coordinate is -0.
    #[inline(always)]
    fn is_before(&self, other: &Self) -> bool {
        let (p, q) = (self.point, other.point);
        p.y < q.y || (p.y == q.y && (p.x < q.x || (p.x == q.x && self.index < other.index)))
    }

    fn compare(&self, other: &Self) -> Ordering {
        let (p, q) = (self.point, other.point);
        p.y.total_cmp(&q.y).then(p.x.total_cmp(&q.x)).then(self.index.cmp(&other.index))
    }
}

/// Equal intervals between two numbers.
struct Bins {
    low: f64,
    scale: f64,
    last: u32,
}

impl Bins {
    /// The halves of the numbers do not overflow.
    fn new([low, high]: [f64; 2], count: usize) -> Self {
        let last = count as u32 - 1;
        let low = 0.5 * low;
        Self { low, scale: f64::from(last) / (0.5 * high - low), last }
    }

    /// The interval of a number. A larger number is never in a lower one, whatever is rounded: where the scale is
    /// infinite, the lowest number is in the first interval and all others are in the last.
    #[inline(always)]
    fn of(&self, x: f64) -> usize {
        (((0.5 * x - self.low) * self.scale) as u32).min(self.last) as usize
    }
}

impl Columns {
    /// Sorts points in the plane, whose coordinates are finite.
    pub(super) fn of(positions: &Positions) -> Self {
        match positions {
            Positions::F32(numbers) => Self::sorted(numbers.as_chunks().0),
            Positions::F64(numbers) => Self::sorted(numbers.as_chunks().0),
        }
    }

    fn sorted<T: Copy + Into<f64>>(given: &[[T; 2]]) -> Self {
        let mut columns = Self {
            points: Vec::with_capacity(given.len()),
            indices: Vec::with_capacity(given.len()),
            starts: vec![0],
            duplicates: Vec::new(),
        };
        if !given.is_empty() {
            // Adding 0 turns -0 into 0.
            let point = |&[x, y]: &[T; 2]| DVec2::new(x.into(), y.into()) + DVec2::ZERO;
            let records = (0..).zip(given).map(|(index, pair)| Record { point: point(pair), index });
            columns.add_all(distributed(records, given.len()), MOST_LEVELS, &mut Scratch::default());
        }
        columns.finish();
        columns
    }

    /// Adds columns that are not sorted yet to the right of the others. Columns that have far too many points, because
    /// others are far away from them, become columns of their own scale.
    fn add_all(&mut self, (mut records, ends): (Vec<Record>, Vec<u32>), levels: u32, scratch: &mut Scratch) {
        let most = MOST_OF_MEAN * records.len().div_ceil(ends.len());
        let mut start = 0;
        for end in ends {
            let column = &mut records[start as usize..end as usize];
            if column.len() > most && levels > 0 {
                let parts = distributed(column.iter().copied(), column.len());
                self.add_all(parts, levels - 1, scratch);
            } else {
                scratch.sort(column);
                self.add(column);
            }
            start = end;
        }
    }

    /// Adds a sorted column to the right of the others.
    fn add(&mut self, column: &[Record]) {
        let start = self.points.len();
        for record in column {
            match (self.points[start..].last(), self.indices.last()) {
                (Some(&point), Some(&index)) if point == record.point => {
                    self.duplicates.push([record.index, index]);
                }
                _ => {
                    self.points.push(record.point);
                    self.indices.push(record.index);
                }
            }
        }
        let end = self.points.len();
        let open = self.starts.last().map_or(0, |&open| open as usize);
        if open < start {
            // The column before has one point, which joins this one.
            self.place(open, open..end);
        }
        if end > open + 1 {
            self.starts.push(end as u32);
        }
    }

    /// Ends the last column.
    fn finish(&mut self) {
        let end = self.points.len();
        if let [rest @ .., open] = self.starts.as_slice()
            && (*open as usize) < end
        {
            // One point is left. It joins the column before, if there is one.
            if let Some(&start) = rest.last() {
                self.starts.pop();
                self.place(end - 1, start as usize..end);
            }
            self.starts.push(end as u32);
        }
        self.duplicates.sort_unstable();
    }

    /// Moves a point to its place in a column whose other points are sorted.
    fn place(&mut self, at: usize, column: Range<usize>) {
        let moved = self.points[at];
        let is_before = |p: &DVec2| p.y < moved.y || (p.y == moved.y && p.x < moved.x);
        let [below, above] = [column.start..at, at + 1..column.end].map(|others| &self.points[others]);
        let to = column.start + below.partition_point(is_before) + above.partition_point(is_before);
        if at < to {
            self.points[at..=to].rotate_left(1);
            self.indices[at..=to].rotate_left(1);
        } else {
            self.points[to..=at].rotate_right(1);
            self.indices[to..=at].rotate_right(1);
        }
    }
}

/// One or more records by columns, which are not sorted, and the end of each column.
fn distributed(records: impl Iterator<Item = Record> + Clone, count: usize) -> (Vec<Record>, Vec<u32>) {
    let points = || records.clone().map(|record| record.point);
    let (low, high) =
        points().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
    let bins = Bins::new([low.x, high.x], (2 * count).next_power_of_two().clamp(256, MOST_BINS));
    let mut sizes = vec![0; bins.last as usize + 1];
    points().for_each(|p| sizes[bins.of(p.x)] += 1);
    let extent = 0.5 * high - 0.5 * low;
    let (column_of, mut ends) = columns_of_bins(&sizes, extent.x / extent.y, count);
    let mut sorted = vec![Record { point: DVec2::ZERO, index: 0 }; count];
    for record in records {
        let end = &mut ends[column_of[bins.of(record.point.x)] as usize];
        sorted[*end as usize] = record;
        *end += 1;
    }
    (sorted, ends)
}

/// The column of each bin of the given sizes, and the start of each column. `aspect` is the width of all points divided
/// by their height; there is at least one point.
fn columns_of_bins(sizes: &[u32], aspect: f64, points: usize) -> (Vec<u32>, Vec<u32>) {
    let most = points as f64;
    // It is NaN if all points are equal, and NaN becomes 0.
    let wanted = (((most * aspect.clamp(1.0 / most, most)).sqrt() / WIDTH) as u32).max(1);
    let per_point = f64::from(wanted) / most;
    let mut starts = vec![0; wanted as usize];
    let mut column_of = Vec::with_capacity(sizes.len());
    let (mut before, mut column) = (0, 0);
    for &size in sizes {
        // The column of the middle point of the bin.
        let middle = ((f64::from(before) + 0.5 * f64::from(size)) * per_point) as u32;
        while column < middle.min(wanted - 1) {
            column += 1;
            starts[column as usize] = before;
        }
        column_of.push(column);
        before += size;
    }
    starts[column as usize + 1..].fill(before);
    (column_of, starts)
}

/// Memory for sorting a column.
#[derive(Default)]
struct Scratch {
    records: Vec<Record>,
    ends: Vec<u32>,
}

impl Scratch {
    /// Sorts a column by bins of y, and then by insertion. If that takes too long, it compares.
    fn sort(&mut self, column: &mut [Record]) {
        if column.len() > 16 {
            let ys = || column.iter().map(|record| record.point.y);
            let range = [ys().fold(f64::INFINITY, f64::min), ys().fold(f64::NEG_INFINITY, f64::max)];
            let count = column.len().next_power_of_two();
            let bins = Bins::new(range, count);
            self.ends.clear();
            self.ends.resize(count + 1, 0);
            ys().for_each(|y| self.ends[bins.of(y) + 1] += 1);
            let mut sum = 0;
            for end in &mut self.ends {
                sum += *end;
                *end = sum;
            }
            self.records.clear();
            self.records.extend_from_slice(column);
            for record in &self.records {
                let end = &mut self.ends[bins.of(record.point.y)];
                column[*end as usize] = *record;
                *end += 1;
            }
        }
        if !insertion_sorts(column, Record::is_before) {
            column.sort_unstable_by(Record::compare);
        }
    }
}
