//! A signal ends the command line at once, by that signal, and without temporary files.
#![cfg(all(unix, feature = "cli"))]

use crate::command::{Folder, failed, grid, shell, text};
use edgeflip::io;
use rustix::process::{Pid, Signal, kill_process};
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// A mesh that takes a while to compress.
fn large(folder: &Folder) -> PathBuf {
    let path = folder.path("in.ply");
    io::write(&path, &grid(500)).unwrap();
    path
}

/// Sends the signal when a temporary file exists, and returns how the program ends.
fn interrupted(folder: &Folder, mut child: Child, signal: Signal) -> ExitStatus {
    let start = Instant::now();
    while !folder.names().iter().any(|name| name.starts_with(".edgeflip-")) {
        assert!(start.elapsed() < Duration::from_secs(60) && child.try_wait().unwrap().is_none());
        thread::sleep(Duration::from_millis(1));
    }
    kill_process(Pid::from_child(&child), signal).unwrap();
    child.wait().unwrap()
}

/// The program, which compresses the mesh. The shell runs `first` before it.
fn packing(folder: &Folder, first: &str, arguments: [&Path; 2]) -> Child {
    let script = format!(r#"{first}; exec "$0" "$1" -o "$2" --backend cpu --max-iterations 0 -q"#);
    let mut command = shell(&script, &arguments);
    command.current_dir(folder.path(".")).stdout(Stdio::null()).spawn().unwrap()
}

#[test]
fn no_temporary_file_stays() {
    let folder = Folder::new();
    let (input, output) = (large(&folder), folder.file("out.ply.gz", "old"));
    for signal in [Signal::INT, Signal::TERM, Signal::QUIT, Signal::HUP] {
        let child = packing(&folder, "ulimit -c 0", [&input, &output]);
        let status = interrupted(&folder, child, signal);
        assert_eq!(status.signal(), Some(signal.as_raw()), "{status}");
        assert_eq!(folder.names(), ["in.ply", "out.ply.gz"]);
        assert_eq!(fs::read_to_string(&output).unwrap(), "old");
    }
}

/// As under nohup.
#[test]
fn an_ignored_signal_stays_ignored() {
    let folder = Folder::new();
    let (input, output) = (large(&folder), folder.path("out.ply.gz"));
    let child = packing(&folder, "trap '' HUP", [&input, &output]);
    assert_eq!(interrupted(&folder, child, Signal::HUP).code(), Some(0));
    assert_eq!(folder.names(), ["in.ply", "out.ply.gz"]);
}

#[test]
fn a_file_that_becomes_too_large_is_an_error() {
    let folder = Folder::new();
    let (input, output) = (folder.path("in.ply"), folder.file("out.ply", "old"));
    io::write(&input, &grid(60)).unwrap();
    let script = r#"ulimit -c 0; ulimit -f 1; exec "$0" "$1" -o "$2" --backend cpu"#;
    let ran = shell(script, &[&input, &output]).output().unwrap();
    let line = text(&ran.stderr).trim_start_matches("edgeflip: ").trim_end();
    assert!(line.starts_with(&format!("{}: ", output.display())), "{line}");
    failed(&ran, 1, line);
    assert_eq!(folder.names(), ["in.ply", "out.ply"]);
    assert_eq!(fs::read_to_string(&output).unwrap(), "old");
}
