//! Meshes with heights: two coordinates decide.

use crate::command::{Folder, failed, run, text};
use edgeflip::io::{self, Format, Loaded, ReadOptions};
use edgeflip::{Dimension, Mesh, Options, Plane, Positions, constrained, families, make_delaunay};
use oorandom::Rand64;
use serde_json::{Value, json};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

const RUN: fn(u32, u64) -> ControlFlow<()> = |_, _| ControlFlow::Continue(());

/// Two triangles and a breakline along their other diagonal.
const TWO: &str = "v 0 0 5\nv 10 0 6\nv 10 10 7\nv 0 10 5.5\nf 1 2 4\nf 2 3 4\n";

/// A mesh in the plane, and the same with heights in each plane.
struct Terrain {
    plan: Mesh,
    heights: Vec<f64>,
}

impl Terrain {
    fn new(family: &str, seed: u64) -> Self {
        let plan = families::by_name(&format!("{family} seed={seed}")).unwrap();
        let mut random = Rand64::new(seed.into());
        let heights = (0..plan.vertex_count()).map(|_| f64::from(random.rand_float() as f32)).collect();
        Self { plan, heights }
    }

    fn in_plane(&self, plane: Plane) -> Mesh {
        let [u, v] = plane.axes();
        let mut numbers = Vec::new();
        let plan: Vec<f64> = self.plan.positions().iter().collect();
        for (point, height) in plan.as_chunks::<2>().0.iter().zip(&self.heights) {
            let mut three = [*height; 3];
            (three[u], three[v]) = (point[0], point[1]);
            numbers.extend(three);
        }
        Mesh::new(Dimension::Three, numbers, self.plan.triangles().to_vec()).unwrap()
    }

    /// Pairs of vertices, and what they become.
    fn constraints(&self, random: &mut Rand64) -> Vec<[u32; 2]> {
        let mut vertex = || random.rand_range(0..self.plan.vertex_count() as u64) as u32;
        (0..10).map(|_| [vertex(), vertex()]).filter(|[a, b]| a != b).collect()
    }
}

fn read(path: &Path) -> Loaded {
    let options = ReadOptions { dimension: Some(Dimension::Three), ..ReadOptions::default() };
    io::load(path, &options).unwrap()
}

fn bits(positions: &Positions) -> Vec<u64> {
    positions.iter().map(f64::to_bits).collect()
}

#[test]
fn a_breakline_comes_into_a_terrain() {
    let folder = Folder::new();
    let input = folder.file("in.obj", TWO);
    let list = folder.file("list.txt", "0 2\n");
    let output = folder.path("out.obj");
    let list = ["--constraints", list.to_str().unwrap(), "--verify"];
    let ran = run(&input, &output, &[&["--plane", "xy"], &list[..]].concat());
    assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
    assert!(text(&ran.stderr).contains(": 4 vertices, 2 triangles, 2D with heights, plane xy\n"));
    let expected = TWO.replace("f 1 2 4\nf 2 3 4\n", "f 3 4 1\nf 1 2 3\n");
    let sorted = |file: &str| {
        let turned = |line: &str| match line.strip_prefix("f ") {
            Some(corners) => {
                let mut corners: Vec<_> = corners.split(' ').collect();
                let least = (0..3).min_by_key(|&i| corners[i]).unwrap();
                corners.rotate_left(least);
                format!("f {}", corners.join(" "))
            }
            None => line.to_owned(),
        };
        let mut lines: Vec<String> = file.lines().map(turned).collect();
        lines.sort();
        lines
    };
    assert_eq!(sorted(&fs::read_to_string(&output).unwrap()), sorted(&expected));
    // Without the plane, both the surface and the mesh in the plane are refused, and say what to do.
    let surface = run(&input, &output, &list);
    assert_eq!(surface.status.code(), Some(1));
    assert!(text(&surface.stderr).contains("--plane"), "{}", text(&surface.stderr));
    let flat = run(&input, &output, &["--dimension", "2"]);
    let line =
        "vertex 0: z is 5, but every z must be 0 in the 2D mesh that was requested; a terrain needs --plane";
    failed(&flat, 1, &format!("{}: {line}", input.display()));
    let both = run(&input, &output, &["--dimension", "3", "--plane", "xy"]);
    failed(&both, 2, "option --plane: a terrain is a mesh in the plane; leave out --dimension 3");
}

