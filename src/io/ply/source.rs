//! The numbers after the header of a PLY file, as text or binary.

use super::header::{Encoding, Property, Scalar};
use crate::Error;
use crate::io::coordinates::Reading;
use crate::io::text::{Lines, Tokens, integer, quoted};

/// A source of records of numbers.
pub(super) trait Source<'a> {
    /// Moves to the next record; false at the end of the file.
    fn begin(&mut self) -> bool;
    /// The next number of the record. An f64 holds every number of a PLY file.
    fn number(&mut self, scalar: Scalar) -> Result<f64, Error>;
    /// Skips the next `count` numbers.
    fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), Error>;
    /// Skips a whole record of these properties.
    fn pass(&mut self, properties: &[Property]) -> Result<(), Error>;
    /// The rest of the record (text) or of the file (binary).
    fn rest(&self) -> &'a [u8];
    /// Refuses further numbers in the record.
    fn end(&mut self) -> Result<(), Error>;
    /// Refuses further bytes after the last record.
    fn finish(&mut self) -> Result<(), Error>;
    /// An error at the number that was read last.
    fn refuse(&self, message: impl Into<String>) -> Error;
    /// Bytes not yet read.
    fn bytes_left(&self) -> usize;
    /// The fewest bytes of a number.
    fn least(&self, scalar: Scalar) -> usize;
    /// Whether a 32-bit float was read that does not show the digits of the file.
    fn loses(&self) -> bool {
        false
    }
}

/// Text, one line per record.
pub(super) struct Ascii<'a> {
    lines: Lines<'a>,
    words: Tokens<'a>,
    reading: Reading,
}

impl<'a> Ascii<'a> {
    /// The lines after a header. `asks`: whether to ask if 32-bit floats show the digits of the file.
    pub(super) fn new(lines: Lines<'a>, asks: bool) -> Self {
        Self { lines, words: Tokens(b""), reading: Reading { asks, loses: false } }
    }
}

impl<'a> Source<'a> for Ascii<'a> {
    fn begin(&mut self) -> bool {
        let line = self.lines.find(|line| !line.trim_ascii().is_empty());
        self.words = Tokens(line.unwrap_or_default());
        line.is_some()
    }

    fn number(&mut self, scalar: Scalar) -> Result<f64, Error> {
        let word = self
            .words
            .next()
            .ok_or_else(|| self.refuse("expected another number, found the end of the line"))?;
        let number = match scalar {
            Scalar::F32 => self.reading.nearest::<f32>(word).map(f64::from),
            Scalar::F64 => std::str::from_utf8(word).ok().and_then(|word| word.parse().ok()),
            _ => integer(word)
                .filter(|i| (i64::from(i32::MIN)..=i64::from(u32::MAX)).contains(i))
                .map(|i| i as f64),
        };
        let expected = if scalar.is_integer() { "an integer of at most 32 bits" } else { "a number" };
        number.ok_or_else(|| self.refuse(format!("expected {expected}, found {}", quoted(word))))
    }

    fn skip(&mut self, _: Scalar, count: u64) -> Result<(), Error> {
        // A skipped number may be of any type, whatever the header says.
        (0..count).try_for_each(|_| self.number(Scalar::F64).map(drop))
    }

    fn pass(&mut self, _: &[Property]) -> Result<(), Error> {
        self.begin();
        Ok(())
    }

    fn rest(&self) -> &'a [u8] {
        self.words.0
    }

    fn end(&mut self) -> Result<(), Error> {
        match self.words.next() {
            Some(word) => Err(self.refuse(format!("expected the end of the line, found {}", quoted(word)))),
            None => Ok(()),
        }
    }

    fn finish(&mut self) -> Result<(), Error> {
        if self.begin() {
            let found = quoted(self.words.0.trim_ascii());
            return Err(
                self.refuse(format!("expected the end of the file after the last element, found {found}"))
            );
        }
        Ok(())
    }

    fn refuse(&self, message: impl Into<String>) -> Error {
        self.lines.refuse(message)
    }

    fn bytes_left(&self) -> usize {
        self.lines.bytes_left()
    }

    fn least(&self, _: Scalar) -> usize {
        2 // a digit and a separator
    }

    fn loses(&self) -> bool {
        self.reading.loses
    }
}

