//! Mesh files: reading and writing by extension, and the same on bytes where there is no file system. And lists of
//! edges and of numbers.
//!
//! The parsers are our own. What was looked at (2026-11): `tobj` splits a file into models with vertices
//! of their own, `obj-rs` gives no line numbers, `obj` checks no index and wants UTF-8 everywhere, `off-rs`
//! knows no header but a bare `OFF`; `ply-rs-bw` compares
//! the name of a property for each of its numbers, allocates for each face, names no byte, and fills the memory with
//! 2^64 elements without properties; `serde-ply` names neither line nor byte; `stl_io` takes every file that begins
//! with `solid` for text, -0 and 0 for two places, and NaN for a number. None keeps the contract: the same vertices in
//! the same order, and an error that names the line or the byte. `ply-rs-bw` and `stl_io` are what the tests compare
//! with. What is packed is left to `flate2`, and the JSON of glTF to `gltf`.

#[cfg(not(target_arch = "wasm32"))]
mod file;
mod gltf;
mod gzip;
mod lists;
mod obj;
mod off;
mod original;
#[cfg(not(target_arch = "wasm32"))]
mod output;
mod pieces;
mod ply;
mod stl;
#[cfg(not(target_arch = "wasm32"))]
mod temporary;
#[cfg(test)]
mod tests;
mod text;
#[cfg(unix)]
mod wait;

#[cfg(not(target_arch = "wasm32"))]
use file::{at, folder};
#[cfg(not(target_arch = "wasm32"))]
pub use file::{load, read, read_edges, read_numbers};
pub use gltf::ReadFile;
pub use lists::{parse_edges, parse_numbers};
#[cfg(not(target_arch = "wasm32"))]
pub use output::{Output, Staged, rewrite, write};
#[cfg(not(target_arch = "wasm32"))]
pub use temporary::remove_temporary_files;

use crate::system::threads::Threads;
use crate::{Dimension, Error, Mesh, Options, Positions, Welded, welded};
use original::Original;
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;
use text::{Digits, Parsed};

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Geomview's object file format, text: `.off`.
    Off,
    /// Wavefront's object format: `.obj`.
    Obj,
    /// The Stanford triangle format, text or binary: `.ply`. New files are binary. It is the one that keeps the
    /// bits of 64-bit floats.
    Ply,
    /// Stereolithography, text or binary: `.stl`. It has no vertices that triangles share: corners at the same position
    /// are read as one. It is written in binary and has 32-bit floats, to which 64-bit floats are rounded.
    Stl,
    /// glTF 2.0 as JSON: `.gltf`. It has 32-bit floats, to which 64-bit floats are rounded.
    Gltf,
    /// glTF 2.0 in one binary file: `.glb`.
    Glb,
}

impl Format {
    /// The extensions that are known, as [`Error::UnknownFormat`] lists them.
    pub const KNOWN: &'static str = ".off, .obj, .ply, .stl, .gltf, .glb, also gzip'd (.gz)";

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
            Some("gltf") => Ok(Self::Gltf),
            Some("glb") => Ok(Self::Glb),
            _ => Err(Error::UnknownFormat { path: path.display().to_string(), known: Self::KNOWN }),
        }
    }

    fn is_gltf(self) -> bool {
        matches!(self, Self::Gltf | Self::Glb)
    }
}

/// What follows the last dot, in lower case.
fn extension(path: &Path) -> Option<String> {
    path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase)
}

/// What can be chosen for reading a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadOptions {
    /// Whether the mesh lies in the plane; `None`: if the file has two coordinates a vertex or every z is 0, and is no
    /// glTF.
    pub dimension: Option<Dimension>,
    /// How many bytes a file may have, and a gzip'd one also once it is unpacked. By default 4 GiB, in WebAssembly 1 GiB.
    pub max_bytes: u64,
    /// Whether [`load`] may read the files beside a glTF file, in its folder and those below, that its buffers are in.
    pub external_files: bool,
    /// Whether an OFF, OBJ, PLY or binary STL file is held in memory, beside the mesh, so that it can be written again
    /// with all that a mesh has no place for. By default it is. A glTF file always is.
    pub keep: bool,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            dimension: None,
            external_files: false,
            keep: true,
            max_bytes: if cfg!(target_arch = "wasm32") { 1 << 30 } else { 1 << 32 },
        }
    }
}

impl ReadOptions {
    /// Refuses a file of more bytes than it may have.
    pub(crate) fn check(&self, bytes: u64) -> Result<(), Error> {
        if bytes > self.max_bytes {
            return Err(Error::FileTooLarge { limit: self.max_bytes, option: "max_bytes" });
        }
        Ok(())
    }
}

