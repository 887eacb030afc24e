//! What has to hold for the bytes of any file: it is read or refused in one line; what was read is made Delaunay, and
//! the audit is clean, also with its vertices joined; and it is written again in every format, from which the same mesh
//! is read: in its own with all else as it was. The fuzz targets call this, and so does `tests/fuzz_seeds.rs`.

use edgeflip::io::{Format, Loaded, ReadOptions, parse_edges, parse_numbers, parse_with};
use edgeflip::{Dimension, Error, Mesh, Options, make_delaunay, quality};
use std::ops::ControlFlow;

/// Bytes that a file may have, and its mesh may take.
const MAX_BYTES: u64 = 1 << 22;

/// Meshes of so many triangles are left as they were read.
const MANY: usize = 200;

/// Checks the bytes of a file as the target of that name does.
///
/// # Panics
/// If something does not hold.
pub fn check(target: &str, bytes: &[u8]) {
    let format = match target {
        "off" | "gzip" => Format::Off,
        "obj" => Format::Obj,
        "ply" => Format::Ply,
        "stl" => Format::Stl,
        "gltf" => Format::Gltf,
        "edges" => {
            drop(parse_edges(bytes).map_err(one_line));
            return drop(parse_numbers(bytes).map_err(one_line));
        }
        _ => panic!("there is no target {target}"),
    };
    for dimension in [None, Some(Dimension::Two), Some(Dimension::Three)] {
        match read(format, bytes, dimension) {
            Ok(loaded) => whole_way(&loaded, bytes),
            Err(error) => one_line(error),
        }
    }
}

/// Reads a file. Those beside it are itself, but for one that is not there.
fn read(format: Format, bytes: &[u8], dimension: Option<Dimension>) -> Result<Loaded, Error> {
    let beside = |name: &str| if name == "none" { Err("not there".into()) } else { Ok(bytes.to_vec()) };
    let options = ReadOptions { dimension, max_bytes: MAX_BYTES, ..ReadOptions::default() };
    parse_with(format, bytes, &options, &beside)
}

fn one_line(error: Error) {
    let message = error.to_string();
    assert!(!message.is_empty() && !message.contains(char::is_control), "{message:?}");
}

/// Flips, audits, and writes in every format.
fn whole_way(loaded: &Loaded, bytes: &[u8]) {
    let mesh = &loaded.mesh;
    let mut options = Options::default();
    loaded.constrain(&mut options).unwrap();
    let triangles = flipped(mesh, &options);
    joined(loaded);
    let mut reversed = triangles.clone();
    reversed.reverse();
    // A glTF primitive with other indices may share its vertices with another in another way.
    let is_gltf = loaded.placed().is_some();
    let mut rotated = triangles.clone();
    rotated.chunks_mut(3).filter(|_| !is_gltf).for_each(|triangle| triangle.rotate_left(1));
    for (name, format) in [
        ("a.off.gz", Format::Off),
        ("a.obj", Format::Obj),
        ("a.ply", Format::Ply),
        ("a.stl", Format::Stl),
        ("a.gltf", Format::Gltf),
        ("a.glb", Format::Glb),
    ] {
        // Triangles that no flips make are written or refused.
        drop(loaded.file_bytes(name, reversed.clone()).map_err(one_line));
        for triangles in [&triangles, &rotated] {
            match loaded.file_bytes(name, triangles.clone()) {
                Ok(written) => same(loaded, triangles, name, &written, bytes),
                Err(error) => {
                    let is_its_own = loaded.keeps(format) && !is_gltf;
                    assert!(!is_its_own || matches!(error, Error::FileTooLarge { .. }), "{error}");
                    one_line(error);
                }
            }
        }
    }
}

/// The triangles of a run, which the audit finds nothing in.
fn flipped(mesh: &Mesh, options: &Options) -> Vec<u32> {
    if mesh.triangle_count() >= MANY {
        return mesh.triangles().to_vec();
    }
    let outcome = make_delaunay(mesh, options, |_, _| ControlFlow::Continue(())).unwrap();
    let audit = quality::audit(mesh, &outcome.triangles, options);
    assert!(audit.is_clean(), "{:?}", audit.violations);
    assert_eq!(audit.remaining, outcome.remaining);
    outcome.triangles
}

/// Joins the vertices at one place, flips, and splits: each corner has a vertex of its place, and glTF takes it.
fn joined(loaded: &Loaded) {
    let welded = match loaded.welded() {
        Ok(welded) => welded,
        Err(error) => return one_line(error),
    };
    assert_eq!(welded.split(welded.mesh.triangles()).unwrap(), loaded.mesh.triangles());
    let mut options = Options::default();
    welded.constrain(&mut options);
    let triangles = flipped(&welded.mesh, &options);
    let split = welded.split(&triangles).unwrap();
    assert!(split.iter().zip(&triangles).all(|(&v, &place)| welded.places[v as usize] == place));
    if let Err(error) = loaded.file_bytes("a.glb", split) {
        assert!(!error.to_string().contains("of another primitive"), "{error}");
    }
}

/// Reads what was written, and compares it with the mesh.
fn same(loaded: &Loaded, triangles: &[u32], name: &str, written: &[u8], beside: &[u8]) {
    let format = Format::of(name.as_ref()).unwrap();
    let is_gltf = matches!(format, Format::Gltf | Format::Glb);
    let as_read = loaded.mesh.with_triangles(triangles.to_vec()).unwrap();
    let mesh = match loaded.placed() {
        Some(placed) if !is_gltf => Mesh::new(Dimension::Three, placed, triangles.to_vec()).unwrap(),
        _ => as_read,
    };
    // An OBJ file without a vertex is none, glTF without triangles has points, and text is read in 32 bits.
    let is_beyond = format != Format::Ply && mesh.positions().to_f32().iter().any(|x| !x.is_finite());
    if mesh.vertex_count() == 0 && format == Format::Obj || triangles.is_empty() && is_gltf || is_beyond {
        return;
    }
    let options = ReadOptions { dimension: Some(mesh.dimension()), ..ReadOptions::default() };
    let back = parse_with(format, written, &options, &|_| Ok(beside.to_vec())).unwrap();
    if !is_gltf {
        let again = back.file_bytes(name, back.mesh.triangles().to_vec()).unwrap();
        assert_eq!(again, written);
    }
    let back = back.mesh;
    if format == Format::Stl {
        assert_eq!(corners(&back), corners(&mesh));
        return;
    }
    assert_eq!(back.triangles(), mesh.triangles());
    // Digits of 64 bits may be rounded to another number than those bits.
    let digits = || mesh.positions().iter().map(|x| x.to_string().parse().unwrap()).collect::<Vec<f32>>();
    match format {
        Format::Ply => assert_eq!(back.positions(), mesh.positions()),
        Format::Off | Format::Obj => assert_eq!(back.positions().to_f32(), digits()),
        _ => assert_eq!(back.positions().to_f32(), mesh.positions().to_f32()),
    }
}

/// Where the corners of each triangle are, in 32 bits.
fn corners(mesh: &Mesh) -> Vec<Vec<f32>> {
    let (numbers, stride) = (mesh.positions().to_f32(), mesh.dimension().stride());
    mesh.triangles().iter().map(|&v| numbers[stride * v as usize..][..stride].to_vec()).collect()
}
