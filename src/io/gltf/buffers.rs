//! The buffers of a glTF file: in its binary chunk, in its JSON, or in other files.

use super::errors::{quoted, refuse};
use super::root::Root;
use crate::Error;
use crate::io::options::ReadFile;
use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use percent_encoding::percent_decode_str;
use std::borrow::Cow;
use std::ops::Index;

/// Base64 with or without its padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The buffers of a file.
pub(super) struct Buffers<'a>(Vec<Buffer<'a>>);

enum Buffer<'a> {
    Present(Cow<'a, [u8]>),
    /// Why it is missing.
    Absent(String),
}

impl<'a> Buffers<'a> {
    /// Takes the binary chunk as the first buffer, if that has no URI, and calls `read` for buffers in other files.
    ///
    /// # Errors
    /// [`Error::Parse`] for an invalid data URI, and for a file that `read` does not return.
    pub(super) fn of(root: &Root, binary: Option<&'a [u8]>, read: ReadFile<'_>) -> Result<Self, Error> {
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (index, buffer) in root.buffers.iter().enumerate() {
            buffers.push(match (&buffer.uri, binary) {
                (None, Some(binary)) if index == 0 => Buffer::Present(binary.into()),
                (None, _) => Buffer::Absent("it has no URI".into()),
                (Some(uri), _) => match data_of(uri) {
                    Some((head, data)) => {
                        Buffer::Present(decode(head, data).map_err(|message| at(index, message))?.into())
                    }
                    None => Self::from_file(index, uri, read)?,
                },
            });
        }
        // Bytes beyond the length in the JSON are padding.
        for (buffer, announced) in buffers.iter_mut().zip(&root.buffers) {
            let announced = usize::try_from(announced.byte_length.0).unwrap_or(usize::MAX);
            match buffer {
                Buffer::Present(Cow::Owned(bytes)) => bytes.truncate(announced),
                Buffer::Present(Cow::Borrowed(bytes)) => *bytes = &bytes[..announced.min(bytes.len())],
                Buffer::Absent(_) => {}
            }
        }
        Ok(Self(buffers))
    }

    fn from_file(index: usize, uri: &str, read: ReadFile<'_>) -> Result<Buffer<'a>, Error> {
        let name = name_of(uri);
        // A path out of the folder, or to another machine, is never followed.
        let is_beside = !name.starts_with('/')
            && !name.contains(['\\', ':', '\0'])
            && name.split('/').all(|part| part != "..");
        if !is_beside {
            return Err(at(index, format!("{} is not a file beside this one", quoted(uri))));
        }
        let bytes =
            read(&name).map_err(|why| at(index, format!("it is in the file {}: {why}", quoted(&name))))?;
        Ok(Buffer::Present(bytes.into()))
    }

    /// The length of a buffer, or an error at `location` if it is missing.
    pub(super) fn length(&self, index: usize, location: impl Fn() -> String) -> Result<usize, Error> {
        match self.0.get(index) {
            Some(Buffer::Present(bytes)) => Ok(bytes.len()),
            Some(Buffer::Absent(why)) => Err(refuse(location(), format!("buffer {index} is missing: {why}"))),
            None => Err(refuse(location(), format!("there is no buffer {index}"))),
        }
    }

    /// The total number of bytes.
    pub(super) fn total(&self) -> u64 {
        (0..self.0.len()).map(|index| self[index].len() as u64).sum()
    }

    /// Whether buffer `index` exists and its bytes are present.
    pub(super) fn has(&self, index: usize) -> bool {
        matches!(self.0.get(index), Some(Buffer::Present(_)))
    }
}

/// The bytes of a buffer; empty if they are missing.
impl Index<usize> for Buffers<'_> {
    type Output = [u8];
    fn index(&self, index: usize) -> &[u8] {
        match &self.0[index] {
            Buffer::Present(bytes) => bytes,
            Buffer::Absent(_) => &[],
        }
    }
}

fn at(buffer: usize, message: impl Into<String>) -> Error {
    refuse(format!("buffer {buffer}"), message)
}

/// Whether a URI names another file.
pub(super) fn is_in_other_file(uri: &str) -> bool {
    data_of(uri).is_none()
}

/// The name of the file of a URI.
pub(super) fn name_of(uri: &str) -> String {
    percent_decode_str(uri).decode_utf8_lossy().into_owned()
}

/// The parts of a data URI before and after its comma. Schemes may be in upper or lower case (RFC 3986, section 3.1).
fn data_of(uri: &str) -> Option<(&str, &str)> {
    let is_data = |head: &str| head.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"));
    uri.split_once(',').filter(|(head, _)| is_data(head))
}

/// The bytes of a data URI. `head` is the part before its comma, `data` the part after it.
fn decode(head: &str, data: &str) -> Result<Vec<u8>, String> {
    const MARK: &str = ";base64";
    let mark = head.len().checked_sub(MARK.len()).and_then(|at| head.get(at..));
    if mark.is_some_and(|mark| mark.eq_ignore_ascii_case(MARK)) {
        return BASE64.decode(data).map_err(|error| format!("its data URI is not valid base64: {error}"));
    }
    Ok(percent_decode_str(data).collect())
}

/// Encodes bytes as a data URI.
pub(super) fn data_uri(bytes: &[u8]) -> String {
    let mut uri = String::from("data:application/octet-stream;base64,");
    BASE64.encode_string(bytes, &mut uri);
    uri
}
