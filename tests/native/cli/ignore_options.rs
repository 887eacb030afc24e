//! `--ignore-attribute`, and the attributes that the summary names.

use crate::command::{Folder, failed, run, text};
use serde_json::{Value, json};
use std::fs;

/// A kite whose two faces have different numbers.
const FACE_ID: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    element face 2\nproperty list uchar int vertex_indices\nproperty int id\nend_header\n-3 0 0\n0 -1 0\n3 0 0\n0 1 0\n\
    3 0 1 2 0\n3 0 2 3 1\n";

/// The same kite, whose two facets have almost the same normal.
const FACET_NOISE: &str = "v -3 0 0\nv 0 -1 0\nv 3 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0.0001 1\n\
    f 1//1 2//1 3//1\nf 1//2 3//2 4//2\n";

#[test]
fn an_attribute_that_locks_every_edge_is_named_and_ignored() {
    let folder = Folder::new();
    for (name, file, attribute, faces) in [
        ("face_id.ply", FACE_ID, "id", "3 3 1 2 0\n3 0 1 3 1\n"),
        ("facet_noise.obj", FACET_NOISE, "vn", "f 4//1 2//1 3//1\nf 1//2 2//2 4//2\n"),
    ] {
        let [input, output] = [folder.file(name, file), folder.path(&format!("out-{name}"))];
        let said = text(&run(&input, &output, &[]).stderr).to_owned();
        let line = format!(
            "\nlocked     1 edges stay to keep the attribute `{attribute}`; --ignore-attribute {attribute} lets them \
             flip\n"
        );
        assert!(said.contains(&line) && said.contains("\nleft       not Delaunay: locked 1\n"), "{said}");
        assert_eq!(fs::read_to_string(&output).unwrap(), file);
        let found: Value = serde_json::from_slice(&run(&input, &output, &["--json"]).stdout).unwrap();
        assert_eq!(
            (&found["flips"], &found["attribute_edges"], &found["attribute_edges_by_name"]),
            (&0.into(), &1.into(), &json!({ attribute: 1 }))
        );

        let ignoring = ["--ignore-attribute", attribute, "--json", "--verify"];
        let ran = run(&input, &output, &ignoring);
        let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
        assert_eq!(
            (&found["flips"], &found["attribute_edges"], &found["attribute_edges_by_name"], &found["audit"]),
            (&1.into(), &0.into(), &json!({}), &json!([]))
        );
        let written = fs::read_to_string(&output).unwrap();
        assert!(written.ends_with(faces), "{written}");
        assert_eq!(written.len(), file.len());
    }
}

#[test]
fn all_attributes_that_lock_an_edge_have_to_be_ignored() {
    let folder = Folder::new();
    let file = FACE_ID
        .replace("property int id\n", "property uchar red\nproperty uchar green\n")
        .replace("3 0 1 2 0\n3 0 2 3 1\n", "3 0 1 2 0 5\n3 0 2 3 1 6\n");
    let [input, output] = [folder.file("in.ply", file), folder.path("out.ply")];
    let said = text(&run(&input, &output, &[]).stderr).to_owned();
    let line = "\nlocked     1 edges stay to keep attributes: 1 `red`, 1 `green`; an edge may flip if \
        --ignore-attribute names all that it stays for\n";
    assert!(said.contains(line), "{said}");
    let said = text(&run(&input, &output, &["--ignore-attribute", "red"]).stderr).to_owned();
    assert!(said.contains("the attribute `green`; --ignore-attribute green lets them flip\n"), "{said}");
    let both = ["--ignore-attribute", "red", "--ignore-attribute", "green"];
    let said = text(&run(&input, &output, &both).stderr).to_owned();
    assert!(said.contains("\nflips      1 in 1") && !said.contains("locked"), "{said}");
}

#[test]
fn a_name_that_the_file_does_not_have_is_refused() {
    let folder = Folder::new();
    let input = folder.file("in.ply", FACE_ID);
    let message = "no attribute of faces or corners is named `face_id`; the file has: `id`";
    for name in ["out.ply", "out.off"] {
        let ran = run(&input, &folder.path(name), &["--ignore-attribute", "face_id"]);
        failed(&ran, 2, &format!("option --ignore-attribute: {message}"));
    }
    assert_eq!(folder.names(), ["in.ply"]);
}
