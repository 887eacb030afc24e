//! Opens files. For a FIFO, waits a limited time until another process opens it too.

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::io::Errno;
use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

/// How long to wait for the other end of a FIFO. Shorter in debug builds, so that tests can wait.
const PATIENCE: Duration = Duration::from_secs(if cfg!(debug_assertions) { 2 } else { 10 });

/// The pause between two tries.
const PAUSE: Duration = Duration::from_millis(10);

/// Opens a file for reading. Returns bytes that were already read, and the file.
///
/// # Errors
/// [`io::ErrorKind::TimedOut`] for a FIFO that no process opens for writing; those of the system.
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
                // No process has it open for writing.
                Ok(0) => None,
                Ok(_) => Some(Ok(byte.to_vec())),
                // A process has it open, and has written nothing yet.
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => Some(Ok(Vec::new())),
                Err(error) => Some(Err(error)),
            }
        });
        first = found.unwrap_or_else(|| Err(late("no program has opened this FIFO for writing")))?;
    }
    block(&file)?;
    Ok((first, file))
}

/// Opens an existing file that is not regular, for writing.
///
/// # Errors
/// [`io::ErrorKind::TimedOut`] for a FIFO that no process opens for reading; those of the system.
pub(super) fn open_to_write(path: &Path) -> io::Result<File> {
    let found = patiently(|| match without_blocking(File::options().write(true).truncate(true), path) {
        Err(error) if error.raw_os_error() == Some(Errno::NXIO.raw_os_error()) && is_fifo(path) => None,
        opened => Some(opened),
    });
    let file = found.unwrap_or_else(|| Err(late("no program has opened this FIFO for reading")))?;
    block(&file)?;
    Ok(file)
}

fn is_fifo(path: &Path) -> bool {
    path.metadata().is_ok_and(|metadata| metadata.file_type().is_fifo())
}

/// The first result of `look`, tried until [`PATIENCE`] ends.
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

/// Whether all writers have closed the FIFO, which may still have bytes in it. Only on Linux: on other systems, a FIFO
/// that no process has opened yet may look the same.
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

/// Makes reads and writes block again.
fn block(file: &File) -> io::Result<()> {
    Ok(fcntl_setfl(file, fcntl_getfl(file)? - OFlags::NONBLOCK)?)
}
