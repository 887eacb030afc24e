//! Where a mesh is written: a file changes at once or not at all; devices, pipes and the standard output are written into.

use super::file::{at, folder};
use super::format::Format;
use super::loaded::Loaded;
use super::temporary::Temporary;
use super::write::mesh_writer;
use crate::{Error, Mesh};
use std::fs::{self, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Bytes that are written at once.
const BUFFER: usize = 1 << 18;

/// Links that are followed one after another, as many as Linux follows.
const LINKS: usize = 40;

/// Where a mesh is to be written, and in which format.
#[derive(Clone, Debug)]
pub struct Output {
    place: Place,
    /// As it is in messages.
    path: PathBuf,
    /// A name with the extension of the format, and `.gz` if it is gzip'd.
    name: PathBuf,
    format: Format,
}

#[derive(Clone, Debug)]
enum Place {
    /// A regular file, without links on the way, or where there is none yet.
    File(PathBuf),
    /// What is no regular file.
    Stream(PathBuf),
    Standard,
}

impl Output {
    /// What is at `path` after links are followed; the link of a file that is not there yet leads to where it will be.
    /// The extension names the format, and if `.gz` follows, it is gzip'd. What is no regular file, such as a device, a
    /// FIFO or the standard output by one of its names, may have no extension that is known: then it is written as a file
    /// with the name `like`.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`]; [`Error::Io`] for a folder, for links that go round, and where there is no folder for a
    /// new file.
    pub fn of(path: impl AsRef<Path>, like: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let place = Place::of(path);
        let name = match (Format::of(path), &place) {
            (Ok(_), _) => path,
            (Err(_), Ok(Place::Stream(_) | Place::Standard)) => like.as_ref(),
            (Err(error), _) => return Err(error),
        };
        let format = Format::of(name)?;
        let place = place.map_err(|source| at(path, source))?;
        Ok(Self { place, path: path.into(), name: name.into(), format })
    }

    /// The standard output, which is written as a file with the name `like`.
    ///
    /// # Errors
    /// [`Error::UnknownFormat`].
    pub fn standard(like: impl AsRef<Path>) -> Result<Self, Error> {
        let name = like.as_ref();
        let format = Format::of(name)?;
        Ok(Self { place: Place::Standard, path: "standard output".into(), name: name.into(), format })
    }

    /// The format that is written.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Whether it is the standard output.
    pub fn is_standard(&self) -> bool {
        matches!(self.place, Place::Standard)
    }

    /// Writes what was read with other triangles; see [`Loaded::file_bytes`]. A file is as it was until [`Staged::commit`];
    /// a device or a pipe has all of it when this returns.
    ///
    /// # Errors
    /// Those of [`Loaded::file_bytes`]. [`Error::Io`] also where nobody reads a FIFO for 10 s.
    pub fn stage(&self, loaded: &Loaded, triangles: Vec<u32>) -> Result<Staged, Error> {
        self.stage_with(loaded.write_to(&self.name, triangles)?)
    }

    fn stage_with(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<Staged, Error> {
        let replacement = match &self.place {
            Place::File(target) => Replacement::written(target, write).map(Some),
            Place::Stream(path) => open_to_write(path).and_then(|file| buffered(file, write)).map(|()| None),
            Place::Standard => buffered(io::stdout().lock(), write).map(|()| None),
        };
        let path = self.path.clone();
        match replacement {
            Ok(replacement) => Ok(Staged { path, replacement }),
            Err(source) => Err(at(&path, source)),
        }
    }
}

/// A file that is written and has not taken the place of the old one. If it is dropped, it is removed.
#[must_use = "the file has its name after `commit`"]
pub struct Staged {
    path: PathBuf,
    replacement: Option<Replacement>,
}

impl Staged {
    /// Gives the file its name. What of an old one could not be kept is said in a sentence each.
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

/// Gives a new file the owner, the group and the mode of the one it replaces, and says what could not be kept of that.
#[cfg(unix)]
fn keep(present: &Metadata, file: &fs::File) -> io::Result<Vec<String>> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    let mut lost = Vec::new();
    let own = file.metadata()?;
    let mut mode = present.mode() & 0o7777;
    let mut hand_over = |what, before: u32, now: u32, result: io::Result<()>| {
        if let Err(error) = result {
            lost.push(format!("its {what} was {before} and is {now} now ({error})"));
            // What a program may do as its owner or group is not for another one.
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

/// A mode that lets another group do no more than others may.
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

impl Place {
    fn of(path: &Path) -> io::Result<Self> {
        // The system says where links go round.
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

/// Where links lead, whether there is something or not. The name of an open file of a process is not followed: it leads
/// to that file even if the file has another name now, or none. Then its number is given too, or `u32::MAX` where it
/// is of another process.
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

/// The number of the open file that `path` is the name of, as in `/proc/self/fd/1` or `/dev/fd/1`.
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

/// Whether this is the file or the pipe that the standard output is. What is written twice into a device, such as the null
/// device, is not mixed up.
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

/// Writes `mesh` to a file; the extension names its format, and if `.gz` follows it is gzip'd. The file appears, or
/// changes, at once when all is written: a failure leaves what was there before. Links are followed. Owner, group and mode
/// of a file that was there are kept; what could not be kept of it is given back, a sentence each. A device, a FIFO or
/// another name of the standard output is written into.
///
/// # Errors
/// [`Error::UnknownFormat`] or [`Error::Io`].
pub fn write(path: impl AsRef<Path>, mesh: &Mesh) -> Result<Vec<String>, Error> {
    let output = Output::of(&path, &path)?;
    output.stage_with(mesh_writer(&output.name, mesh)?)?.commit()
}

/// As [`write()`], what was read with other triangles; see [`Loaded::file_bytes`].
///
/// # Errors
/// As there.
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
