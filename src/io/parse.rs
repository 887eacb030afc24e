//! Parses the bytes of a file of any format.

use super::attributes::refuse_unknown;
use super::format::Format;
use super::loaded::Loaded;
use super::options::{Coordinates, ReadFile, ReadOptions};
use super::original::Original;
use super::parsed::{Others, Parsed, Polygons};
use super::text::Digits;
use super::{gltf, gzip, obj, off, ply, points, stl};
use crate::system::threads::Threads;
use crate::{Dimension, Error, MAX_TRIANGLES, Mesh, Positions};
use std::borrow::Cow;

/// Parses the bytes of a file, which may be gzip'd. Copies borrowed bytes if the file is held ([`ReadOptions::keep`]).
///
/// # Errors
/// [`Error::Parse`], which names the line, the byte, or the vertex whose z is not 0 in a 2D mesh; [`Error::TooLarge`];
/// [`Error::FileTooLarge`]; [`Error::Option`] for a name in `ignore_attributes` that the file does not have.
pub fn parse<'a>(
    format: Format,
    bytes: impl Into<Cow<'a, [u8]>>,
    options: &ReadOptions,
) -> Result<Loaded, Error> {
    parse_with(format, bytes, options, &|_| Err("reading other files is not allowed".into()))
}

/// As [`parse`]. `read` returns the content of another file that this one names, or why it does not.
///
/// # Errors
/// Those of [`parse`].
pub fn parse_with<'a>(
    format: Format,
    bytes: impl Into<Cow<'a, [u8]>>,
    options: &ReadOptions,
    read: ReadFile<'_>,
) -> Result<Loaded, Error> {
    let mut bytes = bytes.into();
    options.check(bytes.len() as u64)?;
    if gzip::is_magic(&bytes) {
        bytes = gzip::unpack(&bytes, options)?.into();
    }
    if bytes.trim_ascii().is_empty() {
        return Err(Error::Parse { place: "line 1".into(), message: "the file is empty".into() });
    }
    if let Format::Off | Format::Obj | Format::Csv | Format::Xyz = format
        && let Some(text) = utf8(&bytes)
    {
        bytes = text.into();
    }
    let coordinates = options.coordinates;
    let (parsed, can_be_held) = match format {
        Format::Off => (off::parse(&bytes, coordinates)?, true),
        Format::Obj => (obj::parse(&bytes, coordinates)?, true),
        Format::Ply => (ply::parse(&bytes, coordinates)?, ply::is_held(&bytes)),
        Format::Stl => (stl::parse(&bytes, coordinates)?, stl::is_held(&bytes)),
        Format::Csv => (points::parse_csv(&bytes, coordinates)?, false),
        Format::Xyz => (points::parse_xyz(&bytes, coordinates)?, false),
        Format::Gltf | Format::Glb => {
            let gltf::Content { parsed, document, notes } =
                gltf::read(bytes.into_owned(), read, options.max_bytes)?;
            refuse_unknown(&options.ignore_attributes, &[])?;
            let dimension = options.dimension.or(Some(Dimension::Three));
            let (loaded, _) = finish(parsed, &ReadOptions { dimension, ..options.clone() })?;
            return Ok(Loaded { notes, document: Some(document), ..loaded });
        }
    };
    // The corners of an OBJ file may have references even if nothing was dropped.
    let is_plain = parsed.dropped.0.is_empty() && format != Format::Obj;
    let (loaded, others) = finish(parsed, options)?;
    let max_bytes = options.max_bytes;
    let plain = is_plain.then_some(loaded.mesh.triangle_count());
    let ignored = options.ignore_attributes.clone();
    let is_needed = options.keep || !ignored.is_empty();
    let original = (is_needed && can_be_held).then(|| Original {
        format,
        bytes: bytes.into_owned(),
        max_bytes,
        plain,
        others,
        ignored,
    });
    match &original {
        Some(original) => original.check_ignored(&loaded.mesh)?,
        None => refuse_unknown(&options.ignore_attributes, &[])?,
    }
    Ok(Loaded { original: original.filter(|_| options.keep), ..loaded })
}

