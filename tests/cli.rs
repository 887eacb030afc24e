//! The command-line program from outside: what it writes, says and returns.
#![cfg(feature = "cli")]
// Clippy's exemption for tests does not reach their shared functions.
#![allow(clippy::unwrap_used)]

mod command;

use command::{Folder, SQUARE, failed, grid, run, text};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// The keys of the object that `--json` prints, in their order.
const KEYS: [&str; 28] = [
    "input",
    "vertices",
    "triangles",
    "edges",
    "boundary_edges",
    "non_manifold_edges",
    "inconsistent_edges",
    "dimension",
    "backend",
    "adapter",
    "fallback",
    "status",
    "iterations",
    "flips",
    "flips_per_iteration",
    "dispatches",
    "device_bytes",
    "remaining",
    "min_angle_before_deg",
    "min_angle_after_deg",
    "before",
    "after",
    "turned_triangles",
    "joined_vertices",
    "seam_edges",
    "moved_triangles",
    "attribute_edges",
    "ms",
];

/// The parts of the wall time.
const PARTS: [&str; 11] = [
    "start",
    "load",
    "prepare",
    "device",
    "upload",
    "adjacency",
    "flip",
    "count",
    "measure",
    "verify",
    "save",
];

#[test]
fn the_parts_add_up_to_the_wall_time() {
    let folder = Folder::new();
    let (input, output) = (folder.path("in.off"), folder.path("out.off"));
    edgeflip::io::write(&input, &grid(300)).unwrap();
    for arguments in
        [["--json", "-q"].as_slice(), &["--json", "--verify"], &["--json", "--weld", "--reorient"]]
    {
        let start = Instant::now();
        let ran = run(&input, &output, arguments);
        let wall = start.elapsed().as_secs_f64() * 1e3;
        let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
        let ms = |key: &str| found["ms"][key].as_f64();
        let (sum, total) = (PARTS.iter().filter_map(|part| ms(part)).sum::<f64>(), ms("total").unwrap());
        assert!(sum <= total + 0.1 && sum >= 0.95 * total && total <= wall, "{wall} ms: {}", found["ms"]);
    }
}

#[test]
fn json_has_the_documented_keys() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.obj"));
    let ran = run(&input, &output, &["--json"]);
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let line = text(&ran.stdout);
    assert!(line.ends_with("}\n") && line.lines().count() == 1);
    let found: Value = serde_json::from_str(line).unwrap();
    assert_eq!(found.as_object().unwrap().len(), KEYS.len());
    let places: Vec<_> = KEYS.iter().map(|key| line.find(&format!("\"{key}\":")).unwrap()).collect();
    assert!(places.is_sorted());
    assert_eq!(found["input"], input.display().to_string());
    assert_eq!((&found["vertices"], &found["triangles"]), (&4.into(), &2.into()));
    assert_eq!(found["dimension"], 2);
    assert_eq!((&found["backend"], &found["status"]), (&"cpu".into(), &"done".into()));
    assert!(found["flips_per_iteration"].is_array() && found["remaining"].is_object());
    let ms = found["ms"].as_object().unwrap();
    assert_eq!(Vec::from_iter(ms.keys()), [&PARTS[..], &["total"]].concat());
    for (key, ms) in ms {
        assert!(ms.is_number() || key == "verify" && ms.is_null(), "ms.{key}");
    }
    assert!(found["min_angle_before_deg"].is_number() && found["min_angle_after_deg"].is_number());
    // The smallest angles of the two triangles: 32.5° and 45° before, 45° and 45° after.
    let [before, after] = ["before", "after"].map(|when| found[when]["mean_min_angle_deg"].as_f64().unwrap());
    assert!((before - 38.7).abs() < 0.1 && (after - 45.0).abs() < 1e-5, "{before}° → {after}°");
    assert_eq!(found["moved_triangles"], 2);
    assert!(fs::read_to_string(&output).unwrap().starts_with("v 0 0 0\nv 0.9 0.2 0\nv 1 1 0\nv 0 1 0\nf "));
}

