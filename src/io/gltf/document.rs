//! A glTF file that is held, and which of its primitives the triangles of a mesh are.

use super::buffers::Buffers;
use super::container::Container;
use super::root::Root;
use crate::{Error, Mesh};
use glam::DMat4;
use std::collections::BTreeMap;
use std::ops::Range;

/// A glTF file, and which of its primitives the triangles of a mesh are.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::io) struct Document {
    pub(super) bytes: Vec<u8>,
    /// The files beside it that it refers to.
    pub(super) files: BTreeMap<String, Vec<u8>>,
    pub(super) parts: Vec<Part>,
}

/// Triangles that are one primitive of the file, or several with the same positions and indices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Part {
    /// Each as a mesh of the file and one of its primitives.
    pub(super) users: Vec<[usize; 2]>,
    pub(super) vertices: Range<usize>,
    /// The elements of the accessor that these vertices are, where they are not all of them.
    pub(super) elements: Option<Vec<u32>>,
    pub(super) triangles: Range<usize>,
    /// The accessor of the indices of a list of triangles.
    pub(super) indices: Option<usize>,
    /// From the mesh's coordinates to those of the scene.
    pub(super) world: DMat4,
}

impl Document {
    /// Its buffers, those in other files too.
    pub(super) fn buffers(&self, root: &Root, container: &Container) -> Result<Buffers<'_>, Error> {
        let read = |name: &str| Ok(self.files.get(name).cloned().unwrap_or_default());
        Buffers::of(root, container.binary.clone().map(|range| &self.bytes[range]), &read)
    }

    /// Positions in the scene, to draw it: each part where the first node that has it places it, 3 numbers a vertex.
    /// `mesh` has the positions that were read.
    pub(in crate::io) fn placed(&self, mesh: &Mesh) -> Vec<f32> {
        let place = |part: &Part| {
            let world = part.world;
            part.vertices
                .clone()
                .map(move |v| world.transform_point3(mesh.point3(v as u32)).as_vec3().to_array())
        };
        self.parts.iter().flat_map(place).flatten().collect()
    }
}
