//! What the text formats share: lines with their numbers, tokens, and exact numbers.

use crate::{Error, Positions};
use memchr::{memchr, memchr2};

/// The most bytes of a token that a message quotes.
const QUOTE: usize = 32;

/// The lines of a file, ended by LF, CRLF or CR, with their 1-based numbers.
#[derive(Clone)]
pub(super) struct Lines<'a> {
    pub(super) rest: &'a [u8],
    /// The number of lines before the rest.
    pub(super) number: usize,
}

impl<'a> Lines<'a> {
    /// All lines of `bytes`; a UTF-8 byte order mark is skipped.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), number: 0 }
    }

    /// The number of the line that `next` returned last.
    pub(super) fn number(&self) -> usize {
        self.number.max(1)
    }

    /// Bytes not yet read. They bound every allocation ahead of reading.
    pub(super) fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    /// An error at the current line.
    #[cold]
    pub(super) fn refuse(&self, message: impl Into<String>) -> Error {
        Error::Parse { place: format!("line {}", self.number()), message: message.into() }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let Some(end) = memchr2(b'\n', b'\r', self.rest) else {
            return Some(std::mem::take(&mut self.rest));
        };
        let after = if self.rest[end..].starts_with(b"\r\n") { end + 2 } else { end + 1 };
        let line = &self.rest[..end];
        self.rest = &self.rest[after..];
        Some(line)
    }
}

/// The line up to its comment.
pub(super) fn without_comment(line: &[u8]) -> &[u8] {
    memchr(b'#', line).map_or(line, |i| &line[..i])
}

/// The words of a line, separated by white space.
#[derive(Clone)]
pub(super) struct Tokens<'a>(pub(super) &'a [u8]);

impl<'a> Iterator for Tokens<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let start = self.0.iter().position(|b| !b.is_ascii_whitespace())?;
        let rest = &self.0[start..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        self.0 = &rest[end..];
        Some(&rest[..end])
    }
}

/// A token as messages quote it: on one line, printable, short.
pub(super) fn quoted(token: &[u8]) -> String {
    match token.get(..QUOTE) {
        Some(head) if token.len() > QUOTE => format!("`{}…`", head.escape_ascii()),
        _ => format!("`{}`", token.escape_ascii()),
    }
}

/// The f32 nearest to a decimal number, rounded once; `None` if the token is not a number. Accepts NaN and infinities.
pub(super) fn float(token: &[u8]) -> Option<f32> {
    std::str::from_utf8(token).ok()?.parse().ok()
}

/// A decimal integer, clamped to 64 bits; `None` if the token is not an integer.
pub(super) fn integer(token: &[u8]) -> Option<i64> {
    let (negative, digits) = match token {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value = 0_i64;
    for &b in digits {
        if !b.is_ascii_digit() {
            return None;
        }
        value = value.saturating_mul(10).saturating_add(i64::from(b - b'0'));
    }
    Some(if negative { -value } else { value })
}

/// Formats numbers with the fewest digits that read back to the same bits.
#[derive(Default)]
pub(super) struct Digits {
    float: zmij::Buffer,
    integer: itoa::Buffer,
}

impl Digits {
    /// Appends the finite number at `i`: `1`, `-0`, `0.1`, `1e-45`.
    pub(super) fn coordinate(&mut self, line: &mut Vec<u8>, positions: &Positions, i: usize) {
        let text = match positions {
            Positions::F32(numbers) => self.float.format_finite(numbers[i]),
            Positions::F64(numbers) => self.float.format_finite(numbers[i]),
        };
        line.extend_from_slice(text.strip_suffix(".0").unwrap_or(text).as_bytes());
    }

    /// Appends an integer.
    pub(super) fn integer(&mut self, line: &mut Vec<u8>, i: u64) {
        line.extend_from_slice(self.integer.format(i).as_bytes());
    }
}