#[test]
fn the_wrong_diagonal_is_flipped() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    let ran = run(&input, &output, &["--json", "--verify"]);
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!((&found["flips"], &found["iterations"]), (&1.into(), &1.into()));
    assert_eq!((&found["edges"], &found["boundary_edges"]), (&5.into(), &4.into()));
    assert_eq!(found["flips_per_iteration"], Value::Array(vec![1.into()]));
    assert!(found["min_angle_before_deg"].as_f64() < found["min_angle_after_deg"].as_f64());
    let written = fs::read_to_string(&output).unwrap();
    for face in written.lines().skip(6) {
        assert!(face.contains('1') && face[1..].contains('3'), "{face}");
    }
}

#[test]
fn verify_adds_an_empty_audit() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    let ran = run(&input, &output, &["--json", "--verify"]);
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!((&found["audit"], &found["remaining_edges"]), (&json!([]), &json!({})));
    assert_eq!(found["distance"], 0.0);
}

#[test]
fn verify_names_the_edges_left() {
    // Seven roofs, each cut along its ridge, which is too sharp to flip, and a thin diamond, cut along 28-30.
    let mut mesh = "OFF\n32 16 0\n".to_owned();
    for x in (0..7).map(|roof| 10 * roof) {
        mesh += &format!("{x} 0 0\n{} 0 0\n{} 0.5 0\n{} 0 0.5\n", x + 4, x + 2, x + 2);
    }
    mesh += "70 0 0\n73 -1 0\n76 0 0\n73 1 0\n3 28 29 30\n3 28 30 31\n";
    for v in (0..7).map(|roof| 4 * roof) {
        mesh += &format!("3 {v} {} {}\n3 {} {v} {}\n", v + 1, v + 2, v + 1, v + 3);
    }
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", mesh), folder.path("out.off"));
    let ran = run(&input, &output, &["--verify", "--max-iterations", "0", "--json"]);
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    let ridges = [[0, 1], [4, 5], [8, 9], [12, 13], [16, 17], [20, 21], [24, 25]];
    assert_eq!(found["remaining_edges"], json!({ "angle": ridges, "stopped": [[28, 30]] }));
    let ran = run(&input, &output, &["--verify", "--max-iterations", "0"]);
    let line = "\nedges left angle 0-1, 4-5, 8-9, 12-13, 16-17 and 2 more; stopped 28-30\n";
    assert!(text(&ran.stderr).contains(line), "{}", text(&ran.stderr));
    let ran = run(&input, &output, &["--verify"]);
    assert!(text(&ran.stderr).contains(" and 2 more\n"), "{}", text(&ran.stderr));
}

#[test]
fn triangles_can_be_turned_first() {
    let folder = Folder::new();
    let turned = SQUARE.replace("3 0 2 3", "3 0 3 2").replace("0 1 0\n3", "0 1 0.1\n3");
    let (input, output) = (folder.file("in.off", turned), folder.path("out.off"));
    let found = |more: &[&str]| -> Value {
        let ran = run(&input, &output, &[&["--json", "--verify", "--max-normal-angle", "90"], more].concat());
        assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
        serde_json::from_slice(&ran.stdout).unwrap()
    };
    let left = found(&[]);
    assert_eq!((&left["flips"], &left["remaining"]), (&0.into(), &json!({ "inconsistent": 1 })));
    let done = found(&["--reorient"]);
    assert_eq!(
        (&done["turned_triangles"], &done["flips"], &done["remaining"]),
        (&1.into(), &1.into(), &json!({}))
    );
}

