//! Gzip'd files. The reader recognizes them by their first bytes, the writer by their name.

use super::options::ReadOptions;
use crate::Error;
use crate::system::memory;
use flate2::Compression;
use flate2::bufread::GzDecoder;
use flate2::write::GzEncoder;
use std::io::{self, Read, Write};
use std::path::Path;

/// The first allocation, in bytes.
const FIRST: u64 = 1 << 16;

/// Whether these are the bytes of a gzip'd file.
pub(super) fn is_magic(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// The extension, in lower case.
pub(super) fn extension(path: &Path) -> Option<String> {
    path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase)
}

/// Whether the path names a gzip'd file.
pub(super) fn is_named(path: &Path) -> bool {
    extension(path).as_deref() == Some("gz")
}

/// The content of all members, joined. Zeros after the last member are padding. Memory grows with the content, up to
/// the limit.
///
/// # Errors
/// [`Error::FileTooLarge`]; [`Error::Parse`] if the file is cut off or damaged.
pub(super) fn unpack(packed: &[u8], options: &ReadOptions) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    let mut rest = packed;
    loop {
        rest = member(packed, rest, &mut bytes, options)?;
        if rest.iter().all(|&byte| byte == 0) {
            return Ok(bytes);
        }
        if !is_magic(rest) {
            let message = format!("{} other bytes follow the gzip'd data; cut them off", rest.len());
            return Err(Error::Parse { place: location(packed, rest), message });
        }
    }
}

/// Appends the content of the member at the start of `rest` to `bytes`, and returns the bytes after the member.
fn member<'a>(
    packed: &[u8],
    rest: &'a [u8],
    bytes: &mut Vec<u8>,
    options: &ReadOptions,
) -> Result<&'a [u8], Error> {
    let mut decoder = GzDecoder::new(rest);
    loop {
        let length = bytes.len() as u64;
        options.check(length)?;
        // One byte more than allowed, to detect that there are more.
        let more = length.max(FIRST).min(options.max_bytes - length) + 1;
        let read = match bytes.try_reserve_exact(more as usize) {
            Ok(()) => decoder.by_ref().take(more).read_to_end(bytes),
            Err(error) => Err(error.into()),
        };
        match read {
            Ok(read) if (read as u64) < more => return Ok(decoder.into_inner()),
            Ok(_) => {}
            Err(error) => {
                let what = match error.kind() {
                    io::ErrorKind::UnexpectedEof => "is cut off",
                    io::ErrorKind::OutOfMemory => {
                        return Err(Error::OutOfMemory { bytes: length + more, limit: memory::LIMIT });
                    }
                    _ => "is damaged",
                };
                let message = format!("the gzip'd file {what} ({error})");
                return Err(Error::Parse { place: location(packed, decoder.get_ref()), message });
            }
        }
    }
}

/// Names the byte at which `rest` begins.
fn location(packed: &[u8], rest: &[u8]) -> String {
    format!("byte {}", packed.len() - rest.len())
}

/// Calls `write` with `out`, or with a compressor in front of it.
pub(super) fn write(
    is_packed: bool,
    out: &mut dyn Write,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    if !is_packed {
        return write(out);
    }
    let mut packed = GzEncoder::new(out, Compression::default());
    write(&mut packed)?;
    packed.finish().map(drop)
}
