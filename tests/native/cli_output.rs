//! The output of the command line: it writes into devices and pipes, follows links, and replaces files, which keep
//! their owner and mode, or a note says why not.
#![cfg(all(unix, feature = "cli"))]

use crate::command::{FLIPPED, Folder, SQUARE, command, failed, grid, run, shell, silent, text};
use edgeflip::io;
use std::fs;
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, chown};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::Duration;

const QUIET: &[&str] = &["--quiet"];

#[test]
fn the_standard_output_is_written_into_by_any_name() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE);
    let link = folder.link("link.off", "/dev/stdout");
    let again = folder.link("again", &link);
    for output in ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"]
        .map(Path::new)
        .into_iter()
        .chain([&*link, &*again])
    {
        if output.starts_with("/proc") && !output.exists() {
            continue;
        }
        let ran = run(&input, output, QUIET);
        assert_eq!((ran.status.code(), text(&ran.stdout), text(&ran.stderr)), (Some(0), FLIPPED, ""));
        let line =
            format!("{}: --json also writes to the standard output; give another OUT", output.display());
        failed(&run(&input, output, &["--json"]), 2, &line);
    }
    assert!(link.is_symlink() && again.is_symlink());
    assert_eq!(folder.names(), ["again", "in.off", "link.off"]);
}

#[test]
fn a_file_that_is_the_standard_output_goes_on() {
    let folder = Folder::new();
    let (input, out) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    folder.link("link", "/dev/fd/1");
    for output in ["/dev/stdout", "-", "out.off", "link"] {
        fs::write(&out, "head\n").unwrap();
        let before = out.metadata().unwrap().ino();
        let script = format!(
            r#"cd "$1" && "$0" in.off -o {output} --backend cpu -q >>out.off && echo tail >>out.off"#
        );
        silent(&shell(&script, &[input.parent().unwrap()]).output().unwrap());
        assert_eq!(fs::read_to_string(&out).unwrap(), format!("head\n{FLIPPED}tail\n"), "{output}");
        assert_eq!(out.metadata().unwrap().ino(), before);
    }
    assert_eq!(folder.names(), ["in.off", "link", "out.off"]);
}

#[test]
fn a_device_stays_one() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE);
    let link = folder.link("null.off", "/dev/null");
    for output in [&*link, Path::new("/dev/null")] {
        silent(&run(&input, output, QUIET));
        // Two writers to the null device do no harm.
        let ran = command(&input, output, &["--quiet", "--json"]).stdout(Stdio::null()).output().unwrap();
        silent(&ran);
    }
    assert!(link.is_symlink() && Path::new("/dev/null").metadata().unwrap().file_type().is_char_device());
    // Mostly only root may create a device. For other users this part does nothing.
    let node = folder.path("node.off");
    let made = Command::new("mknod").arg(&node).args(["c", "1", "3"]).output().unwrap();
    if made.status.success() {
        silent(&run(&input, &node, QUIET));
        assert!(node.metadata().unwrap().file_type().is_char_device());
        fs::remove_file(&node).unwrap();
    }
    assert_eq!(folder.names(), ["in.off", "null.off"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_one_line() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE);
    let line = "/dev/full: No space left on device (os error 28)";
    failed(&run(&input, Path::new("/dev/full"), &[]), 1, line);
}

/// The program prints the object before it renames the file.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_leaves_the_file_as_it_was() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE);
    for output in [folder.file("old.off", "old"), folder.path("new.off")] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let ran = command(&input, &output, &["--json"]).stdout(full).output().unwrap();
        failed(&ran, 1, "standard output: No space left on device (os error 28)");
    }
    assert_eq!(folder.names(), ["in.off", "old.off"]);
    assert_eq!(fs::read_to_string(folder.path("old.off")).unwrap(), "old");
}

#[test]
fn a_fifo_gets_all_of_it() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.fifo("out.off"));
    for wait in [0, 500] {
        let path = output.clone();
        let reader = thread::spawn(move || {
            thread::sleep(Duration::from_millis(wait));
            fs::read(path).unwrap()
        });
        silent(&run(&input, &output, QUIET));
        assert_eq!(text(&reader.join().unwrap()), FLIPPED);
    }
    assert!(output.metadata().unwrap().file_type().is_fifo());
    assert_eq!(folder.names(), ["in.off", "out.off"]);
}

#[test]
fn a_fifo_that_nobody_reads_is_not_waited_for_for_ever() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.fifo("out.off"));
    // In debug builds the program waits for 2 s.
    let line = format!("{}: no program has opened this FIFO for reading within 2 s", output.display());
    failed(&run(&input, &output, &[]), 1, &line);
}

#[test]
fn a_reader_that_goes_away_is_one_line() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE);
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let ran = command(&input, Path::new("-"), &[]).stdout(writer).output().unwrap();
    failed(&ran, 1, "standard output: Broken pipe (os error 32)");
    // More bytes than a pipe buffers.
    let (large, output) = (folder.path("large.off"), folder.fifo("out.off"));
    io::write(&large, &grid(60)).unwrap();
    let path = output.clone();
    let reader = thread::spawn(move || drop(fs::File::open(path).unwrap()));
    let line = format!("{}: Broken pipe (os error 32)", output.display());
    failed(&run(&large, &output, &["--max-iterations", "0"]), 1, &line);
    reader.join().unwrap();
    assert!(output.metadata().unwrap().file_type().is_fifo());
}