/// The square as glTF whose buffer is in a file beside it, and stretched and moved by its node.
#[test]
fn gltf_comes_out_with_other_indices() {
    let folder = Folder::new();
    let positions = [[0.0f32, 0.0], [0.9, 0.2], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| [x, y, 0.0]);
    let indices = [0u32, 1, 2, 0, 2, 3];
    let buffer: Vec<u8> = positions
        .as_flattened()
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .chain(indices.iter().flat_map(|i| i.to_le_bytes()))
        .collect();
    fs::create_dir(folder.path("data")).unwrap();
    fs::write(folder.path("data/a b.bin"), &buffer).unwrap();
    let json = json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "translation": [0, 0, 5], "scale": [2, 2, 2] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "NORMAL": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5125, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [{ "buffer": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 24 }],
        "buffers": [{ "uri": "data/a%20b.bin", "byteLength": 72 }],
    });
    let input = folder.file("in.gltf", json.to_string());
    let line = format!(
        "{}: buffer 0: it is in the file `data/a b.bin`: other files are read only if that is allowed (--external-files)",
        input.display()
    );
    failed(&run(&input, &folder.path("out.glb"), &[]), 1, &line);
    let glb = folder.path("out.glb");
    let ran = run(&input, &glb, &["--external-files", "--verify"]);
    let said = text(&ran.stderr);
    assert_eq!(ran.status.code(), Some(0), "{said}");
    assert!(said.contains("flips      1 in 1 iteration, done\n") && !said.contains("not kept"), "{said}");
    let written = fs::read(&glb).unwrap();
    let binary = &written[written.len() - 72..];
    assert_eq!(&binary[..48], &buffer[..48]);
    let words: Vec<u32> = binary[48..].as_chunks().0.iter().map(|&word| u32::from_le_bytes(word)).collect();
    assert!(words != indices && words.iter().all(|&i| i < 4), "{words:?}");
    let obj = folder.path("out.obj");
    let ran = run(&glb, &obj, &[]);
    assert!(text(&ran.stderr).contains("note       not kept: attributes of vertices besides positions\n"));
    assert!(fs::read_to_string(obj).unwrap().starts_with("v 0 0 5\nv 1.8 0.4 5\nv 2 2 5\nv 0 2 5\nf "));
}

/// The corners of the triangles of the square, each a vertex of its own.
const CORNERS: [[f32; 3]; 6] =
    [[0.0, 0.0, 0.0], [0.9, 0.2, 0.0], [1.0, 1.0, 0.0], [-0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];

/// The object that `--json` prints of a run, which `--verify` finds nothing in.
#[track_caller]
fn verified(input: &Path, output: &Path, arguments: &[&str]) -> Value {
    let ran = run(input, output, &[&["--json", "--quiet", "--verify"], arguments].concat());
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!(found["audit"], json!([]));
    found
}

/// An OBJ file as STL files are: edges flip only where vertices are joined.
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
    // Vertices that are joined may differ in what only the file knows: it is not kept.
    let textured = folder.file("vt.obj", format!("{vertices}vt 0 0\nf 1/1 2/1 3/1\nf 4/1 5/1 6/1\n"));
    let said = text(&run(&textured, &output, &["--weld"]).stderr).to_owned();
    assert!(said.contains("\njoined     2 vertices\n") && said.contains("note       not kept: "), "{said}");
    // The diagonal, by vertices that are joined to others.
    let list = folder.file("list.txt", "3 2\n");
    let found = verified(&input, &output, &["--weld", "--lock-edges", list.to_str().unwrap()]);
    assert_eq!((&found["flips"], &found["remaining"]), (&0.into(), &json!({ "locked": 1 })));
    assert_eq!(found["remaining_edges"], json!({ "locked": [[0, 2]] }));
    // The second triangle turned round.
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

/// The square in glTF without indices. A number for each vertex makes a seam of the diagonal.
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
        ("0 2\n1 3\n", 2, "option locked_edges: the mesh has no edge between vertices 1 and 3"),
        ("0 9\n", 2, "option locked_edges: the mesh has no edge between vertices 0 and 9"),
        ("0 1\n2\n", 1, "LIST: line 2: expected 2 vertex indices, found 1"),
        ("0 1 2\n", 1, "LIST: line 1: expected 2 vertex indices, found 3"),
        ("0 -1\n", 1, "LIST: line 1: expected a vertex index, found `-1`"),
        ("0 4294967296\n", 1, "LIST: line 1: expected a vertex index, found `4294967296`"),
        ("zero one\n", 1, "LIST: line 1: expected a vertex index, found `zero`"),
    ] {
        fs::write(&list, text).unwrap();
        failed(&locking(&[]), status, &line.replace("LIST", list.to_str().unwrap()));
    }
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
    let locked =
        "\nlocked     1 edges between groups or along seams stay; --drop-attributes lets them flip\n";

    let (summary, written) = said(&whole, &[]);
    assert!(!summary.contains("locked") && !summary.contains("not kept"), "{summary}");
    assert_eq!(written, format!("{points}usemtl a\nf 4/4 2/2 3/3\nf 1/1 2/2 4/4\n"));
    let (summary, written) = said(&parted_path, &[]);
    assert!(summary.contains(locked) && summary.contains("not Delaunay: locked 1\n"), "{summary}");
    assert_eq!(written, parted);
    let ran = run(&parted_path, &output, &["--json"]);
    let report: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!((&report["attribute_edges"], &report["flips"]), (&1.into(), &0.into()));
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
        ("--lock-triangles", "2", 2, "option locked_triangles: there is no triangle 2; the mesh has 2"),
        ("--groups", "1 2 3", 2, "option groups: it has 3 numbers, the mesh has 2 triangles"),
        ("--groups", "1\n-2", 1, "LIST: line 2: expected a number from 0, found `-2`"),
        ("--lock-triangles", "4294967296", 1, "LIST: line 1: expected a number from 0, found `4294967296`"),
    ] {
        failed(&ran(option, numbers), status, &line.replace("LIST", list.to_str().unwrap()));
    }
}

