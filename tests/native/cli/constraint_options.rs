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
    assert!(fs::read_to_string(&output).unwrap().contains("\n3 3 1 2\n"));
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
