//! The generated families: counts, orientation, manifoldness, repeatability.

use edgeflip::families::{self, FAMILIES, by_name};
use edgeflip::io::{Format, to_bytes};
use edgeflip::{Dimension, Error, Mesh};
use std::collections::HashMap;
use std::fmt::Write;

fn mesh(spec: &str) -> Mesh {
    by_name(spec).unwrap()
}

/// Doubled signed area in x and y, exact.
fn turn(mesh: &Mesh, triangle: &[u32]) -> f64 {
    let stride = mesh.dimension().stride();
    let at = |v: u32| {
        let mut numbers = mesh.positions().iter().skip(stride * v as usize);
        robust::Coord { x: numbers.next().unwrap(), y: numbers.next().unwrap() }
    };
    robust::orient2d(at(triangle[0]), at(triangle[1]), at(triangle[2]))
}

/// Number of boundary edges; every edge must have one half-edge in each direction at most.
fn boundary_edges(mesh: &Mesh) -> usize {
    let mut directed = HashMap::new();
    for t in mesh.triangles().chunks(3) {
        for k in 0..3 {
            *directed.entry((t[k], t[(k + 1) % 3])).or_insert(0) += 1;
        }
    }
    assert!(directed.values().all(|&count| count == 1), "not manifold");
    directed.keys().filter(|&&(u, v)| !directed.contains_key(&(v, u))).count()
}

/// What a mesh covers.
#[derive(Clone, Copy, PartialEq)]
enum Shape {
    Disc,
    Sphere,
}
use Shape::{Disc, Sphere};

/// Specifications of every family, with the shape, the vertices and the triangles of their meshes. The file of digests
/// has the same specifications, in the same order.
static WRITTEN: [(&str, Shape, usize, usize); 13] = [
    ("grid 9", Disc, 81, 128),
    ("random 12", Disc, 144, 242),
    ("random 9 5 seed=7", Disc, 81, 128),
    ("shear 9 30", Disc, 81, 128),
    ("regular 8 100000", Disc, 64, 98),
    ("strips 12", Disc, 12, 10),
    ("fan2 40", Disc, 40, 38),
    ("sweep 50", Disc, 50, 88),
    ("uvsphere 12", Sphere, 146, 288),
    ("uvsphere 9 0.9", Sphere, 83, 162),
    ("roof 5", Disc, 66, 100),
    ("pillow 5 0.01", Sphere, 7, 10),
    ("pole 30", Disc, 31, 30),
];

/// The specifications of one shape.
fn written(shape: Shape) -> impl Iterator<Item = &'static str> {
    WRITTEN.iter().filter(move |case| case.1 == shape).map(|case| case.0)
}

#[test]
fn every_family_is_tested_and_has_the_counts_it_promises() {
    for (spec, _, vertices, triangles) in WRITTEN {
        assert_eq!((mesh(spec).vertex_count(), mesh(spec).triangle_count()), (vertices, triangles), "{spec}");
    }
    for family in &FAMILIES {
        let name = family.name;
        let has_parameter = |spec: &str| spec.split(' ').nth(2).is_some_and(|word| !word.starts_with("seed"));
        let mut own = WRITTEN.iter().filter(|case| case.0.split(' ').next() == Some(name));
        assert!(
            own.any(|case| has_parameter(case.0) == family.parameter.is_some()),
            "{name} is not in `WRITTEN`"
        );
        match family.parameter {
            Some((_, default)) => {
                assert_eq!(mesh(&format!("{name} 12 {default}")), mesh(&format!("{name} 12")))
            }
            None => assert!(matches!(by_name(&format!("{name} 12 99")), Err(Error::Option { .. })), "{name}"),
        }
        assert!(families::usage().contains(&format!("{name} N")), "{name}");
    }
}

#[test]
fn counts_of_the_paper() {
    let sphere = mesh("uvsphere 600");
    assert_eq!((sphere.vertex_count(), sphere.triangle_count()), (360_002, 720_000));
    let counts = |spec| (mesh(spec).vertex_count(), mesh(spec).triangle_count());
    assert_eq!(counts("uvsphere 100"), (10_002, 20_000));
    assert_eq!(counts("strips 8"), (8, 6));
    assert_eq!(counts("random 10"), (100, 162));
    assert_eq!(counts("fan2 100"), (100, 98));
    assert_eq!(counts("roof 5"), (66, 100));
    assert_eq!(counts("pillow 5"), (7, 10));
    assert_eq!(counts("pole 50"), (51, 50));
}

