//! Edges that are brought in.

use crate::command::{Folder, SQUARE, failed, run, text};
use serde_json::{Value, json};
use std::fs;

#[test]
fn constraints_are_brought_in() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    let list = folder.file("list.txt", "# the other diagonal\n3 1\n");
    let with =
        |more: &[&str]| run(&input, &output, &[&["--constraints", list.to_str().unwrap()], more].concat());
    let said = |more: &[&str]| -> Value {
        let ran = with(&[more, &["--json", "--verify"]].concat());
        assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
        serde_json::from_slice(&ran.stdout).unwrap()
    };
    let found = said(&[]);
    assert_eq!((&found["crossed_edges"], &found["flips"]), (&1.into(), &0.into()));
    assert_eq!(
        (&found["left_out"], &found["audit"], &found["remaining"]),
        (&json!([]), &json!([]), &json!({}))
    );
    let written = fs::read_to_string(&output).unwrap();
    assert!(
        ["1 2 3", "2 3 1", "3 1 2"].iter().any(|face| written.contains(&format!("\n3 {face}\n"))),
        "{written}"
    );
    assert!(text(&with(&[]).stderr).contains("\ninserted   constraints, which crossed 1 edges\n"));

    fs::remove_file(&output).unwrap();
    fs::write(&list, "1 3\n0 2\n").unwrap();
    let why = "constraint 1 between 0 and 2 crosses constraint 0 between 1 and 3";
    failed(&with(&[]), 1, &format!("{}: {why}", list.display()));
    assert_eq!(folder.names(), ["in.off", "list.txt"]);
    assert_eq!(said(&["--skip-constraints"])["left_out"], json!([{ "index": 1, "reason": why }]));
    let summary = with(&["--skip-constraints"]);
    assert!(text(&summary.stderr).contains(&format!("\nleft out   constraints: 1; {why}\n")));
    fs::write(&list, "0 9\n").unwrap();
    let line = format!("{}: constraint 0 joins 0 and 9; the mesh has 4 vertices", list.display());
    failed(&with(&[]), 1, &line);
}

/// Vertex 1 is 0.7 / √2 away from the line between 0 and 2.
#[test]
fn a_near_vertex_counts_as_on_a_constraint() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    let list = folder.file("list.txt", "0 2\n1 3\n");
    let list = ["--constraints", list.to_str().unwrap()];
    let with = |more: &[&str]| run(&input, &output, &[&list, more].concat());
    assert!(text(&with(&[]).stderr).contains("crosses constraint 0"));
    let ran = with(&["--constraint-tolerance", "0.5", "--json", "--verify"]);
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!((&found["left_out"], &found["audit"]), (&json!([]), &json!([])));
    let deviation = found["deviation"].as_f64().unwrap();
    assert!((deviation - 0.7 / 2f64.sqrt()).abs() < 1e-6, "{deviation}");
    let summary = with(&["--constraint-tolerance", "0.5"]);
    assert!(
        text(&summary.stderr).contains("\ntolerated  vertices up to 0.4950 from constraints\n"),
        "{}",
        text(&summary.stderr)
    );
    failed(
        &with(&["--constraint-tolerance=-1"]),
        2,
        "option --constraint-tolerance: -1 is not a length: give 0 or more",
    );
}

/// Vertex 1 is on the constraint between 0 and 2, and an edge goes there, but none goes on from it.
#[test]
fn a_constraint_beside_a_dead_end_passes_the_audit() {
    let folder = Folder::new();
    let points = "0 0 0\n1 0 0\n2 0 0\n0 2 0\n0 -1 0\n";
    let input = folder.file("in.off", format!("OFF\n5 2 0\n{points}3 0 2 3\n3 0 4 1\n"));
    let (list, output) = (folder.file("list.txt", "0 2\n"), folder.path("out.off"));
    let ran = run(&input, &output, &["--constraints", list.to_str().unwrap(), "--verify", "--quiet"]);
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    assert!(output.exists());
}

/// Both diagonals of a square with a colour at its first vertex, which only a file of the same vertices keeps.
#[test]
fn edges_that_cross_get_a_vertex() {
    let folder = Folder::new();
    let square = "COFF\n4 2 0\n0 0 0 255 0 0 255\n4 0 0\n4 2 0\n0 2 0\n3 0 1 2\n3 0 2 3\n";
    let input = folder.file(
        "in.off",
        square
            .replace("4 0 0\n", "4 0 0 0 0 0 255\n")
            .replace("4 2 0\n0 2 0\n", "4 2 0 0 0 0 255\n0 2 0 0 0 0 255\n"),
    );
    let output = folder.path("out.off");
    let list = folder.file("list.txt", "0 2\n1 3\n");
    let arguments = ["--constraints", list.to_str().unwrap(), "--split-crossings", "--verify"];
    let ran = run(&input, &output, &[&arguments[..], &["--json"]].concat());
    assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
    let said: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!(
        [&said["new_vertices"], &said["vertices"], &said["triangles"], &said["left_out"], &said["clean"]],
        [&json!(1), &json!(5), &json!(4), &json!([]), &json!(true)]
    );
    assert_eq!(said["deviation"], json!(0.0));
    let written = fs::read_to_string(&output).unwrap();
    assert!(written.starts_with("OFF\n5 4 0\n0 0 0\n4 0 0\n4 2 0\n0 2 0\n2 1 0\n"), "{written}");
    let summary = run(&input, &output, &arguments);
    let summary = text(&summary.stderr);
    for line in [
        ": 4 vertices, 2 triangles, 2D\n",
        "\nsplit      1 crossings; an edge moved by up to 0.0000\n",
        "note       not kept: ",
    ] {
        assert!(summary.contains(line), "{summary}");
    }

    let list = ["--constraints", list.to_str().unwrap(), "--split-crossings"];
    let refused = run(&input, &output, &[&list[..], &["--weld"]].concat());
    assert_eq!(refused.status.code(), Some(2));
    let part = folder.path("part.glb");
    assert_eq!(run(&input, &part, &["--quiet"]).status.code(), Some(0));
    let line = format!(
        "{}: option --split-crossings: the parts of a glTF file have no place for new vertices; convert it to PLY first",
        part.display()
    );
    failed(&run(&part, &output, &[&list[..], &["--plane", "xy"]].concat()), 1, &line);
}

#[test]
fn breaklines_that_cross_have_a_height() {
    let folder = Folder::new();
    let input = folder.file("in.obj", "v 0 0 5\nv 10 0 6\nv 10 10 7\nv 0 10 5.5\nf 1 2 4\nf 2 3 4\n");
    let (list, output) = (folder.file("list.txt", "0 2\n3 1\n"), folder.path("out.obj"));
    let list = ["--constraints", list.to_str().unwrap(), "--split-crossings", "--plane", "xy", "--verify"];
    let ran = run(&input, &output, &list);
    assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
    assert!(fs::read_to_string(&output).unwrap().contains("v 0 10 5.5\nv 5 5 6\nf "));
}
