//! Locked edges and triangles, borders of groups, and attributes.

use crate::command::{Folder, SQUARE, failed, run, text};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

#[test]
fn locked_edges_stay() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    let list = folder.file("list.txt", "# the diagonal\n2 0 # twice\n\n0 2\n");
    let locking =
        |more: &[&str]| run(&input, &output, &[&["--lock-edges", list.to_str().unwrap()], more].concat());
    let ran = locking(&["--json", "--verify"]);
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!((&found["flips"], &found["status"]), (&0.into(), &"done".into()));
    assert_eq!(found["remaining"], json!({ "locked": 1 }));
    assert_eq!(found["remaining_edges"], json!({ "locked": [[0, 2]] }));
    assert_eq!(found["audit"], json!([]));
    fs::remove_file(&output).unwrap();
    for (text, status, line) in [
        ("0 2\n1 3\n", 1, "LIST: the mesh has no edge between vertices 1 and 3"),
        ("0 9\n", 1, "LIST: the mesh has no edge between vertices 0 and 9"),
        ("0 1\n2\n", 1, "LIST: line 2: expected 2 vertex indices with a space between, found 1"),
        ("0 1 2\n", 1, "LIST: line 1: expected 2 vertex indices with a space between, found 3"),
        ("0 -1\n", 1, "LIST: line 1: expected a vertex index, found `-1`"),
        ("0 4294967296\n", 1, "LIST: line 1: expected a vertex index, found `4294967296`"),
        ("zero one\n", 1, "LIST: line 1: expected a vertex index, found `zero`"),
    ] {
        fs::write(&list, text).unwrap();
        failed(&locking(&[]), status, &line.replace("LIST", list.to_str().unwrap()));
    }
    // A list has a limit, which depends on the mesh.
    fs::write(&list, "# 4567\n".repeat(150_000)).unwrap();
    let why =
        "the list has more than 1049088 bytes, too many for 2 triangles; remove repeated lines and comments";
    failed(&locking(&[]), 1, &format!("{}: {why}", list.display()));
    assert_eq!(folder.names(), ["in.off", "list.txt"]);
}

/// The square with its corner 3 raised: its diagonals are 0.0410 apart.
#[test]
fn a_flip_moves_no_more_than_it_may() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE.replace("0 1 0", "0 1 0.1"));
    for (most, remaining) in [("0.041", json!({ "deviation": 1 })), ("0.0411", json!({}))] {
        let arguments = ["--max-deviation", most, "--max-normal-angle", "90", "--verify", "--json"];
        let ran = run(&input, &folder.path("out.off"), &arguments);
        assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
        let said: Value = serde_json::from_str(text(&ran.stdout)).unwrap();
        assert_eq!(said["remaining"], remaining, "{most}");
    }
}

/// The square as two faces of different materials, and with texture coordinates.
#[test]
fn attributes_stay_unless_they_are_dropped() {
    let folder = Folder::new();
    let points = "# by hand\nv 0 0 0\nv 0.9 0.2 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    let faces = ["usemtl a\nf 1/1 2/2 3/3\n", "f 1/1 3/3 4/4\n"];
    let whole = folder.file("whole.obj", points.to_owned() + &faces.concat());
    let parted = format!("{points}{}usemtl b\n{}", faces[0], faces[1]);
    let [parted_path, output] = [folder.file("parted.obj", &parted), folder.path("out.obj")];
    let said = |input: &Path, more: &[&str]| {
        let ran = run(input, &output, &[&["--verify"], more].concat());
        assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
        (text(&ran.stderr).to_owned(), fs::read_to_string(&output).unwrap())
    };
    let locked = "\nlocked     1 edges stay to keep the attribute `usemtl`; --ignore-attribute usemtl lets them flip\n";

    let (summary, written) = said(&whole, &[]);
    assert!(!summary.contains("locked") && !summary.contains("not kept"), "{summary}");
    assert_eq!(written, format!("{points}usemtl a\nf 4/4 2/2 3/3\nf 1/1 2/2 4/4\n"));
    let (summary, written) = said(&parted_path, &[]);
    assert!(summary.contains(locked) && summary.contains("not Delaunay: locked 1\n"), "{summary}");
    assert_eq!(written, parted);
    let ran = run(&parted_path, &output, &["--json"]);
    let report: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!((&report["attribute_edges"], &report["flips"]), (&1.into(), &0.into()));
    assert_eq!(report["attribute_edges_by_name"], json!({ "usemtl": 1 }));
    // Nothing hinders what is dropped anyway.
    let (summary, written) = said(&parted_path, &["--drop-attributes"]);
    assert!(!summary.contains("locked") && summary.contains("\nflips      1 in 1"), "{summary}");
    assert!(summary.contains("note       not kept: texture coordinates; groups, objects and materials\n"));
    assert!(written.starts_with("v 0 0 0\nv 0.9 0.2 0\n"));
    let ran = run(&parted_path, &folder.path("out.ply"), &[]);
    assert!(text(&ran.stderr).contains("\nflips      1 in 1"), "{}", text(&ran.stderr));
    // A polygon stays one where its edges do; a packed file is one of its format.
    let quad = folder.file("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3 4\n");
    let packed = folder.path("quad.obj.gz");
    let ran = run(&quad, &packed, &[]);
    let note = "note       polygons cut into triangles, where an edge of theirs flips: 1\n";
    assert!(text(&ran.stderr).contains(note), "{}", text(&ran.stderr));
    assert_eq!(run(&packed, &output, &[]).status.code(), Some(0));
    assert_eq!(fs::read(&output).unwrap(), fs::read(&quad).unwrap());
}

#[test]
fn triangles_and_the_borders_of_groups_stay() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    let list = folder.path("list.txt");
    let ran = |option: &str, numbers: &str| {
        fs::write(&list, numbers).unwrap();
        run(&input, &output, &[option, list.to_str().unwrap(), "--json", "--verify"])
    };
    for (option, numbers, flips) in [
        ("--lock-triangles", "# the second\n1\n", 0),
        ("--lock-triangles", "", 1),
        ("--groups", "7 # and\n4294967295", 0),
        ("--groups", "7 7\n", 1),
    ] {
        let ran = ran(option, numbers);
        let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
        assert_eq!((&found["flips"], &found["audit"]), (&flips.into(), &json!([])), "{option} {numbers}");
        let remaining = if flips == 0 { json!({ "locked": 1 }) } else { json!({}) };
        assert_eq!((&found["remaining"], &found["attribute_edges"]), (&remaining, &0.into()));
    }
    for (option, numbers, status, line) in [
        ("--lock-triangles", "2", 1, "LIST: there is no triangle 2; the mesh has 2"),
        ("--groups", "1 2 3", 1, "LIST: it has 3 numbers, the mesh has 2 triangles"),
        ("--groups", "1\n-2", 1, "LIST: line 2: expected a number from 0, found `-2`"),
        ("--lock-triangles", "4294967296", 1, "LIST: line 1: expected a number from 0, found `4294967296`"),
    ] {
        failed(&ran(option, numbers), status, &line.replace("LIST", list.to_str().unwrap()));
    }
}
