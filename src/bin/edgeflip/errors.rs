//! Writes the program's own lines to standard error, even after standard error is closed to other code.

use std::fs::File;
use std::io::{self, Write};
use std::sync::OnceLock;

/// The original standard error, after [`only_ours`] has closed it to other code.
static OWN: OnceLock<File> = OnceLock::new();

/// Writes to standard error. If that fails, the exit status is the only message.
pub fn say(text: &[u8]) {
    let _ = match OWN.get() {
        Some(mut file) => file.write_all(text),
        None => raw(text),
    };
}

/// Bypasses the lock of Rust's standard error: a thread that waits for the end of the process may hold it.
#[cfg(unix)]
fn raw(mut text: &[u8]) -> io::Result<()> {
    while !text.is_empty() {
        let written = rustix::io::write(io::stderr(), text)?;
        text = &text[written..];
    }
    Ok(())
}

#[cfg(not(unix))]
fn raw(text: &[u8]) -> io::Result<()> {
    io::stderr().write_all(text)
}

/// Discards what other code in the process, such as a GPU driver, writes to standard error from now on.
#[cfg(unix)]
pub fn only_ours() {
    let Ok(own) = rustix::io::fcntl_dupfd_cloexec(io::stderr(), 3) else { return };
    let Ok(null) = File::options().write(true).open("/dev/null") else { return };
    if OWN.set(own.into()).is_ok() && rustix::stdio::dup2_stderr(null).is_ok() {
        std::panic::set_hook(Box::new(|panic| say(format!("edgeflip: {panic}\n").as_bytes())));
    }
}

/// No driver is known to write to standard error on other systems.
#[cfg(not(unix))]
pub fn only_ours() {}
