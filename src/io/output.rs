//! Writes meshes: replaces a file atomically, or writes into a device, a pipe or the standard output.

use super::file::{at, folder};
use super::format::Format;
use super::loaded::Loaded;
use super::temporary::Temporary;
use super::write::mesh_writer;
use crate::{Error, Mesh};
use std::fs::{self, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Bytes of the write buffer.
const BUFFER: usize = 1 << 18;

/// The most consecutive links to follow, as in Linux.
const LINKS: usize = 40;

/// Where to write a mesh, and in which format.
#[derive(Clone, Debug)]
pub struct Output {
    target: Target,
    /// The path in messages.
    path: PathBuf,
    /// A name with the extension of the format, and `.gz` if it is gzip'd.
    name: PathBuf,
    format: Format,
}

#[derive(Clone, Debug)]
enum Target {
    /// A regular file, which may not exist yet; the path has no links.
    File(PathBuf),
    /// An existing file that is not regular.
    Stream(PathBuf),
    Standard,
}

impl Output {
    /// The target at `path`. Links are followed, also to a file that does not exist yet. The extension names the
    /// format; `.gz` after it means gzip. If `path` is a device, a FIFO or a name of the standard output, and has no
    /// known extension, the name `like` decides the format; if it is one of points, PLY.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`]; [`Error::Io`] for a folder, for a cycle of links, and if the folder of a new file does
    /// not exist.
    pub fn of(path: impl AsRef<Path>, like: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let target = Target::of(path);
        let name = match (Format::of_output(path), &target) {
            (Ok(_), _) => path,
            (Err(_), Ok(Target::Stream(_) | Target::Standard)) => written_as(like.as_ref())?,
            (Err(error), _) => return Err(error),
        };
        let format = Format::of_output(name)?;
        let target = target.map_err(|source| at(path, source))?;
        Ok(Self { target, path: path.into(), name: name.into(), format })
    }

    /// The standard output. The name `like` decides the format; if it is one of points, PLY.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`].
    pub fn standard(like: impl AsRef<Path>) -> Result<Self, Error> {
        let name = written_as(like.as_ref())?;
        let format = Format::of_output(name)?;
        Ok(Self { target: Target::Standard, path: "standard output".into(), name: name.into(), format })
    }

    /// The format.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Whether it is a file in the folder of the file at `path`.
    pub fn is_beside(&self, path: impl AsRef<Path>) -> bool {
        let Target::File(target) = &self.target else { return false };
        let folders = [target, path.as_ref()].map(|path| fs::canonicalize(folder(path)).ok());
        folders[0].is_some() && folders[0] == folders[1]
    }

    /// Whether it is the standard output.
    pub fn is_standard(&self) -> bool {
        matches!(self.target, Target::Standard)
    }

    /// Writes `loaded` with other triangles; see [`Loaded::file_bytes`]. A regular file stays unchanged until
    /// [`Staged::commit`]. A device or a pipe has all bytes when this returns.
    ///
    /// # Errors
    /// Those of [`Loaded::file_bytes`]; also [`Error::Io`] if no process opens a FIFO for reading within 10 s.
    pub fn stage(&self, loaded: &Loaded, triangles: Vec<u32>) -> Result<Staged, Error> {
        self.stage_with(loaded.write_to(&self.name, triangles)?)
    }

    fn stage_with(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<Staged, Error> {
        let replacement = match &self.target {
            Target::File(path) => Replacement::written(path, write).map(Some),
            Target::Stream(path) => open_to_write(path).and_then(|file| buffered(file, write)).map(|()| None),
            Target::Standard => buffered(io::stdout().lock(), write).map(|()| None),
        };
        let path = self.path.clone();
        match replacement {
            Ok(replacement) => Ok(Staged { path, replacement }),
            Err(source) => Err(at(&path, source)),
        }
    }
}

/// A name with the format of the file at `path`, if such a file can be written. Points become a PLY file.
fn written_as(path: &Path) -> Result<&Path, Error> {
    Ok(if Format::of(path)?.has_points_only() { Path::new("points.ply") } else { path })
}

/// A written file that has not replaced the old one yet. Dropping it removes the file.
#[must_use = "the file has its name after `commit`"]
pub struct Staged {
    path: PathBuf,
    replacement: Option<Replacement>,
}

impl Staged {
    /// Gives the file its name. Returns what could not be kept of the old file, a sentence each.
    ///
    /// # Errors
    /// [`Error::Io`].
    pub fn commit(self) -> Result<Vec<String>, Error> {
        let Self { path, replacement } = self;
        let Some(Replacement { temporary, target, lost }) = replacement else { return Ok(Vec::new()) };
        temporary.rename(&target).map_err(|source| at(&path, source))?;
        Ok(lost.into_iter().map(|lost| format!("{}: {lost}", path.display())).collect())
    }
}

struct Replacement {
    temporary: Temporary,
    target: PathBuf,
    /// What could not be kept of the file at the target.
    lost: Vec<String>,
}

impl Replacement {
    fn written(target: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<Self> {
        let present = fs::metadata(target).ok();
        let temporary = Temporary::new_in(&folder(target), present.is_some())?;
        buffered(temporary.file(), write)?;
        let lost = present.map_or(Ok(Vec::new()), |present| keep(&present, temporary.file()))?;
        Ok(Self { temporary, target: target.into(), lost })
    }
}

fn buffered(out: impl Write, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(BUFFER, out);
    write(&mut out)?;
    out.flush()
}

/// Gives a new file the owner, group and mode of the file that it replaces. Returns what could not be kept.
#[cfg(unix)]
fn keep(present: &Metadata, file: &fs::File) -> io::Result<Vec<String>> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let mut lost = Vec::new();
    let own = file.metadata()?;
    let mut mode = present.mode() & 0o7777;
    let mut hand_over = |what, before: u32, now: u32, result: io::Result<()>| {
        if let Err(error) = result {
            lost.push(format!("its {what} changed from {before} to {now} ({error})"));
            // The bits set-user-id and set-group-id must not pass to another owner or group.
            mode &= 0o777;
            if what == "group" {
                mode = for_others(mode);
            }
        }
    };
    if own.gid() != present.gid() {
        hand_over("group", present.gid(), own.gid(), fchown(file, None, Some(present.gid())));
    }
    if own.uid() != present.uid() {
        hand_over("owner", present.uid(), own.uid(), fchown(file, Some(present.uid()), None));
    }
    file.set_permissions(fs::Permissions::from_mode(mode))?;
    if present.nlink() > 1 {
        lost.push(format!("its other names (hard links: {}) keep the old content", present.nlink() - 1));
    }
    Ok(lost)
}

/// The mode with the permissions of the group limited to those of all users.
#[cfg(unix)]
fn for_others(mode: u32) -> u32 {
    mode & !0o070 | (mode & 0o007) << 3 & mode
}

#[cfg(not(unix))]
fn keep(present: &Metadata, file: &fs::File) -> io::Result<Vec<String>> {
    file.set_permissions(present.permissions())?;
    Ok(Vec::new())
}

#[cfg(unix)]
use super::wait::open_to_write;

#[cfg(not(unix))]
fn open_to_write(path: &Path) -> io::Result<fs::File> {
    fs::File::options().write(true).open(path)
}

impl Target {
    fn of(path: &Path) -> io::Result<Self> {
        // For a cycle of links, the system returns an error here.
        let present = match fs::metadata(path) {
            Ok(present) => Some(present),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) if error.kind() == io::ErrorKind::NotADirectory => None,
            Err(error) => return Err(error),
        };
        let (path, descriptor) = followed(path);
        match present {
            Some(present) if present.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
            Some(present) if descriptor == Some(1) || is_standard_output(&present) => Ok(Self::Standard),
            Some(present) if present.is_file() && descriptor.is_none() => {
                Ok(Self::File(fs::canonicalize(path)?))
            }
            Some(_) => Ok(Self::Stream(path)),
            None if descriptor.is_some() => Err(io::ErrorKind::NotFound.into()),
            None if !folder(&path).is_dir() => {
                Err(io::Error::new(io::ErrorKind::NotFound, "the folder does not exist"))
            }
            None => Ok(Self::File(path)),
        }
    }
}

/// The path at the end of a chain of links, whether it exists or not. A path that names an open file of a process, such
/// as `/proc/self/fd/1`, is not followed: that file may have lost its name. Then the result has its descriptor, or
/// `u32::MAX` if it belongs to another process.
fn followed(path: &Path) -> (PathBuf, Option<u32>) {
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        let descriptor = descriptor(&path);
        if descriptor.is_some() {
            return (path, descriptor);
        }
        match fs::read_link(&path) {
            Ok(link) => path = folder(&path).join(link),
            Err(_) => break,
        }
    }
    (path, None)
}

