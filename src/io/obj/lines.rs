//! Lines that are continued after a backslash.

use crate::io::text::{Lines, without_comment};
use std::borrow::Cow;

/// Joins a line with its continuation lines. Returns the joined line, and the last of its lines.
pub(super) fn continued<'a>(line: &'a [u8], lines: &mut Lines<'a>) -> (Cow<'a, [u8]>, &'a [u8]) {
    let Some(start) = line.strip_suffix(b"\\") else { return (Cow::Borrowed(line), line) };
    let mut joined = start.to_vec();
    let mut last = line;
    for line in lines {
        joined.push(b' ');
        last = without_comment(line);
        let start = last.strip_suffix(b"\\");
        joined.extend_from_slice(start.unwrap_or(last));
        if start.is_none() {
            break;
        }
    }
    (Cow::Owned(joined), last)
}
