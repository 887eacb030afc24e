//! Triangles that are turned over or flat: they are counted, named and listed, and the file is written.

use crate::command::{Folder, run, text};
use serde_json::{Value, json};
use std::fs;

/// Two flat triangles on one place: vertices 4 and 5.
const NEEDLE: &str = "OFF\n6 6 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n1 1 0\n1 1 0\n3 0 1 4\n3 1 2 5\n3 4 1 5\n3 2 3 5\n3 3 0 4\n3 4 5 3\n";

/// A sheet over whose lower edge its middle vertex was dragged.
const DRAGGED: &str = "OFF\n5 4 0\n0 0 0\n4 0 0\n4 4 0\n0 4 0\n2 -1 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";

#[test]
fn flat_triangles_are_counted() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", NEEDLE), folder.path("out.off"));
    let found = |more: &[&str]| -> Value {
        let ran = run(&input, &output, &[&["--json"], more].concat());
        assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
        serde_json::from_slice(&ran.stdout).unwrap()
    };
    for more in [&[][..], &["--dimension", "3"]] {
        let found = found(more);
        assert_eq!((&found["inverted"], &found["flat"]), (&0.into(), &2.into()));
        assert_eq!((&found["flat_triangles"], &found["clean"]), (&Value::Null, &Value::Null));
    }
    let found = found(&["--verify"]);
    assert_eq!((&found["audit"], &found["clean"]), (&json!([]), &true.into()));
    assert_eq!(found["inverted_triangles"], json!([]));
    let listed = found["flat_triangles"].as_array().unwrap().len();
    assert_eq!(listed, 2);
    let ran = run(&input, &output, &[]);
    let said = text(&ran.stderr);
    assert!(said.contains("\nflat       triangles: 2; their corners are on one line, "), "{said}");
    assert!(!said.contains("\ninverted"), "{said}");
}

#[test]
fn a_mesh_with_inverted_triangles_is_not_clean_but_written() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", DRAGGED), folder.path("out.off"));
    let ran = run(&input, &output, &["--json", "--verify"]);
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!((&found["inverted"], &found["flat"]), (&1.into(), &0.into()));
    assert_eq!((&found["audit"], &found["clean"]), (&json!([]), &false.into()));
    assert_eq!(found["inverted_triangles"], json!([0]));
    assert!(fs::read_to_string(&output).unwrap().starts_with("OFF\n5 4 "));
    fs::remove_file(&output).unwrap();
    let ran = run(&input, &output, &["--verify"]);
    assert_eq!(ran.status.code(), Some(0));
    let said = text(&ran.stderr);
    for line in [
        "\ninverted   triangles: 1 (0); they overlap their neighbours, and no flip could turn them back: ",
        "\naudit      no violations, but not clean: triangles are inverted\n",
        &format!("\nwrote      {}\n", output.display()),
    ] {
        assert!(said.contains(line), "{line}: {said}");
    }
    assert!(output.exists());
    // A sheet without folds says nothing of them.
    let flat = folder.file("flat.off", DRAGGED.replace("2 -1 0", "2 1 0"));
    let ran = run(&flat, &output, &["--verify"]);
    let said = text(&ran.stderr);
    assert!(said.contains("\naudit      clean\n") && !said.contains("inverted"), "{said}");
}

#[test]
fn a_folded_mesh_is_untangled() {
    let folder = Folder::new();
    // The middle vertex is near the right side, but its triangles are those of one near the left side.
    let folded = "OFF\n6 6 0\n0 0 0\n4 0 0\n4 4 0\n0 4 0\n1 1 0\n3 2 0\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 5\n3 0 4 5\n3 4 3 5\n";
    let (input, output) = (folder.file("in.off", folded), folder.path("out.off"));
    let found = |more: &[&str]| -> Value {
        let ran = run(&input, &output, &[&["--json", "--verify"], more].concat());
        assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
        serde_json::from_slice(&ran.stdout).unwrap()
    };
    assert_eq!(found(&[])["clean"], false);
    let untangled = found(&["--untangle"]);
    assert_eq!((&untangled["clean"], &untangled["inverted"]), (&true.into(), &0.into()));
    assert_eq!((&untangled["lost_edges"], &untangled["remaining"]), (&json!([]), &json!({})));
    // The locked edge from 0 to 5 goes through 4, once it is there.
    let through = folder.file("through.off", folded.replace("3 2 0", "3 3 0"));
    let locks = folder.file("locks.txt", "0 5\n");
    let ran = run(&through, &output, &["--untangle", "--verify", "--lock-edges", locks.to_str().unwrap()]);
    let said = text(&ran.stderr);
    assert_eq!(ran.status.code(), Some(0), "{said}");
    assert!(said.contains("\nlost       locked edges: 1; the first is 0-5\n"), "{said}");
    let ran = run(&input, &output, &["--untangle", "--dimension", "3"]);
    assert_eq!(ran.status.code(), Some(2));
    let said = text(&ran.stderr);
    assert!(said.contains("only a mesh of dimension 2 can be untangled"), "{said}");
}