/// A mesh as it was read, and what was done to the file's content to get it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The file's vertices, all of them, in its order, and its faces as triangles.
    pub mesh: Mesh,
    /// Faces with more than three corners; each was cut into a fan of triangles around its first corner.
    pub polygons: usize,
    /// What the file holds that a [`Mesh`] has no place for, such as `normals`. [`Loaded::dropped_in`] says what a file of
    /// some format does not keep of it.
    pub dropped: Vec<String>,
    /// What else there is to say about the file, a sentence each.
    pub notes: Vec<String>,
    /// The file itself, if it is glTF.
    document: Option<gltf::Document>,
    /// The file itself, if it is held and of another format.
    original: Option<Original>,
}

impl Loaded {
    /// Positions to draw the mesh at, 3 numbers a vertex, where its parts are placed in a scene: a glTF file has each
    /// with coordinates of its own, by which it is also decided what is Delaunay.
    pub fn placed(&self) -> Option<Vec<f32>> {
        self.document.as_ref().map(|document| document.placed(&self.mesh))
    }

    /// The mesh with the vertices at one place joined. Of a glTF file these are the vertices of one primitive, and those
    /// with the same bytes in all accessors are the same in all else; of other files all of one place are.
    ///
    /// # Errors
    /// [`Error::Parse`] for a glTF file in whose JSON an array stands for an object.
    pub fn welded(&self) -> Result<Welded, Error> {
        match &self.document {
            Some(document) => document.welded(&self.mesh),
            None => welded(&self.mesh, None),
        }
    }

    /// What is lost in a file of that format; see [`Loaded::dropped`].
    pub fn dropped_in(&self, format: Format) -> &[String] {
        if self.keeps(format) { &[] } else { &self.dropped }
    }

    /// Whether a file of that format is this one again, but for its triangles.
    pub fn keeps(&self, format: Format) -> bool {
        let is_same = self.original.as_ref().is_some_and(|original| original.format == format);
        is_same || format.is_gltf() && self.document.is_some()
    }

    /// Adds to the options of a run what keeps attributes of faces and corners in their places, for a file of the same
    /// format, and returns how many edges that locks: groups of triangles that differ in their material or colour, and
    /// seams, where corners of a vertex differ in their texture coordinates or normals. What glTF has is at vertices, and
    /// needs nothing.
    ///
    /// # Errors
    /// [`Error::TriangleCount`] if [`Loaded::mesh`] is another than that of the file.
    pub fn constrain(&self, options: &mut Options) -> Result<usize, Error> {
        self.original.as_ref().map_or(Ok(0), |original| original.constrain(&self.mesh, options))
    }

    /// The bytes of a file of this name that holds the mesh with other triangles, gzip'd if it ends in `.gz`. In the same
    /// format it is the file again, and only triangles change: each keeps the attributes of its face, faces of which no
    /// triangle is another stay as they are, and new corners have the attributes that their vertex had there before, if
    /// the run was [constrained](Loaded::constrain). A glTF file has other indices, in either form; in other formats its
    /// parts are where its scene places them.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`]; those of [`Mesh::new`] for the triangles, of which there must be as many as before;
    /// [`Error::Option`] for triangles that flips across seams have made; [`Error::FileTooLarge`] where polygons are cut
    /// that have much; [`Error::Io`] as [`write_to`]; [`Error::TooLarge`] for 4 GiB and more of `.glb`.
    pub fn file_bytes(&self, name: impl AsRef<Path>, triangles: Vec<u32>) -> Result<Vec<u8>, Error> {
        let name = name.as_ref();
        collected(name, self.write_to(name, triangles)?)
    }

    /// What writes such a file.
    fn write_to(
        &self,
        name: &Path,
        triangles: Vec<u32>,
    ) -> Result<impl FnOnce(&mut dyn Write) -> io::Result<()>, Error> {
        let format = Format::of(name)?;
        let before = self.mesh.triangles();
        if triangles.len() != before.len() {
            return Err(Error::TriangleCount { length: triangles.len(), expected: before.len() });
        }
        let mesh = self.mesh.with_triangles(triangles)?;
        let content = match &self.document {
            Some(document) if format.is_gltf() => Content::Parts(vec![
                document.with_triangles(before, mesh.triangles(), format == Format::Glb)?.into(),
            ]),
            Some(document) => {
                let placed = document.placed(&mesh);
                Content::Mesh(Mesh::new(Dimension::Three, placed, mesh.triangles().to_vec())?)
            }
            None => match &self.original {
                Some(original) if original.format == format => {
                    Content::Parts(original.with_triangles(&self.mesh, &mesh)?)
                }
                _ => Content::Mesh(mesh),
            },
        };
        let is_packed = gzip::is_named(name);
        Ok(move |out: &mut dyn Write| {
            gzip::write(is_packed, out, |mut out| match &content {
                Content::Parts(parts) => parts.iter().try_for_each(|part| out.write_all(part)),
                Content::Mesh(mesh) => write_to(format, mesh, &mut out),
            })
        })
    }
}

