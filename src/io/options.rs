//! What the caller of a reader can choose.

use crate::{Dimension, Error};

/// What can be chosen for reading a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadOptions {
    /// Whether the mesh lies in the plane; `None`: if the file has two coordinates a vertex or every z is 0, and is no
    /// glTF.
    pub dimension: Option<Dimension>,
    /// How many bytes a file may have, and a gzip'd one also once it is unpacked. By default 4 GiB, in WebAssembly 1 GiB.
    pub max_bytes: u64,
    /// Whether [`load`](super::load) may read the files beside a glTF file, in its folder and those below, that its buffers are in.
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

/// Reads a file that lies beside the one that is read, by its name there.
/// Else it says why not.
pub type ReadFile<'a> = &'a dyn Fn(&str) -> Result<Vec<u8>, String>;
