//! Standard error as the program's own lines go there, also where nothing else may.

use std::fs::File;
use std::io::{self, Write};
use std::sync::OnceLock;

/// Where lines go once [`only_ours`] has closed standard error to all others.
static OWN: OnceLock<File> = OnceLock::new();

/// Writes to standard error. If that is closed, only the exit status is left to say something.
pub fn say(text: &[u8]) {
    let _ = match OWN.get() {
        Some(mut file) => file.write_all(text),
        None => raw(text),
    };
}

/// Past the lock of Rust's standard error: a thread that waits for the end may have it.
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

/// What others in the process write to standard error from now on, such as drivers of a GPU, goes nowhere.
#[cfg(unix)]
pub fn only_ours() {
    let Ok(own) = rustix::io::fcntl_dupfd_cloexec(io::stderr(), 3) else { return };
    let Ok(null) = File::options().write(true).open("/dev/null") else { return };
    if OWN.set(own.into()).is_ok() && rustix::stdio::dup2_stderr(null).is_ok() {
        std::panic::set_hook(Box::new(|panic| say(format!("edgeflip: {panic}\n").as_bytes())));
    }
}

/// Drivers elsewhere write nothing there that is known.
#[cfg(not(unix))]
pub fn only_ours() {}