/// What a file is written of.
enum Content<'a> {
    Parts(Vec<Cow<'a, [u8]>>),
    Mesh(Mesh),
}

/// Reads the bytes of a file, which may be gzip'd. Borrowed ones are copied where the file is held ([`ReadOptions::keep`]).
///
/// # Errors
/// [`Error::Parse`], which names the line or the byte, or the vertex that has a height where 2D was asked for;
/// [`Error::TooLarge`]; [`Error::FileTooLarge`].
pub fn parse<'a>(
    format: Format,
    bytes: impl Into<Cow<'a, [u8]>>,
    options: &ReadOptions,
) -> Result<Loaded, Error> {
    parse_with(format, bytes, options, &|_| Err("other files are read only if that is allowed".into()))
}

/// As [`parse`]; `read` gives the content of a file beside this one, or says why it does not.
///
/// # Errors
/// As there.
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
    if let Format::Off | Format::Obj = format
        && let Some(text) = utf8(&bytes)
    {
        bytes = text.into();
    }
    let (parsed, can_be_held) = match format {
        Format::Off => (off::parse(&bytes)?, true),
        Format::Obj => (obj::parse(&bytes)?, true),
        Format::Ply => (ply::parse(&bytes)?, ply::is_held(&bytes)),
        Format::Stl => (stl::parse(&bytes)?, stl::is_held(&bytes)),
        Format::Gltf | Format::Glb => return gltf::load(bytes.into_owned(), options, read),
    };
    // The corners of OBJ may refer to what is not there.
    let is_plain = parsed.dropped.0.is_empty() && format != Format::Obj;
    let loaded = finish(parsed, options.dimension)?;
    let max_bytes = options.max_bytes;
    let plain = is_plain.then_some(loaded.mesh.triangle_count());
    let original = (options.keep && can_be_held).then(|| Original {
        format,
        bytes: bytes.into_owned(),
        max_bytes,
        plain,
    });
    Ok(Loaded { original, ..loaded })
}

/// Writes `mesh`. As text, each number has the fewest digits that read back to the same bits, 32 or 64 of them;
/// [`parse`] reads 32 of text that is no PLY. Give it something buffered.
///
/// # Errors
/// Those of `out`; [`io::ErrorKind::InvalidInput`] for coordinates that STL and glTF cannot hold.
pub fn write_to(format: Format, mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    match format {
        Format::Off => off::write(mesh, out),
        Format::Obj => obj::write(mesh, out),
        Format::Ply => ply::write(mesh, out),
        Format::Stl => stl::write(mesh, out),
        Format::Gltf | Format::Glb => out.write_all(&gltf::new_file(mesh, format == Format::Glb)?),
    }
}

/// What [`write_to`] writes.
///
/// # Errors
/// As there.
pub fn to_bytes(format: Format, mesh: &Mesh) -> io::Result<Vec<u8>> {
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
    collected(name, mesh_writer(name, mesh)?)
}

/// What writes a file of that name.
fn mesh_writer(name: &Path, mesh: &Mesh) -> Result<impl FnOnce(&mut dyn Write) -> io::Result<()>, Error> {
    let (format, is_packed) = (Format::of(name)?, gzip::is_named(name));
    Ok(move |out: &mut dyn Write| gzip::write(is_packed, out, |mut out| write_to(format, mesh, &mut out)))
}

/// The bytes that `write` writes of a file of that name.
fn collected(name: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    match write(&mut bytes) {
        Ok(()) => Ok(bytes),
        Err(source) => Err(Error::Io { path: name.display().to_string(), source }),
    }
}

/// The positions of a mesh in the 32 bits of a format, 3 numbers a vertex.
fn rounded(mesh: &Mesh, format: &str) -> io::Result<Vec<[f32; 3]>> {
    let round = |vertex| {
        let point = mesh.point3(vertex).as_vec3();
        let message = || {
            format!(
                "vertex {vertex} is too far away for the 32-bit numbers of {format}; write PLY, OBJ or OFF"
            )
        };
        let error = || io::Error::new(io::ErrorKind::InvalidInput, message());
        point.is_finite().then(|| point.to_array()).ok_or_else(error)
    };
    (0..mesh.vertex_count() as u32).map(round).collect()
}

/// Text that begins with the byte order mark of UTF-16, in UTF-8; other text is as it is.
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
    let threads = Threads::default().for_triangles(faces.triangles.len() / 3);
    let mesh = Mesh::checked(dimension, positions, faces.triangles, &threads)?;
    Ok(Loaded {
        mesh,
        polygons: faces.polygons,
        dropped: dropped.0,
        notes: Vec::new(),
        document: None,
        original: None,
    })
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
