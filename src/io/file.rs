//! Reads whole mesh files from disk.

use super::format::Format;
use super::lists::{parse_edges, parse_numbers};
use super::loaded::Loaded;
use super::options::ReadOptions;
use super::parse::parse_with;
#[cfg(unix)]
use super::wait::open_to_read;
use crate::{Error, Mesh};
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Reads the mesh of a file. The extension names its format. See [`parse`](super::parse).
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Io`], and those of [`parse`](super::parse).
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Mesh, Error> {
    load(path, &ReadOptions { keep: false, ..options.clone() }).map(|loaded| loaded.mesh)
}

/// As [`read`], and returns what else the file holds and how it was read.
///
/// # Errors
/// Those of [`read`].
pub fn load(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Loaded, Error> {
    let path = path.as_ref();
    let format = Format::of(path)?;
    let bytes = content(path, options)?;
    parse_with(format, bytes, options, &|name| {
        if !options.external_files {
            return Err("reading other files is not allowed; external_files allows it".into());
        }
        beside(&folder(path), name, options).map_err(|error| match error {
            Error::Io { source, .. } => source.to_string(),
            Error::FileTooLarge { limit, .. } => {
                format!("it has more than {limit} bytes; max_bytes sets the limit")
            }
            error => error.to_string(),
        })
    })
}

/// The bytes of a file.
///
/// # Errors
/// [`Error::FileTooLarge`], [`Error::Io`].
fn content(path: &Path, options: &ReadOptions) -> Result<Vec<u8>, Error> {
    let failed = |source| at(path, source);
    let (mut bytes, file) = open_to_read(path).map_err(failed)?;
    let length = file.metadata().map_err(failed)?.len();
    options.check(length)?;
    bytes.try_reserve_exact(length as usize).map_err(|error| failed(error.into()))?;
    // A pipe has length 0, and a file may grow.
    file.take(options.max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(failed)?;
    options.check(bytes.len() as u64)?;
    Ok(bytes)
}

/// The bytes of a regular file in `folder` or a folder below it. Links are followed, and must not lead out.
///
/// # Errors
/// Those of [`content`].
fn beside(folder: &Path, name: &str, options: &ReadOptions) -> Result<Vec<u8>, Error> {
    let failed = |source| at(Path::new(name), source);
    let folder = fs::canonicalize(folder).map_err(failed)?;
    let path = fs::canonicalize(folder.join(name)).map_err(failed)?;
    let refused = |what: &str| failed(io::Error::other(what));
    if !path.starts_with(folder) {
        return Err(refused("a link leads out of the folder of IN; only files in this folder are read"));
    }
    if !fs::metadata(&path).map_err(failed)?.is_file() {
        return Err(refused("it is not a regular file"));
    }
    content(&path, options)
}

#[cfg(not(unix))]
fn open_to_read(path: &Path) -> io::Result<(Vec<u8>, fs::File)> {
    Ok((Vec::new(), fs::File::open(path)?))
}

/// Reads a list of edges from a file with any extension and at most `max_bytes` bytes. See [`parse_edges`].
///
/// # Errors
/// [`Error::FileTooLarge`], [`Error::Io`], and those of [`parse_edges`].
pub fn read_edges(path: impl AsRef<Path>, max_bytes: u64) -> Result<Vec<[u32; 2]>, Error> {
    parse_edges(&content(path.as_ref(), &ReadOptions { max_bytes, ..ReadOptions::default() })?)
}

/// Reads a list of numbers from a file with any extension and at most `max_bytes` bytes. See [`parse_numbers`].
///
/// # Errors
/// [`Error::FileTooLarge`], [`Error::Io`], and those of [`parse_numbers`].
pub fn read_numbers(path: impl AsRef<Path>, max_bytes: u64) -> Result<Vec<u32>, Error> {
    parse_numbers(&content(path.as_ref(), &ReadOptions { max_bytes, ..ReadOptions::default() })?)
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
