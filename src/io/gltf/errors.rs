//! Errors of glTF files, and names in messages.

use crate::Error;
use crate::io::text::quoted as quoted_bytes;

pub(super) fn refuse(location: impl Into<String>, message: impl Into<String>) -> Error {
    Error::Parse { place: location.into(), message: message.into() }
}

pub(super) fn quoted(text: &str) -> String {
    quoted_bytes(text.as_bytes())
}

/// Replaces line breaks, which names in a file may have.
pub(super) fn one_line(message: String) -> String {
    message.replace(char::is_control, "\u{fffd}")
}
