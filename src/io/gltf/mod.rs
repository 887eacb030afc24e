//! glTF 2.0, JSON (`.gltf`) and binary (`.glb`), by the crate `gltf`. Source: the specification of the Khronos Group,
//! glTF 2.0.1.
//!
//! Each primitive of triangles is a part of the mesh, with vertices of its own: what two primitives share stays as it
//! is. Positions are those of the file, so that what is Delaunay is decided on the file's own numbers; only where nodes
//! stretch a mesh unevenly are they stretched too. What is written is the file again, with other indices.

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
mod weld;
mod write;

pub(super) use document::Document;
pub(super) use read::{Content, read};
pub(super) use write::new_file;