#[test]
fn the_summary_is_on_standard_error() {
    let folder = Folder::new();
    let quad = "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n";
    let (input, output) = (folder.file("in.obj", quad), folder.path("out.off"));
    let ran = run(&input, &output, &["--verify"]);
    let said = text(&ran.stderr);
    assert_eq!((ran.status.code(), text(&ran.stdout)), (Some(0), ""), "{said}");
    for line in [
        "note       polygons cut into triangles: 1\n",
        "note       not kept: normals\n",
        "4 vertices, 2 triangles, 3D\n",
        "\nbackend    cpu",
        "\naudit      clean\n",
        "\nmoved      0 triangles, the surface by up to 0.0000\n",
        "\nvolume     ",
        "\nwrote      ",
    ] {
        assert!(said.contains(line), "{line:?} is not in\n{said}");
    }
    let ran = run(&input, &output, &["--quiet"]);
    assert_eq!((ran.status.code(), text(&ran.stdout), text(&ran.stderr)), (Some(0), "", ""));
}

#[test]
fn the_input_can_be_the_output() {
    let folder = Folder::new();
    let input = folder.file("in.off", SQUARE);
    assert_eq!(run(&input, &input, &["--quiet"]).status.code(), Some(0));
    assert!(fs::read_to_string(&input).unwrap().starts_with("OFF\n4 2 0\n0 0 0\n0.9 0.2 0\n"));
    assert_eq!(folder.names(), ["in.off"]);
}

#[test]
fn a_bad_file_gives_one_line_and_no_output() {
    let cases: [(&str, Vec<u8>, &str); 15] = [
        ("a.off", SQUARE[..SQUARE.len() - 8].into(), "line 7: the file ends after 1 of 2 faces"),
        ("b.off", SQUARE[..SQUARE.len() - 4].into(), "line 8: expected 3 vertex indices, found 1"),
        (
            "c.off",
            SQUARE.replace("0 2 3", "0 2 4").into(),
            "line 8: vertex index `4` is out of range, the mesh has 4 vertices",
        ),
        ("d.off", SQUARE.replace("0.9", "nan").into(), "line 4: `nan` is not a finite 32-bit number"),
        ("e.off", SQUARE.replace("0.9", "1e999").into(), "line 4: `1e999` is not a finite 32-bit number"),
        ("f.off", SQUARE.replace("0.9", "ninety").into(), "line 4: expected a number, found `ninety`"),
        (
            "g.off",
            SQUARE.replace("4 2 0", "4000000000 2 0").into(),
            "line 8: the file ends after 6 of 4000000000 vertices",
        ),
        ("h.off", vec![], "line 1: the file is empty"),
        ("h.obj", vec![], "line 1: the file is empty"),
        (
            "i.off",
            b"\0\x01\x02\xff\n\r\n".to_vec(),
            r"line 1: expected the keyword OFF of an OFF file, found `\x00\x01\x02\xff`",
        ),
        (
            "j.obj",
            "v 0 0 0\nf 1 1 2\n".into(),
            "line 2: vertex index `2` is out of range, the mesh has 1 vertices",
        ),
        ("k.obj", "v 0 0 0\nv inf 0 0\n".into(), "line 2: `inf` is not a finite 32-bit number"),
        ("l.ply", SQUARE.into(), "line 1: expected the keyword ply of a PLY file, found `OFF`"),
        (
            "m.stl",
            vec![0; 84 + 49],
            "byte 84: expected the end of the file after 0 facets, found 49 more bytes",
        ),
        ("n.off.gz", b"\x1f\x8b\x08".into(), "byte 3: the gzip'd file is cut off (unexpected end of file)"),
    ];
    for (name, bytes, line) in cases {
        let folder = Folder::new();
        let input = folder.file(name, bytes);
        for json in [&["--json"][..], &[]] {
            let ran = run(&input, &folder.path("out.off"), json);
            failed(&ran, 1, &format!("{}: {line}", input.display()));
        }
        assert_eq!(folder.names(), [name]);
    }
}