/// The extension of OUT decides the format, or else the name of IN.
#[test]
fn what_has_no_extension_is_written_as_the_input_is() {
    let folder = Folder::new();
    let square = folder.file("in.off", SQUARE);
    let link = folder.link("out.obj", "/dev/stdout");
    assert!(text(&run(&square, &link, QUIET).stdout).starts_with("v 0 0 0\nv "));
    let packed = folder.path("in.ply.gz");
    silent(&run(&square, &packed, QUIET));
    let expected = fs::read(&packed).unwrap();
    for output in ["-", "/dev/stdout"] {
        let ran = run(&packed, Path::new(output), QUIET);
        assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
        assert!(ran.stdout == expected);
    }
    // A pipe of a shell.
    let ran = shell(r#""$0" "$1" -o >(cat) --backend cpu -q | cat"#, &[&square]).output().unwrap();
    assert_eq!((text(&ran.stdout), text(&ran.stderr)), (FLIPPED, ""));
    let unknown = folder.file("in.mesh", SQUARE);
    let line = format!(
        "{}: unknown format; use one of: .off, .obj, .ply, .stl, .gltf, .glb, .csv, .xyz, also gzip'd (.gz)",
        unknown.display()
    );
    failed(&run(&unknown, Path::new("-"), &[]), 1, &line);
}

#[test]
fn links_are_followed() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE);
    fs::create_dir(folder.path("below")).unwrap();
    let first = folder.link("first.off", "below/second.off");
    let second = folder.link("below/second.off", "../target.off");
    // At first there is no target.
    for _ in 0..2 {
        silent(&run(&input, &first, QUIET));
        assert!(first.is_symlink() && second.is_symlink());
        let target = folder.path("target.off");
        assert!(target.symlink_metadata().unwrap().is_file());
        assert_eq!(fs::read_to_string(target).unwrap(), FLIPPED);
    }
    let nowhere = folder.link("nowhere.off", "none/target.off");
    failed(&run(&input, &nowhere, &[]), 1, &format!("{}: the folder does not exist", nowhere.display()));
    let (round, _) = (folder.link("a.off", "b.off"), folder.link("b.off", "a.off"));
    let ran = run(&input, &round, &[]);
    let said = text(&ran.stderr);
    assert!(
        said.starts_with(&format!("edgeflip: {}: Too many levels of symbolic links", round.display())),
        "{said}"
    );
    assert_eq!((ran.status.code(), said.lines().count()), (Some(1), 1));
    let to_folder = folder.link("folder.off", "below");
    assert_eq!(run(&input, &to_folder, &[]).status.code(), Some(1));
}

#[test]
fn the_mode_and_the_group_stay() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE);
    for mode in [0o600, 0o640, 0o755, 0o444] {
        let output = folder.file("out.off", "old");
        fs::set_permissions(&output, fs::Permissions::from_mode(mode)).unwrap();
        let before = output.metadata().unwrap();
        silent(&run(&input, &output, QUIET));
        let after = output.metadata().unwrap();
        assert_eq!(after.mode(), before.mode());
        assert_eq!((after.uid(), after.gid()), (before.uid(), before.gid()));
        assert_eq!(fs::read_to_string(&output).unwrap(), FLIPPED);
        fs::remove_file(output).unwrap();
    }
}

#[test]
fn other_names_keep_the_old_content() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.file("out.off", "old"));
    for name in ["one.off", "two.off"] {
        fs::hard_link(&output, folder.path(name)).unwrap();
    }
    let ran = run(&input, &output, &["--json"]);
    let note = "its other names (hard links: 2) keep the old content";
    assert_eq!(text(&ran.stderr), format!("note       {}: {note}\n", output.display()));
    assert_eq!(ran.status.code(), Some(0));
    assert_eq!(fs::read_to_string(folder.path("two.off")).unwrap(), "old");
    assert_eq!(fs::read_to_string(output).unwrap(), FLIPPED);
}

/// Only root can give files to other users, so the test does nothing for other users.
#[test]
fn the_owner_stays_or_a_note_says_why_not() {
    const OTHER: u32 = 65_533;
    const NOBODY: u32 = 65_534;
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.file("out.off", "old"));
    if chown(&output, Some(OTHER), Some(NOBODY)).is_err() {
        return;
    }
    let mode = |mode| fs::set_permissions(&output, fs::Permissions::from_mode(mode)).unwrap();
    let found = || {
        let found = output.metadata().unwrap();
        (found.uid(), found.gid(), found.mode() & 0o7777)
    };
    mode(0o4750);
    silent(&run(&input, &output, QUIET));
    assert_eq!(found(), (OTHER, NOBODY, 0o4750));
    // Another user, who may write into the folder but not change the owner of files.
    fs::set_permissions(input.parent().unwrap(), fs::Permissions::from_mode(0o777)).unwrap();
    let as_nobody =
        |command: &mut Command| -> Option<Output> { command.uid(NOBODY).gid(NOBODY).output().ok() };
    if as_nobody(Command::new(env!("CARGO_BIN_EXE_edgeflip")).arg("--version")).is_none() {
        // The folder of the program is not accessible to that user.
        return;
    }
    let ran = as_nobody(&mut command(&input, &output, &["--json"])).unwrap();
    let said = text(&ran.stderr);
    let note = format!("note       {}: its owner changed from {OTHER} to {NOBODY} (", output.display());
    assert!(said.starts_with(&note) && said.lines().count() == 1, "{said}");
    assert_eq!(ran.status.code(), Some(0));
    assert_eq!(found(), (NOBODY, NOBODY, 0o750));
}
