//! A mesh with the file that it was read from, and that file with other triangles.

use super::format::Format;
use super::gltf;
use super::gzip;
use super::original::Original;
use super::write::{collected, write_to};
use crate::{Dimension, Error, Mesh, Options, Welded, welded};
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

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
    pub(super) document: Option<gltf::Document>,
    /// The file itself, if it is held and of another format.
    pub(super) original: Option<Original>,
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
    /// that have much; [`Error::Io`] as [`write_to`](super::write_to); [`Error::TooLarge`] for 4 GiB and more of `.glb`.
    pub fn file_bytes(&self, name: impl AsRef<Path>, triangles: Vec<u32>) -> Result<Vec<u8>, Error> {
        let name = name.as_ref();
        collected(name, self.write_to(name, triangles)?)
    }

    /// What writes such a file.
    pub(super) fn write_to(
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
