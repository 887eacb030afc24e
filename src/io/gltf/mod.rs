//! glTF 2.0, JSON (`.gltf`) and binary (`.glb`), by the crate `gltf`. Source: the specification of the Khronos Group,
//! glTF 2.0.1.
//!
//! Each primitive of triangles is a part of the mesh, with its own vertices, so the borders between primitives stay.
//! The mesh has the positions of the file, so the flips are exact for the file's own numbers. Only where nodes stretch
//! a mesh unevenly, the mesh has stretched positions. The writer writes the same file with other indices.

mod accessors;
mod buffers;
mod container;
mod document;
mod errors;
mod nesting;
mod placement;
mod read;
mod root;
#[cfg(test)]
mod tests;
mod weld_primitives;
mod write;

pub(super) use document::Document;
pub(super) use read::{Content, read};
pub(super) use write::new_file;
