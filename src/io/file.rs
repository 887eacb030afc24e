//! Mesh files on disk, a whole file at once.

use super::{Format, Loaded, ReadOptions, parse_edges, parse_numbers, parse_with};
use crate::{Error, Mesh};
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Reads the mesh of a file; the extension names its format. See [`parse`](super::parse).
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Io`], and those of [`parse`](super::parse).
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Mesh, Error> {
    load(path, &ReadOptions { keep: false, ..*options }).map(|loaded| loaded.mesh)
}

/// As [`read`], and says what was done to the file's content.
///
/// # Errors
/// As [`read`].
pub fn load(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Loaded, Error> {
    let path = path.as_ref();
    let format = Format::of(path)?;
    let file = fs::File::open(path).map_err(|source| at(path, source))?;
    let length = file.metadata().map_err(|source| at(path, source))?.len();
    options.check(length)?;
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(length as usize).map_err(|error| at(path, error.into()))?;
    // A pipe has the length 0, and a file may grow.
    let mut limited = file.take(options.max_bytes.saturating_add(1));
    limited.read_to_end(&mut bytes).map_err(|source| at(path, source))?;
    parse_with(format, bytes, options, &|name| {
        if !options.external_files {
            return Err("other files are read only if that is allowed (--external-files)".into());
        }
        let limited = fs::File::open(folder(path).join(name))
            .map(|file| file.take(options.max_bytes.saturating_add(1)));
        let mut bytes = Vec::new();
        let read = limited.and_then(|mut file| file.read_to_end(&mut bytes));
        read.map(|_| bytes).map_err(|error| error.to_string())
    })
}

/// Reads a list of edges, whatever the extension of its file. See [`parse_edges`].
///
/// # Errors
/// [`Error::Io`], and those of [`parse_edges`].
pub fn read_edges(path: impl AsRef<Path>) -> Result<Vec<[u32; 2]>, Error> {
    let path = path.as_ref();
    let bytes = fs::read(path).map_err(|source| at(path, source))?;
    parse_edges(&bytes)
}

/// The same for a list of numbers. See [`parse_numbers`].
///
/// # Errors
/// [`Error::Io`], and those of [`parse_numbers`].
pub fn read_numbers(path: impl AsRef<Path>) -> Result<Vec<u32>, Error> {
    let path = path.as_ref();
    let bytes = fs::read(path).map_err(|source| at(path, source))?;
    parse_numbers(&bytes)
}

pub(super) fn at(path: &Path, source: io::Error) -> Error {
    Error::Io { path: path.display().to_string(), source }
}

/// The folder of a file.
pub(super) fn folder(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    }
}
