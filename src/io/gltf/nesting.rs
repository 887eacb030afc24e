//! The depth of nesting in the JSON of a file. The reader skips unknown parts of any depth, but the writer needs a
//! `serde_json::Value`, which has a limit. So the reader refuses deeper files.

use super::errors::refuse;
use crate::Error;
use memchr::memchr2;

/// The most nested arrays and objects that `serde_json` reads into a `Value`.
const DEEPEST: usize = 127;

/// Refuses JSON that is nested more deeply.
pub(super) fn refuse_deep(bytes: &[u8]) -> Result<(), Error> {
    let (mut depth, mut rest) = (0usize, bytes);
    while let Some(at) = rest.iter().position(|byte| b"[]{}\"".contains(byte)) {
        let byte = rest[at];
        rest = &rest[at + 1..];
        match byte {
            b'"' => rest = after_string(rest),
            b'[' | b'{' => depth += 1,
            _ => depth = depth.saturating_sub(1),
        }
        if depth > DEEPEST {
            let location = format!("JSON, byte {}", bytes.len() - rest.len() - 1);
            return Err(refuse(location, format!("it is nested more than {DEEPEST} levels deep")));
        }
    }
    Ok(())
}

/// The bytes after a string whose first quotation mark has been read.
fn after_string(mut rest: &[u8]) -> &[u8] {
    while let Some(at) = memchr2(b'"', b'\\', rest) {
        let is_end = rest[at] == b'"';
        rest = rest.get(at + if is_end { 1 } else { 2 }..).unwrap_or_default();
        if is_end {
            return rest;
        }
    }
    &[]
}

#[cfg(test)]
mod tests {
    use crate::io::{Format, Loaded, ReadOptions, parse};
    use crate::{Error, Mesh};

    /// A file with one triangle, and `extras` in its asset.
    fn with_extras(extras: &str) -> Result<Loaded, Error> {
        let positions = vec![0f32, 0., 0., 1., 0., 0., 0., 1., 0.];
        let mesh = Mesh::new(crate::Dimension::Three, positions, vec![0, 1, 2]).unwrap();
        let text = String::from_utf8(crate::io::to_bytes(Format::Gltf, &mesh).unwrap()).unwrap();
        let text = text.replacen(r#""asset":{"#, &format!(r#""asset":{{"extras":{extras},"#), 1);
        parse(Format::Gltf, text.into_bytes(), &ReadOptions::default())
    }

    /// The document and its asset add two levels.
    #[test]
    fn a_file_that_can_be_read_can_be_written() {
        for (open, close) in [("[", "]"), (r#"{"a":"#, "}")] {
            let nested = |levels: usize| open.repeat(levels) + "0" + &close.repeat(levels);
            let loaded = with_extras(&nested(super::DEEPEST - 2)).unwrap();
            loaded.file_bytes("out.glb", vec![1, 2, 0]).unwrap();
            for levels in [super::DEEPEST - 1, 200_000, 2_000_000] {
                let error = with_extras(&nested(levels)).unwrap_err().to_string();
                assert!(error.ends_with(": it is nested more than 127 levels deep"), "{error}");
            }
        }
        with_extras(&"[".repeat(1_000_000)).unwrap_err();
        with_extras(&(r#"{"a":"#.repeat(1_000_000) + "0")).unwrap_err();
    }

    #[test]
    fn brackets_in_strings_are_text() {
        let brackets = "[{".repeat(1000);
        for text in [brackets.clone(), format!(r#"\"{brackets}\\"#), format!(r#"{brackets}\u005b\\\""#)] {
            let loaded = with_extras(&format!("\"{text}\"")).unwrap();
            loaded.file_bytes("out.glb", vec![1, 2, 0]).unwrap();
        }
        with_extras(&format!("\"{brackets}")).unwrap_err();
        with_extras(r#""\"#).unwrap_err();
    }
}
