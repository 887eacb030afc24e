//! Wrong usage, the ends of ranges, and standard streams that close.

use crate::command::{Folder, SQUARE, run, text};
use std::fs;
use std::process::{Command, Stdio};

#[test]
fn wrong_usage_is_2() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    for arguments in [
        &["--max-normal-angle", "nan"][..],
        &["--max-normal-angle", "-1"],
        &["--max-normal-angle", "180.5"],
        &["--max-normal-angle", "inf"],
        &["--max-normal-angle", "ten"],
        &["--max-deviation", "-1e-9"],
        &["--max-deviation", "nan"],
        &["--max-iterations", "-1"],
        &["--threads", "0"],
        &["--threads", "-1"],
        &["--threads", "257"],
        &["--threads", "16000"],
        &["--max-iterations", "4294967296"],
        &["--backend", "tpu"],
        &["--dimension", "4"],
        &["--order", "random"],
        &["--frobnicate"],
        &["second.off"],
    ] {
        let ran = run(&input, &output, arguments);
        assert_eq!((ran.status.code(), text(&ran.stdout)), (Some(2), ""), "{arguments:?}");
        assert!(!ran.stderr.is_empty());
    }
    let bare = Command::new(env!("CARGO_BIN_EXE_edgeflip")).arg(&input).output().unwrap();
    assert_eq!(bare.status.code(), Some(2));
    assert_eq!(folder.names(), ["in.off"]);
}

/// Without a Vulkan driver there is no GPU. A backend that the user names is never replaced.
#[cfg(target_os = "linux")]
#[test]
fn an_unavailable_backend_is_3() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    let ran = Command::new(env!("CARGO_BIN_EXE_edgeflip"))
        .args([input.as_os_str(), "-o".as_ref(), output.as_os_str()])
        .args(["--backend", "gpu"])
        .envs([("VK_DRIVER_FILES", "/dev/null"), ("VK_ICD_FILENAMES", "/dev/null")])
        .output()
        .unwrap();
    assert_eq!((ran.status.code(), text(&ran.stdout)), (Some(3), ""));
    assert!(text(&ran.stderr).starts_with("edgeflip: backend gpu is not available: "));
    assert_eq!(text(&ran.stderr).lines().count(), 1);
    assert_eq!(folder.names(), ["in.off"]);
}

#[test]
fn the_ends_of_the_options_ranges_are_taken() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    for arguments in [
        &["--max-normal-angle", "0"][..],
        &["--max-normal-angle", "180"],
        &["--max-deviation", "0"],
        &["--max-deviation", "inf"],
        &["--max-iterations", "0"],
        &["--max-iterations", "4294967295"],
        &["--threads", "1"],
        &["--threads", "3", "--backend", "cpu"],
        &["--threads", "256", "--backend", "cpu"],
        &["--order", "any"],
        &["--order", "reproducible"],
        &["--backend", "auto"],
    ] {
        assert_eq!(run(&input, &output, arguments).status.code(), Some(0), "{arguments:?}");
    }
}

#[test]
fn help_explains() {
    let ran = Command::new(env!("CARGO_BIN_EXE_edgeflip")).arg("--help").output().unwrap();
    assert_eq!(ran.status.code(), Some(0));
    for words in [
        "β",
        "Lawson",
        "or an error (status 3)",
        "Exit status",
        ".obj",
        ".ply",
        ".stl",
        ".gz",
        "--max-bytes",
        "Examples",
    ] {
        assert!(text(&ran.stdout).contains(words), "{words}");
    }
}

/// If the reader of standard output or standard error goes away, the program neither panics nor fails.
#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_panic() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    for arguments in ["--json", "--verify"] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_edgeflip"))
            .arg(&input)
            .arg("-o")
            .arg(&output)
            .args(["--backend", "cpu", arguments])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().unwrap().code(), Some(0));
        assert!(fs::read(&output).unwrap().starts_with(b"OFF\n4 2 0\n"));
    }
}
