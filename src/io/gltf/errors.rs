//! Errors of glTF files, and the names in them.

use crate::Error;
use crate::io::text::quoted as quoted_bytes;

pub(super) fn refuse(place: impl Into<String>, message: impl Into<String>) -> Error {
    Error::Parse { place: place.into(), message: message.into() }
}

pub(super) fn quoted(text: &str) -> String {
    quoted_bytes(text.as_bytes())
}

/// Names of the file, which a message repeats, may have line breaks.
pub(super) fn one_line(message: String) -> String {
    message.replace(char::is_control, "\u{fffd}")
}
