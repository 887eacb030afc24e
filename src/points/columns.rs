//! Sorts points into columns, and in each by y, then by x. Nothing here decides by a rounded number.

use super::distribution::{Bins, Record, distributed};
use super::groups::{groups, split, start};
use super::insertion::insertion_sorts;
use crate::system::threads::Threads;
use crate::{NONE, Positions};
use glam::DVec2;
use std::mem::{replace, take};
use std::ops::Range;

/// A column that has more than so many times the mean is divided again, but not more often than the other number says:
/// each time, the scale of x is up to 2^16 times as fine.
const MOST_OF_MEAN: usize = 16;
const MOST_LEVELS: u32 = 4;

/// Distinct points, column by column.
#[derive(Default)]
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

impl Columns {
    /// Sorts points in the plane, whose coordinates are finite.
    pub(super) fn of(positions: &Positions, threads: &Threads) -> Self {
        match positions {
            Positions::F32(numbers) => {
                let wide = threads.collect(numbers.len(), |i| f64::from(numbers[i]));
                Self::sorted(wide.as_chunks().0, threads)
            }
            Positions::F64(numbers) => Self::sorted(numbers.as_chunks().0, threads),
        }
    }

    fn sorted(given: &[[f64; 2]], threads: &Threads) -> Self {
        let mut columns = Self::default();
        columns.reserve(given.len());
        if !given.is_empty() {
            // Adding 0 turns -0 into 0.
            let point = |&pair: &[f64; 2]| DVec2::from(pair) + DVec2::ZERO;
            let records = |piece: Range<usize>| {
                let indices = piece.start as u32..;
                indices.zip(&given[piece]).map(|(index, pair)| Record { point: point(pair), index })
            };
            let (mut records, ends) = distributed(records, given.len(), threads);
            columns.add_all(&mut records, &ends, MOST_LEVELS, threads);
        }
        columns.join_single();
        if !columns.duplicates.is_empty() {
            columns.sort_duplicates(given.len());
        }
        columns
    }

    /// Each point has one pair at most.
    fn sort_duplicates(&mut self, count: usize) {
        let mut equal = vec![NONE; count];
        for &[index, first] in &self.duplicates {
            equal[index as usize] = first;
        }
        self.duplicates.clear();
        let pairs = (0..).zip(equal).filter(|&(_, first)| first != NONE);
        self.duplicates.extend(pairs.map(|(index, first)| [index, first]));
    }

    /// Adds columns, which are not sorted yet and have these ends, to the right of the others.
    fn add_all(&mut self, records: &mut [Record], ends: &[u32], levels: u32, threads: &Threads) {
        let most = MOST_OF_MEAN * records.len().div_ceil(ends.len());
        let groups = groups(ends, threads);
        if groups.len() == 1 {
            return self.add_each(records, ends.iter().copied(), most, levels, threads);
        }
        let parts = split(records, ends, &groups).into_iter().zip(groups).collect();
        let parts = threads.map_each(parts, |(records, group)| {
            let mut part = Self::default();
            let first = start(ends, group.start) as u32;
            part.add_each(records, ends[group].iter().map(|end| end - first), most, levels, threads);
            part
        });
        self.reserve(parts.iter().map(|part| part.points.len()).sum());
        for part in parts {
            let first = self.points.len() as u32;
            threads.append(&mut self.points, &part.points);
            threads.append(&mut self.indices, &part.indices);
            self.starts.extend(part.starts.iter().map(|start| first + start));
            self.duplicates.extend(part.duplicates);
        }
    }

    /// Adds each of the columns. Those that have more points than `most`, because others are far away from them, become
    /// columns of their own scale.
    fn add_each(
        &mut self,
        records: &mut [Record],
        ends: impl Iterator<Item = u32> + Clone,
        most: usize,
        levels: u32,
        threads: &Threads,
    ) {
        let most = if levels > 0 { most } else { usize::MAX };
        let columns = ends.scan(0, |start, end| Some(replace(start, end) as usize..end as usize));
        self.reserve(columns.clone().map(|column| column.len()).filter(|&len| len <= most).sum());
        let mut scratch = Scratch::default();
        for column in columns {
            let column = &mut records[column];
            if column.len() > most {
                let records = |piece: Range<usize>| column[piece].iter().copied();
                let (sorted, ends) = distributed(records, column.len(), threads);
                column.copy_from_slice(&sorted);
                drop(sorted);
                self.add_all(column, &ends, levels - 1, threads);
            } else {
                scratch.sort(column);
                self.add(column);
            }
        }
    }

    /// Adds a sorted column.
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
        if start < self.points.len() {
            self.starts.push(start as u32);
        }
    }

    /// Allocates memory for so many points.
    fn reserve(&mut self, count: usize) {
        self.points.reserve(count);
        self.indices.reserve(count);
    }

    /// Joins each column of one point to the column after it, and the last one to the column before it. Adds the number
    /// of points to the starts.
    fn join_single(&mut self) {
        let count = self.points.len();
        let starts = take(&mut self.starts);
        let ends = starts.iter().skip(1).map(|&end| end as usize).chain([count]);
        self.starts.push(0);
        let mut open = 0;
        for (&start, end) in starts.iter().zip(ends) {
            if open < start as usize {
                self.place(open, open..end);
            }
            if end > open + 1 {
                self.starts.push(end as u32);
                open = end;
            }
        }
        if open < count {
            if let [.., before, _] = *self.starts {
                self.starts.pop();
                self.place(open, before as usize..count);
            }
            self.starts.push(count as u32);
        }
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
            Record::sort(column);
        }
    }
}