/// The descriptor that a path such as `/proc/self/fd/1` or `/dev/fd/1` names.
#[cfg(unix)]
fn descriptor(path: &Path) -> Option<u32> {
    let folder = fs::canonicalize(folder(path)).ok()?;
    let is_own =
        folder == Path::new("/dev/fd") || folder.starts_with(format!("/proc/{}", std::process::id()));
    let number = path.file_name()?.to_str()?.parse().ok()?;
    let is_folder_of_files =
        folder.ends_with("fd") && (folder.starts_with("/proc") || folder.starts_with("/dev"));
    is_folder_of_files.then_some(if is_own { number } else { u32::MAX })
}

#[cfg(not(unix))]
fn descriptor(_: &Path) -> Option<u32> {
    None
}

/// Whether this is the file or the pipe behind the standard output. False for devices: two writers to a device, such as
/// the null device, do no harm.
#[cfg(unix)]
fn is_standard_output(present: &Metadata) -> bool {
    use std::os::fd::AsFd;
    use std::os::unix::fs::{FileTypeExt, MetadataExt};
    let kind = present.file_type();
    if kind.is_char_device() || kind.is_block_device() {
        return false;
    }
    let standard = io::stdout().as_fd().try_clone_to_owned().and_then(|file| fs::File::from(file).metadata());
    standard.is_ok_and(|standard| (standard.dev(), standard.ino()) == (present.dev(), present.ino()))
}

