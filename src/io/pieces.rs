//! Reads and writes files in pieces, on several threads. Text is cut at line ends, and output is joined in order. The
//! result does not depend on the number of pieces.

use super::text::{Digits, Lines};
use crate::system::threads::{FEWEST, Threads};
use std::io::{self, Write};
use std::ops::Range;

/// About the fewest bytes of a triangle in a file. It decides which files are too small for several threads.
const TRIANGLE: usize = 16;

/// Items that are formatted before they are written.
const HELD: usize = 1 << 17;

/// Bytes reserved for each item.
const ITEM: usize = 24;

/// A piece of a text.
pub(super) struct Piece<'a> {
    /// The lines, with their numbers in the file.
    pub(super) lines: Lines<'a>,
    /// The range of the file's items in it. If there is only one piece, the end is not counted.
    pub(super) items: Range<u64>,
}

impl<'a> Piece<'a> {
    /// The rest of a text.
    pub(super) fn whole(lines: &Lines<'a>) -> Self {
        Self { lines: lines.clone(), items: 0..u64::MAX }
    }
}

/// The threads for a file of so many bytes.
pub(super) fn threads(bytes: usize) -> Threads {
    Threads::default().for_triangles(bytes / TRIANGLE)
}

/// Cuts the rest of a text into pieces for these threads. `is_item` says whether a line is an item.
pub(super) fn cut<'a>(
    lines: &Lines<'a>,
    is_item: impl Fn(&[u8]) -> bool + Sync,
    threads: &Threads,
) -> Vec<Piece<'a>> {
    let cuts = threads.pieces(lines.bytes_left(), FEWEST);
    if cuts.len() == 1 {
        return vec![Piece::whole(lines)];
    }
    let mut rest = lines.rest;
    let mut texts: Vec<&[u8]> = Vec::new();
    for cut in cuts {
        // A piece includes the whole line in which it would end.
        let mut after = Lines { rest: lines.rest.get(cut.end..).unwrap_or_default(), number: 0 };
        after.next();
        let length = rest.len().saturating_sub(after.rest.len());
        let (text, left) = rest.split_at(length);
        texts.push(text);
        rest = left;
    }
    let counts = threads.map_each(texts.clone(), |text| {
        let mut lines = Lines { rest: text, number: 0 };
        let items = lines.by_ref().filter(|line| is_item(line)).count();
        (lines.number, items as u64)
    });
    let (mut number, mut first) = (lines.number, 0);
    let pieces = texts.into_iter().zip(counts).map(|(rest, (lines, items))| {
        let piece = Piece { lines: Lines { rest, number }, items: first..first + items };
        (number, first) = (number + lines, first + items);
        piece
    });
    pieces.collect()
}

/// Joins the lists of the pieces.
pub(super) fn joined<T: Copy + Send + Sync>(mut lists: Vec<Vec<T>>, threads: &Threads) -> Vec<T> {
    if lists.len() == 1 {
        return lists.pop().unwrap_or_default();
    }
    let mut all = Vec::with_capacity(lists.iter().map(Vec::len).sum());
    lists.into_iter().for_each(|list| threads.append(&mut all, &list));
    all
}

/// Writes `count` items. `write` appends an item to a buffer.
pub(super) fn write(
    count: usize,
    out: &mut (impl Write + ?Sized),
    write: impl Fn(usize, &mut Digits, &mut Vec<u8>) + Sync,
) -> io::Result<()> {
    let threads = Threads::default().for_triangles(count);
    for first in (0..count).step_by(HELD) {
        let parts = threads.map(HELD.min(count - first), |piece| {
            let mut bytes = Vec::with_capacity(ITEM * piece.len());
            let mut digits = Digits::default();
            piece.for_each(|item| write(first + item, &mut digits, &mut bytes));
            bytes
        });
        parts.iter().try_for_each(|part| out.write_all(part))?;
    }
    Ok(())
}
