//! Polygons and numbers are those that the file shows.

use crate::command::{Folder, run, text};
use edgeflip::io::{Coordinates, ReadOptions, read};
use edgeflip::quality::audit;
use edgeflip::{Dimension, Options, Reason};
use oorandom::Rand64;
use serde_json::{Map, Value};
use std::fs;

#[test]
fn polygons_are_cut_as_they_are_or_named() {
    let folder = Folder::new();
    // A prism of two L-shaped hexagons: area 46, volume 11.
    let prism = "v 6 0 0\nv 6 1 0\nv 1 1 0\nv 1 6 0\nv 0 6 0\nv 0 0 0\n\
        v 6 0 1\nv 6 1 1\nv 1 1 1\nv 1 6 1\nv 0 6 1\nv 0 0 1\n\
        f 7 8 9 10 11 12\nf 6 5 4 3 2 1\n\
        f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
    let (input, output) = (folder.file("in.obj", prism), folder.path("out.obj"));
    let said = text(&run(&input, &output, &["--verify"]).stderr).to_owned();
    for line in ["area       46.0000 → 46.0000", "volume     11.0000 → 11.0000", "audit      clean"] {
        assert!(said.contains(line), "{said}");
    }
    // The first face is a triangle, the second a bow tie.
    let bow = folder.file("bow.off", "OFF 5 2 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n3 1 0\n3 1 4 2\n4 0 2 1 3\n");
    let said = text(&run(&bow, &output, &[]).stderr).to_owned();
    let note = "note       polygons cut into fans although their outline crosses or touches itself, the first face is \
        0: 1\n";
    assert!(said.contains(note), "{said}");
    let found: Value = serde_json::from_slice(&run(&bow, &output, &["--json"]).stdout).unwrap();
    assert_eq!((&found["crossing_polygons"], &found["triangles"]), (&vec![1].into(), &3.into()));
}

#[test]
fn the_option_chooses_the_bits() {
    let folder = Folder::new();
    let input = folder.file("in.off", "OFF\n3 1 0\n0 0 0\n4649776.51 0 0\n0 1 0\n3 0 1 2\n");
    for (arguments, name, bits) in [
        (&[][..], "out.off", 64),
        (&[], "out.ply", 64),
        // They hold nothing but 32-bit floats.
        (&[], "out.stl", 32),
        (&[], "out.glb", 32),
        (&["--coordinates", "auto"], "out.obj", 64),
        (&["--coordinates", "64"], "out.stl", 64),
        (&["--coordinates", "32"], "out.off", 32),
    ] {
        let output = folder.path(name);
        let arguments = [arguments, &["--json"]].concat();
        let found: Value = serde_json::from_slice(&run(&input, &output, &arguments).stdout).unwrap();
        assert_eq!(found["coordinates"], bits, "{name} {arguments:?}");
    }
    let said = text(&run(&input, &folder.path("out.off"), &[]).stderr).to_owned();
    assert!(said.contains("3 vertices, 1 triangles, 2D, 64-bit coordinates\n"), "{said}");
}

/// A grid of 5 × 5 vertices that were moved, with random diagonals.
struct Written {
    tokens: Vec<[String; 3]>,
    triangles: Vec<[usize; 3]>,
}

impl Written {
    fn new(random: &mut Rand64) -> Self {
        let offset = [0.0, 0.0, 500_000.0, 4_649_776.0][random.rand_range(0..4) as usize];
        let (is_flat, singles) = (random.rand_float() < 0.5, random.rand_range(0..3));
        let (digits, scale) =
            (random.rand_range(3..18) as usize, [1.0, 1.0, 1e-3][random.rand_range(0..3) as usize]);
        let is_scientific = random.rand_float() < 0.5;
        let token = |x: f64, random: &mut Rand64| {
            let x = scale * (offset + x + 0.35 * random.rand_float());
            let x = match singles {
                0 => f64::from(x as f32),
                1 => x,
                _ => [x, f64::from(x as f32)][random.rand_range(0..2) as usize],
            };
            if is_scientific { format!("{x:.digits$e}") } else { format!("{x}") }
        };
        let tokens = (0..25).map(|i| {
            let [x, y] = [i % 5, i / 5].map(|at| token(at.into(), random));
            [x, y, if is_flat { "0".to_owned() } else { token(0.0, random) }]
        });
        let tokens = tokens.collect();
        let squares = (0..16).map(|i| 5 * (i / 4) + i % 4).flat_map(|a| {
            let [b, c, d] = [a + 1, a + 6, a + 5];
            if random.rand_float() < 0.5 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
        });
        Self { tokens, triangles: squares.collect() }
    }

