//! Files that another process has to open too, FIFOs: they are opened without blocking, and waited for so long only.

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::io::Errno;
use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

/// How long a FIFO waits for its other end. Without optimisation it is not long, so that tests wait too.
const PATIENCE: Duration = Duration::from_secs(if cfg!(debug_assertions) { 2 } else { 10 });

/// How long it sleeps before it looks again.
const PAUSE: Duration = Duration::from_millis(10);

/// A file to be read, and what has been read of it already.
///
/// # Errors
/// [`io::ErrorKind::TimedOut`] for a FIFO that nobody writes into; those of the system.
pub(super) fn open_to_read(path: &Path) -> io::Result<(Vec<u8>, File)> {
    let mut file = without_blocking(File::options().read(true), path)?;
    let mut first = Vec::new();
    if file.metadata()?.file_type().is_fifo() {
        let found = patiently(|| {
            if has_been_left(&file) {
                return Some(Ok(first.clone()));
            }
            let mut byte = [0];
            match file.read(&mut byte) {
                // Nobody has it open.
                Ok(0) => None,
                Ok(_) => Some(Ok(byte.to_vec())),
                // Somebody has, and has written nothing yet.
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => Some(Ok(Vec::new())),
                Err(error) => Some(Err(error)),
            }
        });
        first = found.unwrap_or_else(|| Err(late("no program has opened this FIFO to write into it")))?;
    }
    block(&file)?;
    Ok((first, file))
}

/// A file to be written into that is there and no regular one.
///
/// # Errors
/// [`io::ErrorKind::TimedOut`] for a FIFO that nobody reads; those of the system.
pub(super) fn open_to_write(path: &Path) -> io::Result<File> {
    let found = patiently(|| match without_blocking(File::options().write(true).truncate(true), path) {
        Err(error) if error.raw_os_error() == Some(Errno::NXIO.raw_os_error()) && is_fifo(path) => None,
        opened => Some(opened),
    });
    let file = found.unwrap_or_else(|| Err(late("no program has opened this FIFO to read it")))?;
    block(&file)?;
    Ok(file)
}

fn is_fifo(path: &Path) -> bool {
    path.metadata().is_ok_and(|metadata| metadata.file_type().is_fifo())
}

/// What `look` finds before the patience ends.
fn patiently<T>(mut look: impl FnMut() -> Option<T>) -> Option<T> {
    let start = Instant::now();
    loop {
        let found = look();
        if found.is_some() || start.elapsed() > PATIENCE {
            return found;
        }
        thread::sleep(PAUSE);
    }
}

fn late(what: &str) -> io::Error {
    io::Error::new(io::ErrorKind::TimedOut, format!("{what} within {} s", PATIENCE.as_secs()))
}

/// Whether those who had a pipe open to write have closed it, perhaps with something in it. Elsewhere than on Linux a FIFO
/// that nobody has opened yet may look the same.
fn has_been_left(file: &File) -> bool {
    let mut polled = [PollFd::new(file, PollFlags::IN)];
    let at_once = Timespec { tv_sec: 0, tv_nsec: 0 };
    cfg!(target_os = "linux")
        && poll(&mut polled, Some(&at_once)).is_ok()
        && polled[0].revents().contains(PollFlags::HUP)
}

fn without_blocking(options: &mut OpenOptions, path: &Path) -> io::Result<File> {
    options.custom_flags((OFlags::NONBLOCK | OFlags::NOCTTY).bits() as i32).open(path)
}

/// From now on what it is asked for waits.
fn block(file: &File) -> io::Result<()> {
    Ok(fcntl_setfl(file, fcntl_getfl(file)? - OFlags::NONBLOCK)?)
}
