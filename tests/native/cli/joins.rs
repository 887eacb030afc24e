//! Vertices that are joined before a run and split after it.

use crate::command::{Folder, run, text};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// The corners of the triangles of the square, each a vertex of its own.
const CORNERS: [[f32; 3]; 6] =
    [[0.0, 0.0, 0.0], [0.9, 0.2, 0.0], [1.0, 1.0, 0.0], [-0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// The object that `--json` prints for a run without violations in `--verify`.
#[track_caller]
fn verified(input: &Path, output: &Path, arguments: &[&str]) -> Value {
    let ran = run(input, output, &[&["--json", "--quiet", "--verify"], arguments].concat());
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!(found["audit"], json!([]));
    found
}

/// An OBJ file whose triangles share no vertices, as in STL: edges flip only after vertices are joined.
#[test]
fn triangles_without_common_vertices_are_joined() {
    let folder = Folder::new();
    let vertices: String = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n")).collect();
    let input = folder.file("in.obj", format!("{vertices}f 1 2 3\nf 4 5 6\n"));
    let output = folder.path("out.obj");
    let found = verified(&input, &output, &[]);
    assert_eq!([&found["flips"], &found["joined_vertices"], &found["boundary_edges"]], [0, 0, 6]);
    let found = verified(&input, &output, &["--weld"]);
    assert_eq!([&found["flips"], &found["joined_vertices"], &found["seam_edges"]], [1, 2, 0]);
    assert_eq!([&found["vertices"], &found["edges"], &found["boundary_edges"]], [6, 5, 4]);
    let written = fs::read_to_string(&output).unwrap();
    assert_eq!(written, format!("{vertices}f 6 2 3\nf 4 2 6\n"));
    let said = text(&run(&input, &output, &["--weld"]).stderr).to_owned();
    assert!(said.contains("\njoined     2 vertices\n"), "{said}");
    // Texture coordinates of joined vertices may differ. They are not kept.
    let textured = folder.file("vt.obj", format!("{vertices}vt 0 0\nf 1/1 2/1 3/1\nf 4/1 5/1 6/1\n"));
    let said = text(&run(&textured, &output, &["--weld"]).stderr).to_owned();
    assert!(said.contains("\njoined     2 vertices\n") && said.contains("note       not kept: "), "{said}");
    // Locks the diagonal, named by vertices that are joined to others.
    let list = folder.file("list.txt", "3 2\n");
    let found = verified(&input, &output, &["--weld", "--lock-edges", list.to_str().unwrap()]);
    assert_eq!((&found["flips"], &found["remaining"]), (&0.into(), &json!({ "locked": 1 })));
    assert_eq!(found["remaining_edges"], json!({ "locked": [[0, 2]] }));
    // The second triangle is reversed.
    let turned = folder.file("turned.obj", format!("{vertices}f 1 2 3\nf 4 6 5\n"));
    let found = verified(&turned, &output, &["--weld"]);
    assert_eq!((&found["flips"], &found["inconsistent_edges"]), (&0.into(), &1.into()));
    let found = verified(&turned, &output, &["--weld", "--reorient"]);
    assert_eq!([&found["flips"], &found["turned_triangles"]], [1, 1]);
}

/// A binary file of glTF.
fn glb(json: &Value, buffer: &[u8]) -> Vec<u8> {
    let mut json = json.to_string();
    json.extend(std::iter::repeat_n(' ', json.len().next_multiple_of(4) - json.len()));
    let words = |words: [usize; 2]| words.map(|word| (word as u32).to_le_bytes()).concat();
    [
        b"glTF".as_slice(),
        &words([2, 28 + json.len() + buffer.len()]),
        &words([json.len(), 0x4e4f_534a]),
        json.as_bytes(),
        &words([buffer.len(), 0x004e_4942]),
        buffer,
    ]
    .concat()
}

/// The square in glTF without indices. With different attributes of the vertices, the diagonal is a seam.
#[test]
fn gltf_without_indices_gets_some() {
    let folder = Folder::new();
    let (input, output) = (folder.path("in.glb"), folder.path("out.glb"));
    for (heat, is_seam) in [([1.0f32; 6], false), ([1.0, 1.0, 1.0, 2.0, 1.0, 1.0], true)] {
        let numbers = CORNERS.as_flattened().iter().chain(&heat);
        let buffer: Vec<u8> = numbers.flat_map(|x| x.to_le_bytes()).collect();
        let json = json!({
            "asset": { "version": "2.0" },
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "_HEAT": 1 } }] }],
            "accessors": [
                { "bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3" },
                { "bufferView": 1, "componentType": 5126, "count": 6, "type": "SCALAR" },
            ],
            "bufferViews": [{ "buffer": 0, "byteLength": 72 }, { "buffer": 0, "byteOffset": 72, "byteLength": 24 }],
            "buffers": [{ "byteLength": 96 }],
        });
        fs::write(&input, glb(&json, &buffer)).unwrap();
        assert_eq!(verified(&input, &output, &[])["flips"], 0);
        assert_eq!(fs::read(&output).unwrap(), fs::read(&input).unwrap());
        let found = verified(&input, &output, &["--weld"]);
        let seams = usize::from(is_seam);
        assert_eq!([&found["joined_vertices"], &found["seam_edges"], &found["flips"]], [2, seams, 1 - seams]);
        let said = text(&run(&input, &output, &["--weld"]).stderr).to_owned();
        let written = fs::read(&output).unwrap();
        if is_seam {
            assert_eq!(found["remaining_edges"], json!({ "locked": [[0, 2]] }));
            assert!(said.contains("\njoined     2 vertices; edges along seams, locked: 1\n"), "{said}");
            assert_eq!(written, fs::read(&input).unwrap());
        } else {
            assert!(written.windows(96).any(|bytes| bytes == buffer));
            // Nothing is left to flip.
            assert_eq!(verified(&output, &folder.path("again.glb"), &["--weld"])["flips"], 0);
            verified(&output, &folder.path("out.obj"), &[]);
            let obj = fs::read_to_string(folder.path("out.obj")).unwrap();
            assert!(obj.ends_with("f 6 2 3\nf 4 2 6\n"), "{obj}");
        }
    }
}
