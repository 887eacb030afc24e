//! Mesh files: reading and writing by extension, and the same on bytes where there is no file system. And lists of
//! edges.
//!
//! The parsers are our own. What was looked at (2026-11): `tobj` splits a file into models with vertices
//! of their own, `obj-rs` gives no line numbers, `obj` checks no index and wants UTF-8 everywhere, `off-rs`
//! knows no header but a bare `OFF`; `ply-rs-bw` compares
//! the name of a property for each of its numbers, allocates for each face, knows no byte, and does not end on 2^64
//! elements without properties; `serde-ply` knows neither line nor byte; `stl_io` takes every file that begins with
//! `solid` for text, -0 and 0 for two places, and NaN for a number. None keeps the contract: the same vertices in the
//! same order, and an error that names the line or the byte. Two of them are what the tests compare with.

mod edges;
#[cfg(not(target_arch = "wasm32"))]
mod file;
mod gzip;
mod obj;
mod off;
mod ply;
mod stl;
#[cfg(test)]
mod tests;
mod text;

pub use edges::parse_edges;
#[cfg(not(target_arch = "wasm32"))]
pub use file::{load, read, read_edges, write};

use crate::{Dimension, Error, Mesh, Positions};
use std::borrow::Cow;
use std::io::Write;
use std::path::Path;
use text::{Digits, Parsed};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Geomview's object file format, text: `.off`.
    Off,
    /// Wavefront's object format: `.obj`.
    Obj,
    /// The Stanford triangle format, text or binary: `.ply`. It is written in binary, and is the one that keeps the
    /// bits of 64-bit floats.
    Ply,
    /// Stereolithography, text or binary: `.stl`. It has no vertices that triangles share: corners at the same position
    /// are read as one. It is written in binary and has 32-bit floats, to which 64-bit floats are rounded.
    Stl,
}

impl Format {
    /// The extensions that are known, as [`Error::UnknownFormat`] lists them.
    pub const KNOWN: &'static str = ".off, .obj, .ply, .stl, also gzip'd (.gz)";

    /// The format that the extension of `path` names, in either case; `.gz` after it does not count.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`].
    pub fn of(path: &Path) -> Result<Self, Error> {
        let name = if gzip::is_named(path) { Path::new(path.file_stem().unwrap_or_default()) } else { path };
        match extension(name).as_deref() {
            Some("off") => Ok(Self::Off),
            Some("obj") => Ok(Self::Obj),
            Some("ply") => Ok(Self::Ply),
            Some("stl") => Ok(Self::Stl),
            _ => Err(Error::UnknownFormat { path: path.display().to_string(), known: Self::KNOWN }),
        }
    }
}

/// What follows the last dot, in lower case.
fn extension(path: &Path) -> Option<String> {
    path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase)
}

/// What can be chosen for reading a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadOptions {
    /// Whether the mesh lies in the plane; `None`: if the file has two coordinates a vertex or every z is 0.
    pub dimension: Option<Dimension>,
    /// How many bytes a file may have, and a gzip'd one once it is unpacked. By default 4 GiB, in WebAssembly 1 GiB.
    pub max_bytes: u64,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self { dimension: None, max_bytes: if cfg!(target_arch = "wasm32") { 1 << 30 } else { 1 << 32 } }
    }
}

impl ReadOptions {
    /// Refuses a file of more bytes than it may have.
    pub(crate) fn check(&self, bytes: u64) -> Result<(), Error> {
        if bytes > self.max_bytes { Err(self.too_large()) } else { Ok(()) }
    }

    fn too_large(&self) -> Error {
        Error::FileTooLarge { limit: self.max_bytes, option: "max_bytes" }
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
    pub dropped: Vec<String>,
}

/// Reads the bytes of a file, which may be gzip'd.
///
/// # Errors
/// [`Error::Parse`], which names the line or the byte, or the vertex that has a height where 2D was asked for;
/// [`Error::TooLarge`]; [`Error::FileTooLarge`].
pub fn parse(format: Format, bytes: &[u8], options: &ReadOptions) -> Result<Loaded, Error> {
    let bytes =
        if gzip::is_magic(bytes) { gzip::unpack(bytes, options)?.into() } else { Cow::Borrowed(bytes) };
    options.check(bytes.len() as u64)?;
    if bytes.trim_ascii().is_empty() {
        return Err(Error::Parse { place: "line 1".into(), message: "the file is empty".into() });
    }
    let parsed = match format {
        Format::Off => off::parse(&bytes),
        Format::Obj => obj::parse(&bytes),
        Format::Ply => ply::parse(&bytes),
        Format::Stl => stl::parse(&bytes),
    }?;
    finish(parsed, options.dimension)
}

/// Writes `mesh`. As text, each number has the fewest digits that read back to the same bits, 32 or 64 of them;
/// [`parse`] reads 32 of text that is no PLY. Give it something buffered.
///
/// # Errors
/// Those of `out`; [`std::io::ErrorKind::InvalidInput`] for coordinates that STL cannot hold.
pub fn write_to(format: Format, mesh: &Mesh, out: &mut impl Write) -> std::io::Result<()> {
    match format {
        Format::Off => off::write(mesh, out),
        Format::Obj => obj::write(mesh, out),
        Format::Ply => ply::write(mesh, out),
        Format::Stl => stl::write(mesh, out),
    }
}

/// What [`write_to`] writes.
///
/// # Errors
/// As there.
pub fn to_bytes(format: Format, mesh: &Mesh) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write_to(format, mesh, &mut bytes)?;
    Ok(bytes)
}

/// The bytes of a file of this name that holds `mesh`: in the format of its extension, gzip'd if `.gz` follows.
///
/// # Errors
/// [`Error::UnknownFormat`], and [`Error::Io`] as [`write_to`].
pub fn to_file_bytes(name: impl AsRef<Path>, mesh: &Mesh) -> Result<Vec<u8>, Error> {
    let name = name.as_ref();
    let format = Format::of(name)?;
    let mut bytes = Vec::new();
    match gzip::write_to(name, format, mesh, &mut bytes) {
        Ok(()) => Ok(bytes),
        Err(source) => Err(Error::Io { path: name.display().to_string(), source }),
    }
}

/// Decides the dimension and makes the mesh.
fn finish(parsed: Parsed, dimension: Option<Dimension>) -> Result<Loaded, Error> {
    let Parsed { stride, positions, faces, dropped } = parsed;
    let raised = match (&positions, stride) {
        (Positions::F32(numbers), 3) => first_raised(numbers),
        (Positions::F64(numbers), 3) => first_raised(numbers),
        _ => None,
    };
    let dimension = match (dimension, raised) {
        (Some(Dimension::Two), Some(vertex)) => {
            let mut z = Vec::new();
            Digits::default().coordinate(&mut z, &positions, 3 * vertex + 2);
            return Err(Error::Parse {
                place: format!("vertex {vertex}"),
                message: format!(
                    "z is {}, but the mesh was asked for in 2D, where every z must be 0",
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
    let mesh = Mesh::new(dimension, positions, faces.triangles)?;
    Ok(Loaded { mesh, polygons: faces.polygons, dropped: dropped.0 })
}

/// The first vertex with a height.
fn first_raised<T: Copy + Default + PartialEq>(numbers: &[T]) -> Option<usize> {
    numbers.chunks_exact(3).position(|p| p[2] != T::default())
}

/// Leaves out every third number, in place, or adds a 0 to every two.
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