/// A kite of vertices 0 to 3 with what scans and exports add to it, in three formats.
///
/// ```text
///        2
///      / | \
///     0 -+- 1      0-1 is not Delaunay
///      \ | /
///        3
/// ```
#[test]
fn dirty_files_say_what_was_left() {
    // The triangle above twice: 0-1 has three triangles.
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nelement face 3\n\
        property list uchar int vertex_indices\nend_header\n-2 0\n2 0\n0 1\n0 -1\n3 0 1 2\n3 1 0 3\n3 0 1 2\n";
    // The triangle below turned over, a vertex that none has, and a triangle that has one vertex three times.
    let off = "OFF\n5 3 0\n-2 0 0\n2 0 0\n0 1 0\n0 -1 0\n9 9 9\n3 0 1 2\n3 0 1 3\n3 2 2 2\n";
    // Nothing but a facet without area at the upper left edge.
    let facet = |corners: [&str; 3]| {
        format!("facet normal 0 0 0\nouter loop\nvertex {}\nendloop\nendfacet\n", corners.join("\nvertex "))
    };
    let facets = [["-2 0 0", "2 0 0", "0 1 0"], ["2 0 0", "-2 0 0", "0 -1 0"], ["-2 0 0", "0 1 0", "0 1 0"]]
        .map(facet);
    let stl = format!("solid\n{}endsolid\n", facets.concat());
    let folder = Folder::new();
    let outcomes = [
        ("0, done", "not Delaunay: non-manifold 1\nedges left non-manifold 0-1"),
        ("0, done", "not Delaunay: inconsistent 1\nedges left inconsistent 0-1"),
        ("1 in 1 iteration, done", "no edge that is not Delaunay"),
    ];
    let files = [
        (
            "in.ply",
            ply,
            "4 vertices, 3 triangles, 2D\nfrozen     1 non-manifold edges, 2 inconsistent edges, left as they are",
        ),
        (
            "in.off",
            off,
            "5 vertices, 3 triangles, 3D\nfrozen     1 non-manifold edges, 1 inconsistent edges, left as they are",
        ),
        ("in.stl", &stl, "4 vertices, 3 triangles, 2D"),
    ];
    for ((name, bytes, size), (flips, left)) in files.into_iter().zip(outcomes) {
        let ran = run(&folder.file(name, bytes), &folder.path("out.off"), &["--verify"]);
        let said = text(&ran.stderr);
        assert_eq!(ran.status.code(), Some(0), "{said}");
        let outcome = format!("flips      {flips}\nleft       {left}");
        for lines in [size, &outcome, "audit      clean"] {
            assert!(said.contains(&format!("{lines}\n")), "{lines:?} is not in\n{said}");
        }
    }
}

/// From format to format: the triangles are those of the OFF file, or have their corners, in the same order.
#[test]
fn every_format_is_read_and_written() {
    use edgeflip::io::{ReadOptions, read};
    let folder = Folder::new();
    let (off, flipped) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    assert_eq!(run(&off, &flipped, &["--quiet"]).status.code(), Some(0));
    let expected = read(&flipped, &ReadOptions::default()).unwrap();
    let corners = |mesh: &edgeflip::Mesh| -> Vec<f64> {
        let numbers: Vec<f64> = mesh.positions().iter().collect();
        mesh.triangles().iter().flat_map(|&v| numbers[2 * v as usize..][..2].to_vec()).collect()
    };
    let names = ["a.obj", "a.ply", "a.PLY.gz", "a.off.gz", "a.obj.gz", "a.stl", "a.stl.gz"];
    for name in names {
        let (input, output) = (folder.path(name), folder.path(&format!("out-{name}")));
        let converted = run(&off, &input, &["--max-iterations", "0", "--quiet"]);
        assert_eq!((converted.status.code(), text(&converted.stderr)), (Some(0), ""));
        let ran = run(&input, &output, &["--verify", "--json"]);
        assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
        let found = read(&output, &ReadOptions::default()).unwrap();
        assert_eq!(corners(&found), corners(&expected), "{name}");
        if !name.starts_with("a.stl") {
            assert_eq!(found, expected, "{name}");
        }
        let is_packed = fs::read(&output).unwrap().starts_with(&[0x1f, 0x8b]);
        assert_eq!(is_packed, name.ends_with(".gz"), "{name}");
    }
    let wide = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty uchar red\n\
        element face 1\nproperty list uchar int vertex_index\nend_header\n0.1 0 1\n1 0 1\n0 1 1\n3 0 1 2\n";
    let (wide, output) = (folder.file("wide.ply", wide), folder.path("wide-out.ply"));
    let ran = run(&wide, &output, &["--drop-attributes"]);
    assert!(text(&ran.stderr).contains("note       not kept: vertex properties `red`\n"));
    let positions = read(&output, &ReadOptions::default()).unwrap().positions().clone();
    assert_eq!(positions, edgeflip::Positions::F64(vec![0.1, 0., 1., 0., 0., 1.]));
}

