//! A mesh together with its file, to write the file again with other triangles.

use super::attributes::AttributeEdges;
use super::format::Format;
use super::gltf;
use super::gzip;
use super::obj;
use super::original::Original;
use super::write::{collected, write_to};
use crate::{Dimension, Error, Mesh, Options, Plane, Triangulation, Welded, triangulate, welded};
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

/// A mesh that was read from a file, and what else the file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// All vertices of the file, in its order, and its faces as triangles.
    pub mesh: Mesh,
    /// Faces with more than three corners. Each was cut into triangles: two less than it has corners, and the fan around
    /// its first corner if that does not leave the polygon.
    pub polygons: usize,
    /// Polygons whose outline crosses or touches itself, seen along their normal: their numbers among the faces of the
    /// file, from 0. Each was cut into the fan around its first corner.
    pub crossing: Vec<u32>,
    /// What the file has that a [`Mesh`] cannot hold, such as `normals`. [`Loaded::dropped_in`] says what a file of a
    /// given format loses.
    pub dropped: Vec<String>,
    /// Other notes about the file, a sentence each.
    pub notes: Vec<String>,
    /// The file itself, if it is glTF.
    pub(super) document: Option<gltf::Document>,
    /// The file itself, if it is held and not glTF.
    pub(super) original: Option<Original>,
}

impl Loaded {
    /// The positions in the scene of a glTF file, to draw the mesh: 3 numbers per vertex. The mesh itself has the
    /// coordinates of the file, each part in its own system, and the flips use those. `None` for other formats.
    pub fn placed(&self) -> Option<Vec<f32>> {
        self.document.as_ref().map(|document| document.placed(&self.mesh))
    }

    /// The mesh with the vertices at the same position joined. In a glTF file, only vertices of the same primitive are
    /// joined, and an edge where their other accessors differ is a seam.
    ///
    /// # Errors
    /// [`Error::Parse`] for a glTF file whose JSON has an array where an object is expected.
    pub fn welded(&self) -> Result<Welded, Error> {
        match &self.document {
            Some(document) => document.welded(&self.mesh),
            None => welded(&self.mesh, None),
        }
    }

    /// Whether the file has vertices and no faces, and is not glTF.
    pub fn has_points_only(&self) -> bool {
        self.document.is_none() && self.mesh.triangle_count() == 0 && self.mesh.vertex_count() > 0
    }

    /// Gives a mesh of points their Delaunay triangulation in this plane: heights are carried along. A file of the same
    /// format is then written as one of another format is.
    ///
    /// # Errors
    /// Those of [`triangulate`] and [`Mesh::plan`].
    pub fn triangulate(&mut self, plane: Plane) -> Result<Triangulation, Error> {
        let triangulation = triangulate(self.mesh.plan(plane)?.positions())?;
        self.mesh = self.mesh.with_triangles(triangulation.triangles.clone())?;
        self.original = None;
        Ok(triangulation)
    }

    /// The same with a mesh of other vertices: a file is then written as one of another format is.
    #[must_use]
    pub fn with_mesh(&self, mesh: Mesh) -> Self {
        Self { mesh, document: None, original: None, ..self.clone() }
    }

    /// What a file of that format loses of [`Loaded::dropped`].
    pub fn dropped_in(&self, format: Format) -> &[String] {
        if self.keeps(format) { &[] } else { &self.dropped }
    }

    /// Whether a file of that format is this file with other triangles.
    pub fn keeps(&self, format: Format) -> bool {
        let is_same = self.original.as_ref().is_some_and(|original| original.format == format);
        is_same || format.is_gltf() && self.document.is_some()
    }

    /// Prepares the file to be written in another folder: a glTF file gets the buffers that are in other files. Returns
    /// the names of the files that it still refers to, with materials (OBJ) or images (glTF).
    pub fn leave_folder(&mut self) -> Vec<String> {
        match (&mut self.document, &self.original) {
            (Some(document), _) => {
                document.embeds = true;
                document.images.clone()
            }
            (_, Some(original)) if original.format == Format::Obj => {
                let mut names = obj::libraries(&original.bytes);
                names.retain(|name| !Path::new(name).is_absolute());
                names
            }
            _ => Vec::new(),
        }
    }

    /// Adds locks to the options of a run, so that faces and corners keep their attributes in a file of the same
    /// format. Returns the locked edges. They are the borders of groups of triangles with the same material or colour,
    /// and seams, where corners of a vertex differ in texture coordinates or normals; but not those of attributes that
    /// [`ReadOptions::ignore_attributes`](super::ReadOptions) names. A glTF file needs no locks, since its attributes
    /// belong to vertices.
    ///
    /// # Errors
    /// [`Error::TriangleCount`] if [`Loaded::mesh`] is not the mesh of the file.
    pub fn constrain(&self, options: &mut Options) -> Result<AttributeEdges, Error> {
        let original = self.original.as_ref();
        original.map_or(Ok(AttributeEdges::default()), |original| original.constrain(&self.mesh, options))
    }

    /// The bytes of a file with this name that holds the mesh with other triangles, gzip'd if the name ends in `.gz`.
    /// In the same format it is the same file, and only faces that contain a changed triangle are rewritten. If the run
    /// was [constrained](Loaded::constrain), each triangle keeps the attributes of its face, and each new corner has
    /// the attributes of its vertex there. An ignored attribute of corners that is the same in a whole triangle stays
    /// the same there; else each new corner has that of a corner of an old triangle beside it. A glTF file gets other
    /// indices, as `.gltf` or `.glb`. In other formats, the parts of a glTF file have their positions in the scene.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`]; [`Error::TriangleCount`] and those of [`Mesh::new`] for the triangles;
    /// [`Error::Option`] for triangles from flips across seams; [`Error::FileTooLarge`] if cut polygons repeat too many
    /// attributes; [`Error::Io`] as in [`write_to`](super::write_to); [`Error::TooLarge`] for a `.glb` file of 4 GiB or
    /// more.
    pub fn file_bytes(&self, name: impl AsRef<Path>, triangles: Vec<u32>) -> Result<Vec<u8>, Error> {
        let name = name.as_ref();
        collected(name, self.write_to(name, triangles)?)
    }

    /// A function that writes such a file.
    pub(super) fn write_to(
        &self,
        name: &Path,
        triangles: Vec<u32>,
    ) -> Result<impl FnOnce(&mut dyn Write) -> io::Result<()>, Error> {
        let format = Format::of_output(name)?;
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

/// The content of a file to write.
enum Content<'a> {
    Parts(Vec<Cow<'a, [u8]>>),
    Mesh(Mesh),
}
