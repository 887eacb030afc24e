//! Writes a mesh as a new file.

use super::format::Format;
use super::{gltf, gzip, obj, off, ply, stl};
use crate::{Error, Mesh};
use std::io::{self, Write};
use std::path::Path;

/// Writes `mesh`. In text formats, each number has the fewest digits that read back to the same 32 or 64 bits; 64 need
/// [`Coordinates::F64`](super::Coordinates::F64) if 32-bit floats show all digits. `out` should be buffered.
///
/// # Errors
/// Those of `out`; [`io::ErrorKind::InvalidInput`] for coordinates that STL and glTF cannot hold.
pub fn write_to(format: Format, mesh: &Mesh, out: &mut impl Write) -> io::Result<()> {
    match format {
        Format::Off => off::write(mesh, out),
        Format::Obj => obj::write(mesh, out),
        Format::Ply => ply::write(mesh, out),
        Format::Stl => stl::write(mesh, out),
        Format::Gltf | Format::Glb => out.write_all(&gltf::new_file(mesh, format == Format::Glb)?),
        Format::Csv | Format::Xyz => Err(io::Error::other("a file of points has no triangles")),
    }
}

/// The bytes that [`write_to`] writes.
///
/// # Errors
/// Those of [`write_to`].
pub fn to_bytes(format: Format, mesh: &Mesh) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    write_to(format, mesh, &mut bytes)?;
    Ok(bytes)
}

/// The bytes of a file with this name that holds `mesh`: in the format of the extension, gzip'd if `.gz` follows.
///
/// # Errors
/// [`Error::UnknownFormat`]; [`Error::Io`] with an error of [`write_to`].
pub fn to_file_bytes(name: impl AsRef<Path>, mesh: &Mesh) -> Result<Vec<u8>, Error> {
    let name = name.as_ref();
    collected(name, mesh_writer(name, mesh)?)
}

/// A function that writes a file with this name.
pub(super) fn mesh_writer(
    name: &Path,
    mesh: &Mesh,
) -> Result<impl FnOnce(&mut dyn Write) -> io::Result<()>, Error> {
    let (format, is_packed) = (Format::of_output(name)?, gzip::is_named(name));
    Ok(move |out: &mut dyn Write| gzip::write(is_packed, out, |mut out| write_to(format, mesh, &mut out)))
}

/// The bytes that `write` writes. `name` is for the error.
pub(super) fn collected(
    name: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<Vec<u8>, Error> {
    let mut bytes = Vec::new();
    match write(&mut bytes) {
        Ok(()) => Ok(bytes),
        Err(source) => Err(Error::Io { path: name.display().to_string(), source }),
    }
}