/// Binary numbers without gaps.
pub(super) struct Binary<'a> {
    rest: &'a [u8],
    /// The length of the file.
    length: usize,
    /// The offset of the number that was read last.
    at: usize,
    big_endian: bool,
}

impl<'a> Binary<'a> {
    /// The numbers of `file` from byte `start` on.
    pub(super) fn new(file: &'a [u8], start: usize, big_endian: bool) -> Self {
        Self { rest: &file[start..], length: file.len(), at: start, big_endian }
    }

    #[inline]
    fn bytes(&mut self, count: u64) -> Result<&'a [u8], Error> {
        self.at = self.length - self.rest.len();
        match usize::try_from(count).ok().and_then(|count| self.rest.split_at_checked(count)) {
            Some((bytes, rest)) => {
                self.rest = rest;
                Ok(bytes)
            }
            None => {
                let left = self.rest.len();
                Err(self.refuse(format!("expected {count} more bytes, but the file ends after {left}")))
            }
        }
    }

    #[inline]
    fn array<const N: usize>(&mut self) -> Result<[u8; N], Error> {
        let mut array = [0; N];
        array.copy_from_slice(self.bytes(N as u64)?);
        if self.big_endian {
            array.reverse();
        }
        Ok(array)
    }
}

impl<'a> Source<'a> for Binary<'a> {
    fn begin(&mut self) -> bool {
        self.at = self.length - self.rest.len();
        !self.rest.is_empty()
    }

    #[inline]
    fn number(&mut self, scalar: Scalar) -> Result<f64, Error> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.array()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.array()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.array()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.array()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.array()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.array()?).into(),
            Scalar::F32 => f32::from_le_bytes(self.array()?).into(),
            Scalar::F64 => f64::from_le_bytes(self.array()?),
        })
    }

    fn skip(&mut self, scalar: Scalar, count: u64) -> Result<(), Error> {
        self.bytes(count.saturating_mul(scalar.size() as u64)).map(drop)
    }

    fn pass(&mut self, properties: &[Property]) -> Result<(), Error> {
        properties.iter().try_for_each(|&Property { length, scalar, .. }| {
            let count = length.map_or(Ok(1.0), |length| self.number(length))?;
            self.skip(scalar, count as u64)
        })
    }

    fn rest(&self) -> &'a [u8] {
        self.rest
    }

    fn end(&mut self) -> Result<(), Error> {
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Error> {
        if !self.rest.trim_ascii().is_empty() {
            self.begin();
            let left = self.rest.len();
            return Err(self.refuse(format!(
                "expected the end of the file after the last element, found {left} more bytes"
            )));
        }
        Ok(())
    }

    #[cold]
    fn refuse(&self, message: impl Into<String>) -> Error {
        Error::Parse { place: format!("byte {}", self.at), message: message.into() }
    }

    fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    fn least(&self, scalar: Scalar) -> usize {
        scalar.size()
    }
}

/// The numbers of a binary file, after the lines of its header.
pub(super) fn binary<'a>(bytes: &'a [u8], lines: &Lines, encoding: Encoding) -> Binary<'a> {
    let mut start = bytes.len() - lines.bytes_left();
    // If the lines of the header end with CR alone, a LF after the header is the first byte of a number.
    let ends_with_cr = bytes.starts_with(b"ply\r") && !bytes.starts_with(b"ply\r\n");
    start -= usize::from(ends_with_cr && bytes[..start].ends_with(b"\r\n"));
    Binary::new(bytes, start, encoding == Encoding::BigEndian)
}