#[cfg(not(unix))]
fn is_standard_output(_: &Metadata) -> bool {
    false
}

/// Writes `mesh` to a file. The extension names the format; `.gz` after it means gzip. The file appears or changes in
/// one step, after everything is written, so a failure leaves the old file unchanged. Links are followed. A replaced
/// file keeps its owner, group and mode; the result says what could not be kept, a sentence each. A device, a FIFO or
/// the standard output is written into.
///
/// # Errors
/// [`Error::UnknownFormat`] or [`Error::Io`].
pub fn write(path: impl AsRef<Path>, mesh: &Mesh) -> Result<Vec<String>, Error> {
    let output = Output::of(&path, &path)?;
    output.stage_with(mesh_writer(&output.name, mesh)?)?.commit()
}

/// As [`write()`], for a file that was read and has other triangles; see [`Loaded::file_bytes`].
///
/// # Errors
/// Those of [`Output::of`], [`Output::stage`] and [`Staged::commit`].
pub fn rewrite(path: impl AsRef<Path>, loaded: &Loaded, triangles: Vec<u32>) -> Result<Vec<String>, Error> {
    Output::of(&path, &path)?.stage(loaded, triangles)?.commit()
}

#[cfg(all(test, unix))]
mod tests {
    use super::for_others;

    #[test]
    fn another_group_may_do_what_others_may() {
        for (mode, want) in [(0o660, 0o600), (0o664, 0o644), (0o640, 0o600), (0o604, 0o604), (0o777, 0o777)] {
            assert_eq!(for_others(mode), want, "{mode:o}");
        }
    }
}
