//! File formats, by extension.

use super::gzip;
use crate::Error;
use std::path::Path;

/// A file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Geomview's object file format, text: `.off`.
    Off,
    /// Wavefront's object format: `.obj`.
    Obj,
    /// The Stanford triangle format, text or binary: `.ply`. New files are binary. Only this format keeps all bits of
    /// 64-bit floats.
    Ply,
    /// Stereolithography, text or binary: `.stl`. Its triangles share no vertices: the reader makes one vertex of all
    /// corners at the same position. New files are binary, with 32-bit floats; 64-bit floats are rounded.
    Stl,
    /// glTF 2.0 as JSON: `.gltf`. It has 32-bit floats; 64-bit floats are rounded.
    Gltf,
    /// glTF 2.0 in one binary file: `.glb`.
    Glb,
    /// Points as comma-separated values: `.csv`. Such a file is only read.
    Csv,
    /// Points, with white space between the numbers of each: `.xyz`. Such a file is only read.
    Xyz,
}

impl Format {
    /// The known extensions, as [`Error::UnknownFormat`] lists them.
    pub const KNOWN: &'static str = ".off, .obj, .ply, .stl, .gltf, .glb, .csv, .xyz, also gzip'd (.gz)";

    /// The extensions of files that can be written.
    pub const WRITTEN: &'static str = ".off, .obj, .ply, .stl, .gltf, .glb, also gzip'd (.gz)";

    /// The format of the extension of `path`, in upper or lower case. Skips `.gz` after the extension.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`].
    pub fn of(path: &Path) -> Result<Self, Error> {
        let name = if gzip::is_named(path) { Path::new(path.file_stem().unwrap_or_default()) } else { path };
        match gzip::extension(name).as_deref() {
            Some("off") => Ok(Self::Off),
            Some("obj") => Ok(Self::Obj),
            Some("ply") => Ok(Self::Ply),
            Some("stl") => Ok(Self::Stl),
            Some("gltf") => Ok(Self::Gltf),
            Some("glb") => Ok(Self::Glb),
            Some("csv") => Ok(Self::Csv),
            Some("xyz") => Ok(Self::Xyz),
            _ => Err(Error::UnknownFormat { path: path.display().to_string(), known: Self::KNOWN }),
        }
    }

    /// The same for a file to write.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`], also for a format that is only read.
    pub fn of_output(path: &Path) -> Result<Self, Error> {
        let format = Self::of(path).ok().filter(|format| !format.has_points_only());
        format.ok_or_else(|| Error::UnknownFormat { path: path.display().to_string(), known: Self::WRITTEN })
    }

    /// Whether a file of this format has points and no triangles. Then it is only read.
    pub fn has_points_only(self) -> bool {
        matches!(self, Self::Csv | Self::Xyz)
    }

    /// Whether a file of this format can have 64-bit coordinates. Other formats have 32-bit ones when they are written.
    pub fn has_doubles(self) -> bool {
        matches!(self, Self::Off | Self::Obj | Self::Ply | Self::Csv | Self::Xyz)
    }

    pub(super) fn is_gltf(self) -> bool {
        matches!(self, Self::Gltf | Self::Glb)
    }
}
