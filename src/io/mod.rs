//! Mesh files: reading and writing by extension, and the same on bytes where there is no file system. And lists of
//! edges.
//!
//! The parsers are our own. What was looked at (2026-11): `tobj` splits a file into models with vertices
//! of their own, `obj-rs` gives no line numbers, `obj` checks no index and wants UTF-8 everywhere, `off-rs`
//! knows no header but a bare `OFF`. None keeps the contract: the same vertices in the same order, and an
//! error that names the line.

mod edges;
#[cfg(not(target_arch = "wasm32"))]
mod file;
mod obj;
mod off;
#[cfg(test)]
mod tests;
mod text;

pub use edges::parse_edges;
#[cfg(not(target_arch = "wasm32"))]
pub use file::{load, read, read_edges, write};

use crate::{Dimension, Error, Mesh};
use std::io::Write;
use std::path::Path;
use text::Parsed;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Geomview's object file format, text: `.off`.
    Off,
    /// Wavefront's object format: `.obj`.
    Obj,
}

impl Format {
    /// The extensions that are known, as [`Error::UnknownFormat`] lists them.
    pub const KNOWN: &'static str = ".off, .obj";

    /// The format that the extension of `path` names, in either case.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`].
    pub fn of(path: &Path) -> Result<Self, Error> {
        match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
            Some("off") => Ok(Self::Off),
            Some("obj") => Ok(Self::Obj),
            _ => Err(Error::UnknownFormat { path: path.display().to_string(), known: Self::KNOWN }),
        }
    }
}

/// A mesh as it was read, and what was done to the file's content to get it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The file's vertices, all of them, in its order, and its faces as triangles.
    pub mesh: Mesh,
    /// Faces with more than three corners; each was cut into a fan of triangles around its first corner.
    pub polygons: usize,
    /// What the file holds that a [`Mesh`] has no place for, such as `normals`.
    pub dropped: Vec<&'static str>,
}

/// Reads the bytes of a file. `dimension` `None`: 2D if the file has two coordinates a vertex or every z
/// is 0, else 3D.
///
/// # Errors
/// [`Error::Parse`], which names the line, or the vertex that has a height where 2D was asked for;
/// [`Error::TooLarge`].
pub fn parse(format: Format, bytes: &[u8], dimension: Option<Dimension>) -> Result<Loaded, Error> {
    if bytes.trim_ascii().is_empty() {
        return Err(Error::Parse { place: "line 1".into(), message: "the file is empty".into() });
    }
    let parsed = match format {
        Format::Off => off::parse(bytes),
        Format::Obj => obj::parse(bytes),
    }?;
    finish(parsed, dimension)
}

/// Writes `mesh` as text; each number has the fewest digits that read back to the same bits, 32 or 64 of them.
/// [`parse`] reads 32.
/// Give it something buffered.
///
/// # Errors
/// Those of `out`.
pub fn write_to(format: Format, mesh: &Mesh, out: &mut impl Write) -> std::io::Result<()> {
    match format {
        Format::Off => off::write(mesh, out),
        Format::Obj => obj::write(mesh, out),
    }
}

/// The bytes of a file that holds `mesh`.
///
/// # Errors
/// None that memory does not bring; the signature is that of [`write_to`].
pub fn to_bytes(format: Format, mesh: &Mesh) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write_to(format, mesh, &mut bytes)?;
    Ok(bytes)
}

/// Decides the dimension and makes the mesh.
fn finish(parsed: Parsed, dimension: Option<Dimension>) -> Result<Loaded, Error> {
    let Parsed { stride, mut positions, faces, dropped } = parsed;
    let raised = match stride {
        3 => positions.chunks_exact(3).position(|p| p[2] != 0.0),
        _ => None,
    };
    let dimension = match (dimension, raised) {
        (Some(Dimension::Two), Some(vertex)) => {
            let z = positions[3 * vertex + 2];
            return Err(Error::Parse {
                place: format!("vertex {vertex}"),
                message: format!("z is {z}, but the mesh was asked for in 2D, where every z must be 0"),
            });
        }
        (Some(dimension), _) => dimension,
        (None, Some(_)) => Dimension::Three,
        (None, None) => Dimension::Two,
    };
    positions = match (stride, dimension) {
        (3, Dimension::Two) => flatten(positions),
        (2, Dimension::Three) => positions.chunks_exact(2).flat_map(|p| [p[0], p[1], 0.0]).collect(),
        _ => positions,
    };
    let mesh = Mesh::new(dimension, positions, faces.triangles)?;
    Ok(Loaded { mesh, polygons: faces.polygons, dropped: dropped.0 })
}

/// Leaves out every third number, in place.
fn flatten(mut positions: Vec<f32>) -> Vec<f32> {
    let vertices = positions.len() / 3;
    for v in 0..vertices {
        positions.copy_within(3 * v..3 * v + 2, 2 * v);
    }
    positions.truncate(2 * vertices);
    positions
}
