//! The formats of files, and files that are refused.

use crate::command::{Folder, SQUARE, failed, run, text};
use serde_json::{Value, json};
use std::fs;

/// The square as glTF: its buffer is in another file, and its node stretches and moves it.
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
        "{}: buffer 0: it is in the file `data/a b.bin`: reading other files is not allowed; --external-files allows it",
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

/// A file in another folder does not refer to what is not there, or a note says so.
#[test]
fn what_stays_in_the_folder_is_named() {
    let folder = Folder::new();
    fs::create_dir(folder.path("other")).unwrap();
    let positions = [[0.0f32, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| [x, y, 0.0]);
    let buffer: Vec<u8> = positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    folder.file("a b.bin", &buffer);
    let json = json!({
        "asset": { "version": "2.0" },
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "uri": "a%20b.bin", "byteLength": 36 }],
        "images": [{ "uri": "a%20b.png" }, { "uri": "data:image/png;base64,AA==" }],
    });
    let gltf = folder.file("in.gltf", json.to_string());
    let obj =
        folder.file("in.obj", "mtllib my colours.mtl\nmtllib /all.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let note =
        |files: &str| format!("note       OUT refers to files that are not copied to its folder: {files}\n");
    for (input, name, files) in [(&gltf, "out.gltf", "a b.png"), (&obj, "out.obj", "my colours.mtl")] {
        let here = folder.path(name);
        let said = text(&run(input, &here, &["--external-files"]).stderr).to_owned();
        assert!(!said.contains("refers"), "{said}");
        assert_eq!(fs::read(&here).unwrap(), fs::read(input).unwrap());
        let there = folder.path(&format!("other/{name}"));
        let said = text(&run(input, &there, &["--external-files"]).stderr).to_owned();
        assert!(said.starts_with(&note(files)), "{said}");
    }
    let written: Value = serde_json::from_slice(&fs::read(folder.path("other/out.gltf")).unwrap()).unwrap();
    let uri = written["buffers"][0]["uri"].as_str().unwrap();
    assert!(uri.starts_with("data:application/octet-stream;base64,"), "{uri}");
    let read = edgeflip::io::read(folder.path("other/out.gltf"), &Default::default()).unwrap();
    assert_eq!(read.triangle_count(), 1);
    // Another format refers to nothing.
    let said = text(&run(&obj, &folder.path("other/out.off"), &[]).stderr).to_owned();
    assert!(!said.contains("refers"), "{said}");
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
        ("d.off", SQUARE.replace("0.9", "nan").into(), "line 4: `nan` is not a finite number"),
        ("e.off", SQUARE.replace("0.9", "1e999").into(), "line 4: `1e999` is not a finite number"),
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
        ("k.obj", "v 0 0 0\nv inf 0 0\n".into(), "line 2: `inf` is not a finite number"),
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

/// A kite of vertices 0 to 3 with typical faults of scans and exports, in three formats.
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
    // The triangle above 0-1 twice, so 0-1 has three triangles.
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nelement face 3\n\
        property list uchar int vertex_indices\nend_header\n-2 0\n2 0\n0 1\n0 -1\n3 0 1 2\n3 1 0 3\n3 0 1 2\n";
    // The triangle below 0-1 is reversed. Vertex 4 is unused. The last triangle has one vertex three times.
    let off = "OFF\n5 3 0\n-2 0 0\n2 0 0\n0 1 0\n0 -1 0\n9 9 9\n3 0 1 2\n3 0 1 3\n3 2 2 2\n";
    // The kite, with a facet without area at its upper left edge.
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

/// Converts between all formats. The triangles are those of the OFF file. In STL, their corners have the same positions
/// in the same order.
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
        "{}: unknown format; use one of: .off, .obj, .ply, .stl, .gltf, .glb, .csv, .xyz, also gzip'd (.gz)",
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
        "{}: vertex 2: z is 0.5, but every z must be 0 in the 2D mesh that was requested; a terrain needs --plane",
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
