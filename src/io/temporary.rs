//! Temporary files, in the folder of the file that they replace. They are removed even if a program ends without
//! destructors.

use std::fs::File;
use std::io;
use std::mem;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::thread;
use std::time::Duration;

/// A path in the form that the system takes without an allocation.
#[cfg(unix)]
type Stored = std::ffi::CString;
#[cfg(not(unix))]
type Stored = std::path::PathBuf;

/// The existing temporary files. Files are created, renamed and removed under this lock.
static PATHS: Mutex<Vec<Stored>> = Mutex::new(Vec::new());

/// How often [`remove_temporary_files`] tries to take the lock, and the pause between two tries.
const TRIES: u32 = 1000;
const PAUSE: Duration = Duration::from_millis(1);

/// Removes the temporary files of all unfinished writes. A program calls it last, when a signal or a lack of memory
/// ends it. It does not allocate. A thread that writes a file afterwards waits for ever.
pub fn remove_temporary_files() {
    for _ in 0..TRIES {
        let paths = match PATHS.try_lock() {
            Ok(paths) => paths,
            Err(TryLockError::Poisoned(error)) => error.into_inner(),
            Err(TryLockError::WouldBlock) => {
                thread::sleep(PAUSE);
                continue;
            }
        };
        for path in paths.iter() {
            let _ = remove(path);
        }
        // Keeps the lock, so that no file is created or renamed any more.
        mem::forget(paths);
        return;
    }
}

/// A temporary file. It is removed on drop.
pub(super) struct Temporary {
    file: File,
    path: Stored,
    exists: bool,
}

impl Temporary {
    /// A new file in `folder`. If it replaces a file, only its owner may read it, since the old file may be private. If
    /// not, it has the permissions of a new file.
    pub(super) fn new_in(folder: &Path, replaces: bool) -> io::Result<Self> {
        let mut options = File::options();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, if replaces { 0o600 } else { 0o666 });
        #[cfg(not(unix))]
        let _ = replaces;
        let made = |path: &Path| {
            let path = stored(path)?;
            let listed = path.clone();
            let mut paths = paths();
            // After the file exists, nothing may fail before it is in the list.
            paths.reserve(1);
            let file = options.open(as_path(&path))?;
            paths.push(listed);
            Ok(Self { file, path, exists: true })
        };
        let mut names = tempfile::Builder::new();
        names.prefix(".edgeflip-").suffix(".tmp").disable_cleanup(true);
        Ok(names.make_in(folder, made)?.into_parts().0)
    }

    pub(super) fn file(&self) -> &File {
        &self.file
    }

    /// Renames the file to `target`, and replaces any file there.
    pub(super) fn rename(mut self, target: &Path) -> io::Result<()> {
        let target = stored(target)?;
        let paths = paths();
        rename(&self.path, &target)?;
        self.leave(paths);
        Ok(())
    }

    /// Removes the file from the list.
    fn leave(&mut self, mut paths: MutexGuard<'_, Vec<Stored>>) {
        paths.retain(|path| *path != self.path);
        self.exists = false;
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if self.exists {
            let paths = paths();
            let _ = remove(&self.path);
            self.leave(paths);
        }
    }
}

fn paths() -> MutexGuard<'static, Vec<Stored>> {
    PATHS.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(unix)]
fn stored(path: &Path) -> io::Result<Stored> {
    use std::os::unix::ffi::OsStrExt;
    Ok(Stored::new(path.as_os_str().as_bytes())?)
}

#[cfg(unix)]
fn as_path(path: &Stored) -> &Path {
    use std::os::unix::ffi::OsStrExt;
    Path::new(std::ffi::OsStr::from_bytes(path.as_bytes()))
}

#[cfg(unix)]
fn remove(path: &Stored) -> io::Result<()> {
    Ok(rustix::fs::unlink(path.as_c_str())?)
}

#[cfg(unix)]
fn rename(path: &Stored, target: &Stored) -> io::Result<()> {
    Ok(rustix::fs::rename(path.as_c_str(), target.as_c_str())?)
}

#[cfg(not(unix))]
fn stored(path: &Path) -> io::Result<Stored> {
    Ok(path.to_path_buf())
}

#[cfg(not(unix))]
fn as_path(path: &Stored) -> &Path {
    path
}

#[cfg(not(unix))]
fn remove(path: &Stored) -> io::Result<()> {
    std::fs::remove_file(path)
}

#[cfg(not(unix))]
fn rename(path: &Stored, target: &Stored) -> io::Result<()> {
    std::fs::rename(path, target)
}