#[test]
fn every_plane_gives_what_its_plan_gives() {
    let folder = Folder::new();
    let mut random = Rand64::new(5);
    for seed in 0..12 {
        let terrain = Terrain::new("random 20", seed);
        let constraints = terrain.constraints(&mut random);
        let options = Options {
            constraints: constraints.clone(),
            skips_constraints: true,
            backend: edgeflip::Backend::Cpu,
            ..Options::default()
        };
        let expected = make_delaunay(&terrain.plan, &options, RUN).unwrap();
        assert!(expected.flips > 0 && expected.left_out.len() < constraints.len());
        let lines: String = constraints.iter().map(|[a, b]| format!("{a} {b}\n")).collect();
        let list = folder.file("list.txt", lines);
        for plane in Plane::ALL {
            let mesh = terrain.in_plane(plane);
            assert_eq!(mesh.plan(plane).unwrap(), terrain.plan);
            for extension in ["off", "obj", "ply.gz", "glb"] {
                let input = folder.path(&format!("in.{extension}"));
                let output = folder.path(&format!("out.{extension}"));
                fs::write(&input, io::to_file_bytes(&input, &mesh).unwrap()).unwrap();
                let mut arguments = vec!["--plane", plane.name(), "--constraints", list.to_str().unwrap()];
                arguments.extend(["--skip-constraints", "--verify", "--json"]);
                let ran = run(&input, &output, &arguments);
                assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
                let said: Value = serde_json::from_slice(&ran.stdout).unwrap();
                assert_eq!((&said["plane"], &said["dimension"]), (&json!(plane.name()), &json!(2)));
                assert_eq!(said["inverted"], 0);
                assert!(said["distance"].as_f64().unwrap() > 0.0);
                let written = read(&output).mesh;
                assert_eq!(bits(written.positions()), bits(mesh.positions()));
                assert_eq!(written.triangles(), expected.triangles, "{extension}, {}", plane.name());
            }
        }
    }
}

#[test]
fn the_wrong_plane_is_named() {
    let folder = Folder::new();
    let output = folder.path("out.ply");
    let terrain = Terrain::new("random 12", 1);
    for right in Plane::ALL {
        let input = folder.path("in.ply");
        fs::write(&input, io::to_bytes(Format::Ply, &terrain.in_plane(right)).unwrap()).unwrap();
        for plane in Plane::ALL {
            let said = run(&input, &output, &["--plane", plane.name()]);
            let note = format!(
                "note       in the plane {0} no triangle is turned over: --plane {0}\n",
                right.name()
            );
            assert_eq!(text(&said.stderr).contains(&note), plane != right, "{}", text(&said.stderr));
        }
    }
    // A closed surface is no terrain in any plane.
    let sphere = families::by_name("uvsphere 8").unwrap();
    assert_eq!(sphere.terrain_plane(), None);
    assert_eq!(terrain.plan.terrain_plane(), None);
    assert!(terrain.plan.plan(Plane::Xz).is_err() && terrain.plan.plan(Plane::Xy).unwrap() == terrain.plan);
}

