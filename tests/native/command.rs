//! The command-line program for tests: its runs, and folders of their files.
#![cfg(feature = "cli")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// A square with corner 1 moved inwards, cut along 0-2. The angles at 1 and 3 are 106° and 90°, so 1-3 is Delaunay.
///
/// ```text
///   3-----2
///   |   //
///   | /  1
///   0 -'
/// ```
pub const SQUARE: &str = "OFF\n4 2 0\n0 0 0\n0.9 0.2 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

/// The output of the program for [`SQUARE`].
pub const FLIPPED: &str = "OFF\n4 2 0\n0 0 0\n0.9 0.2 0\n1 1 0\n0 1 0\n3 3 1 2\n3 0 1 3\n";

/// A folder that is removed with its contents.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, bytes).unwrap();
        path
    }

    #[cfg(unix)]
    pub fn fifo(&self, name: &str) -> PathBuf {
        let path = self.path(name);
        assert!(Command::new("mkfifo").arg(&path).status().unwrap().success());
        path
    }

    #[cfg(unix)]
    pub fn link(&self, name: &str, to: impl AsRef<Path>) -> PathBuf {
        let path = self.path(name);
        std::os::unix::fs::symlink(to, &path).unwrap();
        path
    }

    /// The sorted names of its contents.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

/// A command that runs the program, on the CPU unless `arguments` name a backend.
pub fn command(input: &Path, output: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_edgeflip"));
    command.arg(input).arg("-o").arg(output);
    if !arguments.contains(&"--backend") {
        command.args(["--backend", "cpu"]);
    }
    command.args(arguments).stdin(Stdio::null());
    command
}

/// Runs the program as [`command`] says.
pub fn run(input: &Path, output: &Path, arguments: &[&str]) -> Output {
    command(input, output, arguments).output().unwrap()
}

/// A command of a shell, in which `"$0"` is the program and `"$@"` are `arguments`.
#[cfg(unix)]
pub fn shell(script: &str, arguments: &[&Path]) -> Command {
    let mut command = Command::new("bash");
    command.arg("-c").arg(script).arg(env!("CARGO_BIN_EXE_edgeflip")).args(arguments).stdin(Stdio::null());
    command
}

pub fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// Asserts that the run ended with `status`, with one line on standard error, and nothing on standard output.
#[track_caller]
pub fn failed(output: &Output, status: i32, line: &str) {
    assert_eq!(text(&output.stderr), format!("edgeflip: {line}\n"));
    assert_eq!(output.status.code(), Some(status));
    assert!(output.stdout.is_empty());
}

/// Asserts that the run succeeded and printed nothing.
#[track_caller]
pub fn silent(output: &Output) {
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""));
    assert!(output.stdout.is_empty());
}

/// A mesh in the plane, a grid with random diagonals.
pub fn grid(n: usize) -> edgeflip::Mesh {
    edgeflip::families::by_name(&format!("grid {n}")).unwrap()
}
