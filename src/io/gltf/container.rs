//! The two forms of a glTF file: JSON alone (`.gltf`), and a header with a JSON chunk and a binary chunk (`.glb`).
//! Source: the glTF 2.0 specification, section 4, "GLB File Format Specification".

use super::errors::refuse;
use crate::Error;
use std::ops::Range;

const MAGIC: &[u8] = b"glTF";
const HEADER: usize = 12;
const JSON: &[u8; 4] = b"JSON";
const BINARY: &[u8; 4] = b"BIN\0";

/// The byte ranges of the parts of a file.
pub(super) struct Container {
    pub(super) json: Range<usize>,
    /// The binary chunk of a `.glb` file.
    pub(super) binary: Option<Range<usize>>,
    /// Chunks of other kinds, including their length and kind.
    pub(super) others: Vec<Range<usize>>,
    pub(super) is_binary: bool,
}

impl Container {
    pub(super) fn of(bytes: &[u8]) -> Result<Self, Error> {
        let start = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        let mut container =
            Self { json: start..bytes.len(), binary: None, others: Vec::new(), is_binary: false };
        if !bytes.starts_with(MAGIC) {
            return Ok(container);
        }
        container.is_binary = true;
        container.json = 0..0;
        let version = word(bytes, 4)?;
        if version != 2 {
            return Err(refuse(
                "byte 4",
                format!("the file has glTF version {version}, only version 2 is supported"),
            ));
        }
        let end = word(bytes, 8)? as usize;
        if end > bytes.len() {
            let message = format!(
                "the header announces {end} bytes, the file has {}; it may have been cut off",
                bytes.len()
            );
            return Err(refuse("byte 8", message));
        }
        let mut at = HEADER;
        while at + 8 <= end {
            let chunk = at..chunk_end(bytes, at, end)?;
            let data = at + 8..chunk.end;
            match &bytes[at + 4..at + 8] {
                kind if at == HEADER && kind != JSON => {
                    return Err(refuse("byte 16", "the first chunk is not the JSON"));
                }
                kind if at == HEADER && kind == JSON => container.json = data,
                kind if container.binary.is_none() && kind == BINARY => container.binary = Some(data),
                _ => container.others.push(chunk.clone()),
            }
            at = chunk.end;
        }
        if container.json.is_empty() {
            return Err(refuse("byte 12", "there is no JSON chunk"));
        }
        Ok(container)
    }
}

/// The end of the chunk at byte `at`.
fn chunk_end(bytes: &[u8], at: usize, end: usize) -> Result<usize, Error> {
    let length = word(bytes, at)? as usize;
    match (at + 8).checked_add(length) {
        Some(chunk_end) if chunk_end <= end => Ok(chunk_end),
        _ => Err(refuse(
            format!("byte {at}"),
            format!("a chunk announces {length} bytes, {} are left", end - at - 8),
        )),
    }
}

fn word(bytes: &[u8], at: usize) -> Result<u32, Error> {
    match bytes.get(at..).and_then(<[u8]>::first_chunk) {
        Some(&word) => Ok(u32::from_le_bytes(word)),
        None => Err(refuse(format!("byte {}", bytes.len()), "the file ends in its header")),
    }
}

/// The bytes of a `.glb` file. `others` are whole chunks.
///
/// # Errors
/// [`Error::TooLarge`] for 4 GiB or more.
pub(super) fn glb(json: &[u8], binary: Option<&[u8]>, others: &[&[u8]]) -> Result<Vec<u8>, Error> {
    let padded = |length: usize| length.next_multiple_of(4);
    let chunks = [(JSON, Some(json), b' '), (BINARY, binary, 0)];
    let data = chunks.iter().filter_map(|(_, data, _)| *data).map(|data| 8 + padded(data.len()));
    let length = HEADER + data.sum::<usize>() + others.iter().map(|chunk| chunk.len()).sum::<usize>();
    let Ok(announced) = u32::try_from(length) else {
        return Err(Error::TooLarge {
            what: "bytes in the form of a GLB file",
            count: length,
            limit: u32::MAX as usize,
        });
    };
    let mut bytes = Vec::with_capacity(length);
    bytes.extend_from_slice(MAGIC);
    bytes.extend(2u32.to_le_bytes());
    bytes.extend(announced.to_le_bytes());
    for (kind, data, filler) in chunks {
        if let Some(data) = data {
            let length = padded(data.len());
            bytes.extend((length as u32).to_le_bytes());
            bytes.extend_from_slice(kind);
            bytes.extend_from_slice(data);
            bytes.resize(bytes.len() + length - data.len(), filler);
        }
    }
    others.iter().for_each(|chunk| bytes.extend_from_slice(chunk));
    Ok(bytes)
}