/// From above, the polygon is a square with a notch. Along its normal, which a corner far below tilts, it crosses itself.
#[test]
fn polygons_are_cut_as_seen_from_above() {
    let mut random = Rand64::new(3);
    let folder = Folder::new();
    let outline = [[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]];
    let mut differ = 0;
    for plane in Plane::ALL {
        let [u, v] = plane.axes();
        for _ in 0..40 {
            let mut file = "OFF\n5 1 0\n".to_owned();
            for point in outline {
                let mut three = [random.rand_range(0..200); 3];
                (three[u], three[v]) = (point[0], point[1]);
                file += &format!("{} {} {}\n", three[0], three[1], three[2]);
            }
            let input = folder.file("in.off", file + "5 0 1 2 3 4\n");
            let options = ReadOptions { plane: Some(plane), ..ReadOptions::default() };
            let loaded = io::load(&input, &options).unwrap();
            assert!(loaded.crossing.is_empty());
            assert!(loaded.mesh.terrain_plane().is_some());
            let plan = loaded.mesh.plan(plane).unwrap();
            let areas: Vec<f64> =
                plan.triangles().as_chunks::<3>().0.iter().map(|t| area(&plan, t)).collect();
            assert!(areas.iter().all(|&area| area > 0.0) && areas.iter().sum::<f64>() == 20.0, "{areas:?}");
            differ += usize::from(read(&input).mesh.triangles() != loaded.mesh.triangles());
        }
    }
    assert!(differ > 10, "{differ}");
}

/// Twice the area.
fn area(plan: &Mesh, corners: &[u32; 3]) -> f64 {
    let at = |v: u32, axis: usize| plan.positions().iter().nth(2 * v as usize + axis).unwrap();
    let [a, b, c] = *corners;
    (at(b, 0) - at(a, 0)) * (at(c, 1) - at(a, 1)) - (at(b, 1) - at(a, 1)) * (at(c, 0) - at(a, 0))
}

/// A cliff has vertices one above the other. They stay apart, and its triangles are flat from above.
#[test]
fn cliffs_stay() {
    let folder = Folder::new();
    let points = "0 0 0\n2 0 0\n2 2 0\n0 2 0\n2 0 5\n2 2 5\n4 0 5\n4 2 5\n";
    let faces = "3 0 1 3\n3 1 2 3\n3 1 4 5\n3 1 5 2\n3 4 6 7\n3 4 7 5\n";
    let input = folder.file("in.off", format!("OFF\n8 6 0\n{points}{faces}"));
    let output = folder.path("out.off");
    let ran = run(&input, &output, &["--plane", "xy", "--weld", "--json", "--verify"]);
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let said: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!(
        (&said["joined_vertices"], &said["flat"], &said["inverted"]),
        (&json!(0), &json!(2), &json!(0))
    );
    assert_eq!(fs::read_to_string(&output).unwrap(), format!("OFF\n8 6 0\n{points}{faces}"));
}

#[test]
fn points_are_triangulated_in_any_plane() {
    let folder = Folder::new();
    let input = folder.file("in.xyz", "0 5 0\n0 6 4\n3 7 4\n3 8 0\n1 9 1\n");
    let output = folder.path("out.off");
    let ran = run(&input, &output, &["--plane", "xz", "--verify", "--json"]);
    assert_eq!((ran.status.code(), text(&ran.stderr)), (Some(0), ""));
    let written = read(&output).mesh;
    assert_eq!(written.terrain_plane(), Some(Plane::Xz));
    assert_eq!(written.triangle_count(), 4);
    assert_eq!(written.positions().iter().nth(13), Some(9.0));
}

#[test]
fn a_constrained_plan_gives_the_terrain_its_triangles() {
    let terrain = Terrain::new("random 10", 9);
    let surface = terrain.in_plane(Plane::Yz);
    let plan = surface.plan(Plane::Yz).unwrap();
    let made = constrained(&plan, &[[0, 99]], &[], false, 0.0, None).unwrap();
    assert_eq!(made, constrained(&terrain.plan, &[[0, 99]], &[], false, 0.0, None).unwrap());
    let carried = surface.with_triangles(made.mesh.triangles().to_vec()).unwrap();
    assert_eq!(bits(carried.positions()), bits(surface.positions()));
}