    fn text(&self, extension: &str) -> String {
        let vertices = |before: &str| -> String {
            self.tokens.iter().map(|vertex| format!("{before}{}\n", vertex.join(" "))).collect()
        };
        let faces = |before: &str, first: usize| -> String {
            let face =
                |[a, b, c]: &[usize; 3]| format!("{before} {} {} {}\n", a + first, b + first, c + first);
            self.triangles.iter().map(face).collect()
        };
        match extension {
            "off" => format!("OFF 25 32 0\n{}{}", vertices(""), faces("3", 0)),
            "obj" => vertices("v ") + &faces("f", 1),
            "ply" => format!(
                "ply\nformat ascii 1.0\nelement vertex 25\nproperty float x\nproperty float y\nproperty float z\n\
                 element face 32\nproperty list uchar int vertex_indices\nend_header\n{}{}",
                vertices(""),
                faces("3", 0)
            ),
            _ => {
                let facet = |corners: &[usize; 3]| {
                    let corners = corners.map(|v| format!("vertex {}\n", self.tokens[v].join(" ")));
                    format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", corners.concat())
                };
                format!("solid\n{}endsolid\n", self.triangles.iter().map(facet).collect::<String>())
            }
        }
    }
}

/// The coordinates of the vertices of a written text file.
fn coordinates(written: &str, extension: &str, vertices: usize) -> Vec<String> {
    let lines = match extension {
        "obj" => written.lines().filter_map(|line| line.strip_prefix("v ")).collect::<Vec<_>>().join(" "),
        "ply" => written.split_once("end_header").unwrap().1.to_owned(),
        // The keyword, and three numbers.
        _ => written.split_whitespace().skip(4).collect::<Vec<_>>().join(" "),
    };
    lines.split_whitespace().take(3 * vertices).map(str::to_owned).collect()
}

/// The written file, read with the bits that `--json` names, has the edges left that the run reported; and where these
/// are 32, its digits are those of 32-bit floats.
#[test]
fn written_text_shows_what_was_decided() {
    let folder = Folder::new();
    let mut random = Rand64::new(49);
    let mut counts = [0; 2];
    for n in 0..1000 {
        let extension = ["off", "obj", "ply", "stl"][n % 4];
        let to = if random.rand_float() < 0.5 { extension } else { ["off", "obj", "ply", "stl"][n / 4 % 4] };
        let input = folder.file(&format!("in.{extension}"), Written::new(&mut random).text(extension));
        let output = folder.path(&format!("out.{to}"));
        let ran = run(&input, &output, &["--json"]);
        assert_eq!(ran.status.code(), Some(0), "{}", text(&ran.stderr));
        let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
        let is_double = found["coordinates"] == 64;
        counts[usize::from(is_double)] += 1;
        let options = ReadOptions {
            coordinates: Some(if is_double { Coordinates::F64 } else { Coordinates::F32 }),
            dimension: Some(if found["dimension"] == 2 { Dimension::Two } else { Dimension::Three }),
            ..ReadOptions::default()
        };
        let mesh = read(&output, &options).unwrap();
        let left = audit(&mesh, mesh.triangles(), &Options::default()).remaining;
        let left: Map<String, Value> = Reason::ALL
            .into_iter()
            .filter(|&reason| left[reason] > 0)
            .map(|reason| (reason.name().to_owned(), left[reason].into()))
            .collect();
        assert_eq!(Value::Object(left), found["remaining"], "{n}: {}", fs::read_to_string(&input).unwrap());
        if is_double || to == "stl" || (to == "ply" && extension != "ply") {
            continue;
        }
        let shown = coordinates(&fs::read_to_string(&output).unwrap(), to, mesh.vertex_count());
        assert_eq!(shown.len(), 3 * mesh.vertex_count());
        for token in shown {
            let (value, single): (f64, f32) = (token.parse().unwrap(), token.parse().unwrap());
            let is_shown = |digits: usize| format!("{single:.digits$e}").parse() == Ok(value);
            assert!((0..17).any(is_shown), "{n}: {token}");
        }
    }
    assert!(counts.into_iter().all(|count| count > 200), "{counts:?}");
}
