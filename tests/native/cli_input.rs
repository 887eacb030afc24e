//! The input of the command line: waits for pipes only a limited time, and reads other files of a glTF file in its
//! folder only.
#![cfg(all(unix, feature = "cli"))]

use crate::command::{FLIPPED, Folder, SQUARE, command, failed, run, shell, silent, text};
use serde_json::json;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::thread;
use std::time::Duration;

const QUIET: &[&str] = &["--quiet"];

/// In debug builds the program waits for 2 s.
const LATE: &str = "no program has opened this FIFO for writing within 2 s";

#[test]
fn a_fifo_that_nobody_writes_into_is_not_waited_for_for_ever() {
    let folder = Folder::new();
    let (square, fifo) = (folder.file("in.off", SQUARE), folder.fifo("fifo.off"));
    let output = folder.path("out.off");
    let line = format!("{}: {LATE}", fifo.display());
    failed(&run(&fifo, &output, &[]), 1, &line);
    for option in ["--lock-edges", "--lock-triangles", "--groups", "--constraints"] {
        failed(&run(&square, &output, &[option, fifo.to_str().unwrap()]), 1, &line);
    }
    assert_eq!(folder.names(), ["fifo.off", "in.off"]);
}

/// A writer that opens the FIFO late, and writes late.
#[test]
fn a_writer_is_waited_for() {
    let folder = Folder::new();
    let (fifo, output) = (folder.fifo("fifo.off"), folder.path("out.off"));
    for [opens, writes] in [[0, 0], [500, 0], [0, 3000]] {
        let path = fifo.clone();
        let writer = thread::spawn(move || {
            thread::sleep(Duration::from_millis(opens));
            let mut file = fs::File::options().write(true).open(path).unwrap();
            thread::sleep(Duration::from_millis(writes));
            file.write_all(SQUARE.as_bytes()).unwrap();
        });
        silent(&run(&fifo, &output, QUIET));
        writer.join().unwrap();
        assert_eq!(fs::read_to_string(&output).unwrap(), FLIPPED);
    }
}

#[test]
fn a_writer_may_leave_without_a_byte() {
    let folder = Folder::new();
    let (fifo, output) = (folder.fifo("fifo.off"), folder.path("out.off"));
    let path = fifo.clone();
    let writer = thread::spawn(move || drop(fs::File::options().write(true).open(path).unwrap()));
    let ran = run(&fifo, &output, &[]);
    writer.join().unwrap();
    let said = text(&ran.stderr);
    let lines =
        [LATE, "line 1: the file is empty"].map(|line| format!("edgeflip: {}: {line}\n", fifo.display()));
    assert!(lines.iter().any(|line| line == said), "{said}");
}

#[test]
fn pipes_of_a_shell_are_read() {
    let folder = Folder::new();
    let (square, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    let locked = r#""$0" "$1" -o "$2" --backend cpu -q --lock-edges <(sleep 0.2; echo 0 2)"#;
    silent(&shell(locked, &[&square, &output]).output().unwrap());
    assert_eq!(fs::read_to_string(&output).unwrap(), SQUARE);
    let nothing = r#""$0" "$1" -o "$2" --backend cpu -q --lock-edges <(true)"#;
    silent(&shell(nothing, &[&square, &output]).output().unwrap());
    assert_eq!(fs::read_to_string(&output).unwrap(), FLIPPED);
    let link = folder.link("stdin.off", "/dev/stdin");
    let mut child = command(&link, &output, QUIET).stdin(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(SQUARE.as_bytes()).unwrap();
    assert!(child.wait().unwrap().success());
}

/// A triangle whose buffer of 36 bytes is in the file `name`.
fn gltf(folder: &Folder, name: &str) -> PathBuf {
    let json = json!({
        "asset": { "version": "2.0" },
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "uri": name, "byteLength": 36 }],
    });
    folder.file("a/in.gltf", json.to_string())
}

#[test]
fn only_regular_files_in_the_folder_are_read() {
    let folder = Folder::new();
    fs::create_dir_all(folder.path("a/below")).unwrap();
    let bytes: Vec<u8> =
        [0f32, 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|x| x.to_le_bytes()).collect();
    folder.file("outside.bin", &bytes);
    folder.file("a/below/inside.bin", &bytes);
    folder.link("a/inside", "below/inside.bin");
    folder.link("a/below/outside", "../../outside.bin");
    folder.link("a/up", "..");
    folder.link("a/zero", "/dev/zero");
    folder.link("a/gone", "none");
    folder.fifo("a/fifo");
    let output = folder.path("out.off");
    for name in ["below/inside.bin", "inside"] {
        silent(&run(&gltf(&folder, name), &output, &["--external-files", "-q"]));
    }
    let leads_out = "a link leads out of the folder of IN; only files in this folder are read";
    for (name, why) in [
        ("below/outside", leads_out),
        ("up/outside.bin", leads_out),
        ("zero", leads_out),
        ("fifo", "it is not a regular file"),
        ("below", "it is not a regular file"),
        ("gone", "No such file or directory (os error 2)"),
    ] {
        let input = gltf(&folder, name);
        let line = format!("{}: buffer 0: it is in the file `{name}`: {why}", input.display());
        failed(&run(&input, &output, &["--external-files"]), 1, &line);
    }
    // The folder itself may be reached by a link.
    let link = folder.link("link", "a");
    gltf(&folder, "inside");
    silent(&run(&link.join("in.gltf"), &output, &["--external-files", "-q"]));
}

#[test]
fn a_file_beside_another_is_as_large_as_it_may_be() {
    let folder = Folder::new();
    fs::create_dir(folder.path("a")).unwrap();
    folder.file("a/large.bin", vec![0; 5000]);
    let input = gltf(&folder, "large.bin");
    let why = "it has more than 1000 bytes; --max-bytes sets the limit";
    let line = format!("{}: buffer 0: it is in the file `large.bin`: {why}", input.display());
    let arguments = &["--external-files", "--max-bytes", "1000"];
    failed(&run(&input, &folder.path("out.off"), arguments), 1, &line);
    assert!(!Path::new(&folder.path("out.off")).exists());
}
