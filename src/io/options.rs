//! The options for reading a file.

use crate::{Dimension, Error, Plane};

/// The floats that coordinates are read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinates {
    /// 32-bit floats.
    F32,
    /// 64-bit floats.
    F64,
}

/// The options for reading a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReadOptions {
    /// Whether the mesh is in the plane. `None`: it is in the plane if the file has two coordinates per vertex or every
    /// z is 0; a glTF file is always in space.
    pub dimension: Option<Dimension>,
    /// The plane of a terrain, which has three coordinates per vertex then: polygons are cut as seen from above.
    /// [`Mesh::plan`](crate::Mesh::plan) gives its plan. `None`: polygons are cut as seen along their normal.
    pub plane: Option<Plane>,
    /// The floats of the coordinates. `None`: those of a binary file; in text 32-bit floats, if each of them, rounded to
    /// as many digits as its number in the file has, is that number, else 64-bit floats. Then the coordinates are those
    /// that the file shows. A [`Mesh`](crate::Mesh) has 32-bit floats wherever they are the same.
    pub coordinates: Option<Coordinates>,
    /// The most bytes of a file, packed and unpacked. By default 4 GiB, in WebAssembly 1 GiB.
    pub max_bytes: u64,
    /// Whether [`load`](super::load) may read the buffers of a glTF file from other files, in its folder and folders
    /// below.
    pub external_files: bool,
    /// Whether to hold an OFF, OBJ, PLY or binary STL file in memory together with the mesh, so that it can be written
    /// again with its attributes. True by default. A glTF file is always held.
    pub keep: bool,
    /// The names of attributes of faces and corners that lock no edges in [`Loaded::constrain`](super::Loaded): in PLY
    /// the names of the properties of faces, in OBJ the keywords `vt`, `vn`, `usemtl`, `g`, `o`, `s`, `mg` and `usemap`,
    /// in OFF `colour`, in binary STL `attribute`. Each new triangle keeps those of the face that it replaces. A name
    /// that the file does not have is an error.
    pub ignore_attributes: Vec<String>,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            dimension: None,
            plane: None,
            coordinates: None,
            external_files: false,
            keep: true,
            ignore_attributes: Vec::new(),
            max_bytes: if cfg!(target_arch = "wasm32") { 1 << 30 } else { 1 << 32 },
        }
    }
}

impl ReadOptions {
    /// Refuses a file of more than `max_bytes` bytes.
    pub(crate) fn check(&self, bytes: u64) -> Result<(), Error> {
        if bytes > self.max_bytes {
            return Err(Error::FileTooLarge { limit: self.max_bytes, option: "max_bytes" });
        }
        Ok(())
    }
}

/// Reads another file by its path relative to the first one, or returns why it does not.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, String>;
