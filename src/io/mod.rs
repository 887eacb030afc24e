//! Reads and writes mesh files, on disk or as bytes, and reads lists of edges and of numbers.
//!
//! The parsers are our own, because they keep all vertices in their order and name the line or byte of each error. No
//! crate does both (2026-11): `tobj` splits a file into models with their own vertices; `obj-rs` has no line numbers;
//! `obj` checks no index and wants UTF-8 everywhere; `off-rs` knows only the header `OFF`; `ply-rs-bw` compares the
//! name of a property for each number, allocates for each face, names no byte, and fills the memory with 2^64 elements
//! without properties; `serde-ply` names neither line nor byte; `stl_io` takes every file that begins with `solid` for
//! text, -0 and 0 for different positions, and NaN for a number. The tests compare with `ply-rs-bw` and `stl_io`. The
//! crate `flate2` handles gzip, `gltf` the JSON of glTF, and `csv` the quotes of CSV.

mod attributes;
mod coordinates;
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
mod points;
mod polygon;
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

pub use attributes::AttributeEdges;
#[cfg(not(target_arch = "wasm32"))]
pub use file::{load, read, read_edges, read_numbers};
pub use format::Format;
pub use lists::{parse_edges, parse_numbers};
pub use loaded::Loaded;
pub use options::{Coordinates, ReadFile, ReadOptions};
#[cfg(not(target_arch = "wasm32"))]
pub use output::{Output, Staged, rewrite, write};
pub use parse::{parse, parse_with};
#[cfg(not(target_arch = "wasm32"))]
pub use temporary::remove_temporary_files;
pub use write::{to_bytes, to_file_bytes, write_to};