#[test]
fn plane_triangles_are_positive_and_manifold() {
    for spec in [
        "grid 40",
        "random 40",
        "random 20 10",
        "shear 40",
        "shear 40 30",
        "regular 30",
        "regular 30 100000",
        "strips 30",
        "fan2 1000",
        "sweep 3000",
        "roof 9",
        "pole 500",
    ]
    .into_iter()
    .chain(written(Disc))
    {
        let mesh = mesh(spec);
        assert!(mesh.triangles().chunks(3).all(|t| turn(&mesh, t) > 0.0), "{spec}");
        let edges = (3 * mesh.triangle_count() + boundary_edges(&mesh)) / 2;
        let euler = mesh.vertex_count() as i64 - edges as i64 + mesh.triangle_count() as i64;
        assert_eq!(euler, 1, "{spec} is no disc");
    }
}

#[test]
fn closed_surfaces_are_spheres_seen_from_outside() {
    let more = ["uvsphere 3", "uvsphere 40", "uvsphere 20 0.9", "pillow 3", "pillow 9 0.01"];
    for spec in more.into_iter().chain(written(Sphere)) {
        let mesh = mesh(spec);
        assert_eq!(boundary_edges(&mesh), 0, "{spec}");
        assert_eq!(2 * mesh.vertex_count(), mesh.triangle_count() + 4, "{spec}");
        let positions = mesh.positions().to_f32();
        let at = |v: u32| &positions[3 * v as usize..3 * v as usize + 3];
        let volume: f32 = mesh
            .triangles()
            .chunks(3)
            .map(|t| {
                let [p, q, r] = [at(t[0]), at(t[1]), at(t[2])];
                p[0] * (q[1] * r[2] - q[2] * r[1])
                    + p[1] * (q[2] * r[0] - q[0] * r[2])
                    + p[2] * (q[0] * r[1] - q[1] * r[0])
            })
            .sum();
        assert!(volume > 0.0, "{spec}");
    }
}

#[test]
fn sweep_covers_the_hull() {
    // A disc whose boundary never turns right is convex, so it covers the whole hull.
    let mesh = mesh("sweep 2000");
    let mut next = HashMap::new();
    let mut seen = std::collections::HashSet::new();
    for t in mesh.triangles().chunks(3) {
        seen.extend([(t[0], t[1]), (t[1], t[2]), (t[2], t[0])]);
    }
    for &(u, v) in seen.iter().filter(|&&(u, v)| !seen.contains(&(v, u))) {
        next.insert(u, v);
    }
    for (&u, &v) in &next {
        assert!(turn(&mesh, &[u, v, next[&v]]) >= 0.0);
    }
}

#[test]
fn same_seed_same_bits() {
    for name in FAMILIES.iter().map(|family| family.name) {
        assert_eq!(mesh(&format!("{name} 12")), mesh(&format!("{name} 12 seed=1")), "{name}");
    }
    assert_ne!(mesh("random 12"), mesh("random 12 seed=2"));
    assert_eq!(mesh("shear 9 30"), families::shear(9, 30.0, families::DEFAULT_SEED).unwrap());
    assert_eq!(mesh("grid 9").dimension(), Dimension::Two);
    assert_eq!(mesh("roof 9").dimension(), Dimension::Three);
}

#[test]
fn wrong_specifications_are_refused() {
    for spec in [
        "",
        "grid",
        "gird 5",
        "grid x",
        "grid 5 1",
        "random 5 nan",
        "grid 1",
        "strips 7",
        "grid 5 seed=a",
        "sweep 9 9",
    ] {
        assert!(matches!(by_name(spec), Err(Error::Option { option: "family", .. })), "{spec:?}");
    }
    assert!(by_name("sphere 5").unwrap_err().to_string().contains("uvsphere N"));
    assert!(matches!(by_name("grid 100000"), Err(Error::TooLarge { .. })));
}

/// FNV-1a, 64 bits.
fn digest(bytes: &[u8]) -> u64 {
    bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// `tests/package/files.test.mjs` compares with the same digests. `EDGEFLIP_BLESS=1 cargo test --test native -- families::`
/// writes them.
#[test]
fn files_are_those_of_the_npm_package() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/package/generated.txt");
    let mut text = String::from("# FNV-1a of the OFF file, of the OBJ file, specification\n");
    for (spec, ..) in WRITTEN {
        let [off, obj] =
            [Format::Off, Format::Obj].map(|format| digest(&to_bytes(format, &mesh(spec)).unwrap()));
        writeln!(text, "{off:016x} {obj:016x} {spec}").unwrap();
    }
    if std::env::var_os("EDGEFLIP_BLESS").is_some() {
        std::fs::write(path, &text).unwrap();
    }
    assert_eq!(std::fs::read_to_string(path).unwrap(), text);
}
