//! The command line triangulates points.
#![cfg(feature = "cli")]

use crate::command::{Folder, run, text};
use serde_json::{Value, json};
use std::fs;

/// Points of a square with heights; the last one equals the second in the plan.
const CSV: &str = "id,lon,lat,height\n7,0,0,5\n8,4,0,6\n9,4,3,7\n10,0,3,8\n11,4,0,9\n";
const MADE: &str = "OFF\n5 2 0\n0 0 5\n4 0 6\n4 3 7\n0 3 8\n4 0 9\n3 0 1 2\n3 0 2 3\n";

#[test]
fn points_of_every_format_become_a_mesh() {
    let folder = Folder::new();
    let output = folder.path("out.off");
    let rows = "0 0 5\n4 0 6\n4 3 7\n0 3 8\n4 0 9\n";
    let header = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    for (name, content) in [
        ("in.csv", CSV.to_owned()),
        ("in.xyz", rows.to_owned()),
        ("in.off", format!("OFF\n5 0 0\n{rows}")),
        ("in.obj", rows.lines().map(|row| format!("v {row}\n")).collect()),
        ("in.ply", format!("{header}{rows}")),
    ] {
        let ran = run(&folder.file(name, content), &output, &["--json", "--verify"]);
        assert_eq!(ran.status.code(), Some(0), "{name}: {}", text(&ran.stderr));
        assert_eq!(fs::read_to_string(&output).unwrap(), MADE, "{name}");
        let report: Value = serde_json::from_slice(&ran.stdout).unwrap();
        assert_eq!(
            report["points"],
            json!({ "heights": true, "hull": [0, 1, 2, 3], "duplicates": [[4, 1]] })
        );
        assert_eq!((&report["flips"], &report["clean"]), (&json!(0), &json!(true)), "{name}");
    }
}

#[test]
fn the_summary_says_what_became_of_points() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.csv", CSV), folder.path("out.ply"));
    let said = text(&run(&input, &output, &[]).stderr).to_owned();
    let lines = [
        "note       not kept: further columns".to_owned(),
        format!("read       {}: 5 points with heights", input.display()),
        "made       2 triangles, 4 points on the hull; in no triangle because they equal others: 1, the first 4 as 1"
            .to_owned(),
    ];
    assert_eq!(said.lines().take(3).collect::<Vec<_>>(), lines);
    for (points, why) in [
        ("1 1\n2 2\n3 3\n", "all points are on one line"),
        ("1 1\n2 2\n1 1\n", "there are fewer than three distinct points"),
    ] {
        let ran = run(&folder.file("line.xyz", points), &output, &[]);
        assert_eq!(ran.status.code(), Some(0));
        assert!(text(&ran.stderr).starts_with(&format!("note       no triangle: {why}\n")));
    }
}

/// A constraint may name a point that equals an earlier one.
#[test]
fn constraints_are_brought_into_points() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.csv", CSV), folder.path("out.off"));
    let list = folder.file("list.txt", "3 4\n");
    let ran = run(&input, &output, &["--constraints", list.to_str().unwrap(), "--verify", "--quiet"]);
    assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
    let written = fs::read_to_string(&output).unwrap();
    let faces: Vec<_> = written.lines().filter(|line| line.starts_with("3 ")).collect();
    assert!(
        faces.iter().all(|face| face.contains('1') && face.ends_with('3') | face.contains(" 3 ")),
        "{faces:?}"
    );
    assert!(written.contains("4 0 9"));
}

/// The standard output gets the format of a mesh.
#[test]
fn points_go_to_the_standard_output_as_ply() {
    let folder = Folder::new();
    let ran = run(&folder.file("in.csv", CSV), "-".as_ref(), &["--quiet"]);
    assert!(ran.stdout.starts_with(b"ply\nformat binary_little_endian 1.0\nelement vertex 5\n"));
    let ran = run(&folder.file("in.csv", CSV), &folder.path("out.csv"), &["--quiet"]);
    assert_eq!(ran.status.code(), Some(2));
}
