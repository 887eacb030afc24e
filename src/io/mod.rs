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
mod format;
mod gltf;
mod gzip;
mod held;
mod lists;
mod loaded;
mod obj;
mod off;
mod options;
mod original;
#[cfg(not(target_arch = "wasm32"))]
mod output;
mod parse;
mod parsed;
mod pieces;
mod ply;
mod rounded;
mod stl;
#[cfg(not(target_arch = "wasm32"))]
mod temporary;
#[cfg(test)]
mod tests;
mod text;
#[cfg(unix)]
mod wait;
mod write;

#[cfg(not(target_arch = "wasm32"))]
pub use file::{load, read, read_edges, read_numbers};
pub use format::Format;
pub use lists::{parse_edges, parse_numbers};
pub use loaded::Loaded;
pub use options::{ReadFile, ReadOptions};
#[cfg(not(target_arch = "wasm32"))]
pub use output::{Output, Staged, rewrite, write};
pub use parse::{parse, parse_with};
#[cfg(not(target_arch = "wasm32"))]
pub use temporary::remove_temporary_files;
pub use write::{to_bytes, to_file_bytes, write_to};
