//! A held glTF file, and the primitives that the triangles of the mesh came from.

use super::buffers::Buffers;
use super::container::Container;
use super::root::Root;
use crate::{Error, Mesh};
use glam::DMat4;
use std::collections::BTreeMap;
use std::ops::Range;

/// A glTF file, and the primitives that the triangles of the mesh came from.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::io) struct Document {
    pub(super) bytes: Vec<u8>,
    /// The other files that it refers to.
    pub(super) files: BTreeMap<String, Vec<u8>>,
    /// The names of the files of its images.
    pub(in crate::io) images: Vec<String>,
    /// Whether it is written with the buffers that are in other files.
    pub(in crate::io) embeds: bool,
    pub(super) parts: Vec<Part>,
}

/// The triangles of one primitive of the file, or of several with the same positions and indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Part {
    /// The primitives: the index of a mesh, and that of a primitive in it.
    pub(super) users: Vec<[usize; 2]>,
    pub(super) vertices: Range<usize>,
    /// The elements of the accessor of positions that are these vertices, if they are not all elements.
    pub(super) elements: Option<Vec<u32>>,
    pub(super) triangles: Range<usize>,
    /// The accessor of indices, if the primitive is a list of triangles.
    pub(super) indices: Option<usize>,
    /// Maps the mesh's coordinates to those of the scene.
    pub(super) world: DMat4,
}

impl Document {
    /// Its buffers, including those in other files.
    pub(super) fn buffers(&self, root: &Root, container: &Container) -> Result<Buffers<'_>, Error> {
        let read = |name: &str| Ok(self.files.get(name).cloned().unwrap_or_default());
        Buffers::of(root, container.binary.clone().map(|range| &self.bytes[range]), &read)
    }

    /// Positions in the scene, to draw it: 3 numbers per vertex. Each part is at the position of the first node that
    /// has it. `mesh` has the positions that were read.
    pub(in crate::io) fn placed(&self, mesh: &Mesh) -> Vec<f32> {
        let in_scene = |part: &Part| {
            let world = part.world;
            part.vertices
                .clone()
                .map(move |v| world.transform_point3(mesh.point3(v as u32)).as_vec3().to_array())
        };
        self.parts.iter().flat_map(in_scene).flatten().collect()
    }
}
