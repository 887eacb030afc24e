//! The command-line program as a process: its files, its messages and its exit status.
#![cfg(feature = "cli")]

// These names end as no other module of the tests does, because a part of a name chooses tests.
mod areas;
mod constraint_options;
mod files;
mod ignore_options;
mod joins;
mod lock_options;
mod shown;
mod terrain;
mod usage;

use crate::command::{Folder, SQUARE, grid, run, text};
use serde_json::{Value, json};
use std::fs;
use std::time::Instant;

/// The keys of the object that `--json` prints, in their order.
const KEYS: [&str; 40] = [
    "input",
    "vertices",
    "triangles",
    "edges",
    "boundary_edges",
    "non_manifold_edges",
    "inconsistent_edges",
    "dimension",
    "plane",
    "coordinates",
    "crossing_polygons",
    "points",
    "backend",
    "adapter",
    "fallback",
    "status",
    "iterations",
    "flips",
    "crossed_edges",
    "new_vertices",
    "deviation",
    "left_out",
    "lost_edges",
    "flips_per_iteration",
    "dispatches",
    "device_bytes",
    "remaining",
    "inverted",
    "flat",
    "min_angle_before_deg",
    "min_angle_after_deg",
    "before",
    "after",
    "turned_triangles",
    "joined_vertices",
    "seam_edges",
    "moved_triangles",
    "attribute_edges",
    "attribute_edges_by_name",
    "ms",
];

/// The parts of the wall time.
const PARTS: [&str; 12] = [
    "start",
    "load",
    "prepare",
    "device",
    "constraints",
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
    let offsets: Vec<_> = KEYS.iter().map(|key| line.find(&format!("\"{key}\":")).unwrap()).collect();
    assert!(offsets.is_sorted());
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