/// Text with a UTF-16 byte order mark, converted to UTF-8; `None` for other text.
fn utf8(bytes: &[u8]) -> Option<Vec<u8>> {
    let decoded = |word: fn([u8; 2]) -> u16| {
        let words = bytes[2..].as_chunks().0.iter().map(|&pair| word(pair));
        char::decode_utf16(words).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect::<String>()
    };
    match bytes {
        [0xfe, 0xff, ..] => Some(decoded(u16::from_be_bytes).into_bytes()),
        [0xff, 0xfe, ..] => Some(decoded(u16::from_le_bytes).into_bytes()),
        _ => None,
    }
}

/// Decides the dimension, cuts the polygons and makes the mesh.
fn finish(parsed: Parsed, options: &ReadOptions) -> Result<(Loaded, Others), Error> {
    let Parsed { stride, mut positions, mut faces, dropped, mut loses } = parsed;
    if options.coordinates == Some(Coordinates::F32)
        && let Positions::F64(numbers) = &positions
    {
        loses = numbers.iter().any(|&x| f64::from(x as f32) != x);
        positions = positions.to_f32().into();
    }
    let notes =
        if loses { vec!["the coordinates were rounded to 32-bit floats".to_owned()] } else { Vec::new() };
    let raised = match (&positions, stride) {
        (Positions::F32(numbers), 3) => first_raised(numbers),
        (Positions::F64(numbers), 3) => first_raised(numbers),
        _ => None,
    };
    let dimension = match (options.dimension, raised) {
        _ if options.plane.is_some() => Dimension::Three,
        (Some(Dimension::Two), Some(vertex)) => {
            let mut z = Vec::new();
            Digits::default().coordinate(&mut z, &positions, 3 * vertex + 2);
            return Err(Error::Parse {
                place: format!("vertex {vertex}"),
                message: format!(
                    "z is {}, but every z must be 0 in the 2D mesh that was requested; a terrain needs plane",
                    z.escape_ascii()
                ),
            });
        }
        (Some(dimension), _) => dimension,
        (None, Some(_)) => Dimension::Three,
        (None, None) => Dimension::Two,
    };
    let positions: Positions = match positions {
        Positions::F32(numbers) => with_stride(numbers, stride, dimension.stride()).into(),
        Positions::F64(numbers) => with_stride(numbers, stride, dimension.stride()).into(),
    };
    let count = faces.triangles.len() / 3;
    let polygons = if count > MAX_TRIANGLES {
        Polygons::default()
    } else {
        faces.cut(&positions, dimension, options.plane)
    };
    let mesh =
        Mesh::checked(dimension, positions, faces.triangles, &Threads::default().for_triangles(count))?;
    let loaded = Loaded {
        mesh,
        polygons: polygons.count,
        crossing: polygons.crossing,
        dropped: dropped.0,
        notes,
        document: None,
        original: None,
    };
    Ok((loaded, polygons.others))
}

/// The first vertex whose z is not 0.
fn first_raised<T: Copy + Default + PartialEq>(numbers: &[T]) -> Option<usize> {
    numbers.chunks_exact(3).position(|p| p[2] != T::default())
}

/// Removes every third number, or appends a 0 to every pair.
fn with_stride<T: Copy + Default>(mut numbers: Vec<T>, from: usize, to: usize) -> Vec<T> {
    match (from, to) {
        (3, 2) => {
            let vertices = numbers.len() / 3;
            for v in 0..vertices {
                numbers.copy_within(3 * v..3 * v + 2, 2 * v);
            }
            numbers.truncate(2 * vertices);
            numbers
        }
        (2, 3) => numbers.chunks_exact(2).flat_map(|p| [p[0], p[1], T::default()]).collect(),
        _ => numbers,
    }
}