#[test]
fn a_file_is_as_large_as_it_may_be() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off.gz"));
    let length = SQUARE.len().to_string();
    assert_eq!(run(&input, &output, &["--max-bytes", &length]).status.code(), Some(0));
    for input in [input, output] {
        let line = "the file has more than 20 bytes, packed or unpacked; --max-bytes sets the limit";
        let ran = run(&input, &folder.path("out.off"), &["--max-bytes", "20"]);
        failed(&ran, 1, &format!("{}: {line}", input.display()));
    }
    assert_eq!(folder.names(), ["in.off", "out.off.gz"]);
}

#[test]
fn a_refused_file_leaves_an_old_output_as_it_was() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", "OFF 1 0\n"), folder.file("out.off", "old"));
    assert_eq!(run(&input, &output, &[]).status.code(), Some(1));
    assert_eq!(fs::read_to_string(output).unwrap(), "old");
}

#[test]
fn a_file_that_cannot_be_read_or_written() {
    let folder = Folder::new();
    let (input, absent) = (folder.file("in.off", SQUARE), folder.path("absent.off"));
    let ran = run(&absent, &folder.path("out.off"), &[]);
    assert!(text(&ran.stderr).starts_with(&format!("edgeflip: {}: ", absent.display())));
    assert_eq!((ran.status.code(), text(&ran.stderr).lines().count()), (Some(1), 1));

    let unknown = folder.file("in.mesh", SQUARE);
    let line = format!(
        "{}: unknown format; use one of: .off, .obj, .ply, .stl, .gltf, .glb, also gzip'd (.gz)",
        unknown.display()
    );
    failed(&run(&unknown, &folder.path("out.off"), &[]), 1, &line);
    let output = folder.path("out.mesh");
    let line = format!(
        "{}: unknown format; use one of: .off, .obj, .ply, .stl, .gltf, .glb, also gzip'd (.gz)",
        output.display()
    );
    failed(&run(&input, &output, &[]), 2, &line);
    let output = folder.path("none/out.off");
    let line = format!("{}: the folder does not exist", output.display());
    failed(&run(&input, &output, &[]), 1, &line);
    assert_eq!(folder.names(), ["in.mesh", "in.off"]);
}

#[test]
fn the_dimension_can_be_forced() {
    let folder = Folder::new();
    let raised = folder.file("in.off", SQUARE.replace("1 1 0", "1 1 0.5"));
    let output = folder.path("out.off");
    let line = format!(
        "{}: vertex 2: z is 0.5, but the mesh was asked for in 2D, where every z must be 0",
        raised.display()
    );
    failed(&run(&raised, &output, &["--dimension", "2"]), 1, &line);
    let flat = folder.file("flat.off", SQUARE);
    for (asked, found) in [("auto", 2), ("2", 2), ("3", 3)] {
        let ran = run(&flat, &output, &["--json", "--dimension", asked]);
        let report: Value = serde_json::from_slice(&ran.stdout).unwrap();
        assert_eq!(report["dimension"], found);
    }
}

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

/// With no Vulkan driver to find there is no GPU, and the one that was asked for is not replaced.
#[cfg(target_os = "linux")]
#[test]
fn a_backend_that_is_not_there_is_3() {
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
        "never falls back",
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

/// A reader of standard output or standard error that goes away is no reason to panic or to fail.
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
