//! Checks what has to hold for the bytes of any file. The file is read, or refused with an error of one line. A run on
//! the mesh, and one on the welded mesh, end with a clean audit. The mesh is written in every format, and each written
//! file is read back as the same mesh. In its own format, a file also keeps everything else. The fuzz targets call
//! this, and so does `tests/native/fuzz_seeds.rs`.

use edgeflip::io::{Coordinates, Format, Loaded, ReadOptions, parse_edges, parse_numbers, parse_with};
use edgeflip::{Dimension, Error, Mesh, Options, Plane, Positions, make_delaunay, quality};
use std::ops::ControlFlow;

/// The most bytes of a file, and of its mesh.
const MAX_BYTES: u64 = 1 << 22;

/// Meshes of at least this many triangles are not flipped.
const MANY: usize = 200;

/// The check of the fuzz target with this name, on the bytes of a file.
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
        "points" => {
            return [Format::Csv, Format::Xyz].into_iter().for_each(|format| check_points(format, bytes));
        }
        "edges" => {
            drop(parse_edges(bytes).map_err(one_line));
            return drop(parse_numbers(bytes).map_err(one_line));
        }
        _ => panic!("there is no target {target}"),
    };
    for dimension in [None, Some(Dimension::Two), Some(Dimension::Three)] {
        match read(format, bytes, dimension, Vec::new()) {
            Ok(loaded) => {
                let locking = whole_way(&loaded, bytes);
                if !locking.is_empty() {
                    let loaded = read(format, bytes, dimension, locking).unwrap();
                    assert!(whole_way(&loaded, bytes).is_empty());
                }
            }
            Err(error) => one_line(error),
        }
    }
}

/// Triangulates the points of a file, and writes them as a mesh.
fn check_points(format: Format, bytes: &[u8]) {
    for dimension in [None, Some(Dimension::Two), Some(Dimension::Three)] {
        match read(format, bytes, dimension, Vec::new()) {
            Ok(mut loaded) => {
                let made = loaded.triangulate(Plane::Xy).unwrap();
                let plan = loaded.mesh.plan(Plane::Xy).unwrap();
                assert_eq!(flipped(&plan, &Options::default()), made.triangles);
                assert!(whole_way(&loaded, bytes).is_empty());
            }
            Err(error) => one_line(error),
        }
    }
}

/// Reads a file. Every other file that it names has the same bytes, except `none`, which does not exist.
fn read(
    format: Format,
    bytes: &[u8],
    dimension: Option<Dimension>,
    ignore_attributes: Vec<String>,
) -> Result<Loaded, Error> {
    let beside = |name: &str| if name == "none" { Err("not there".into()) } else { Ok(bytes.to_vec()) };
    let options =
        ReadOptions { dimension, max_bytes: MAX_BYTES, ignore_attributes, ..ReadOptions::default() };
    parse_with(format, bytes, &options, &beside)
}

fn one_line(error: Error) {
    let message = error.to_string();
    assert!(!message.is_empty() && !message.contains(char::is_control), "{message:?}");
}

/// Flips, audits, and writes in every format. Returns the attributes that lock edges.
fn whole_way(loaded: &Loaded, bytes: &[u8]) -> Vec<String> {
    let mesh = &loaded.mesh;
    let mut options = Options::default();
    let locked = loaded.constrain(&mut options).unwrap();
    assert_eq!(locked.count > 0, !locked.by_name.is_empty());
    let triangles = flipped(mesh, &options);
    joined(loaded);
    let mut reversed = triangles.clone();
    reversed.reverse();
    // Not in glTF: rotated indices may change which primitives share vertices.
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
        // No flips lead to these triangles. They are written, or refused with one line.
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
    locked.by_name.into_iter().map(|(name, _)| name).collect()
}

/// The triangles after a run; the audit must find no violation.
fn flipped(mesh: &Mesh, options: &Options) -> Vec<u32> {
    if mesh.triangle_count() >= MANY {
        return mesh.triangles().to_vec();
    }
    let outcome = make_delaunay(mesh, options, |_, _| ControlFlow::Continue(())).unwrap();
    let audit = quality::audit(mesh, &outcome.triangles, options);
    assert!(audit.violations.is_empty(), "{:?}", audit.violations);
    assert_eq!(audit.remaining, outcome.remaining);
    assert_eq!(
        [audit.inverted.len(), audit.flat.len()],
        [outcome.inverted, outcome.flat].map(|n| n as usize)
    );
    outcome.triangles
}

/// Welds the vertices, flips, and splits them again. Each corner must have a vertex at its position. glTF must accept
/// the result.
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

/// Reads the written file back, and compares its mesh with `loaded`.
fn same(loaded: &Loaded, triangles: &[u32], name: &str, written: &[u8], beside: &[u8]) {
    let format = Format::of(name.as_ref()).unwrap();
    let is_gltf = matches!(format, Format::Gltf | Format::Glb);
    let as_read = loaded.mesh.with_triangles(triangles.to_vec()).unwrap();
    let mesh = match loaded.placed() {
        Some(placed) if !is_gltf => Mesh::new(Dimension::Three, placed, triangles.to_vec()).unwrap(),
        _ => as_read,
    };
    // Not comparable: the reader refuses OBJ without vertices, a new glTF file without triangles has points, and STL and
    // glTF do not keep coordinates beyond 32-bit floats.
    let is_beyond =
        (is_gltf || format == Format::Stl) && mesh.positions().to_f32().iter().any(|x| !x.is_finite());
    if mesh.vertex_count() == 0 && format == Format::Obj || triangles.is_empty() && is_gltf || is_beyond {
        return;
    }
    let is_double = matches!(mesh.positions(), Positions::F64(_));
    let options = ReadOptions {
        dimension: Some(mesh.dimension()),
        // The digits of a double may be those of a 32-bit float.
        coordinates: Some(if is_double { Coordinates::F64 } else { Coordinates::F32 }),
        ..ReadOptions::default()
    };
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
    match format {
        Format::Off | Format::Obj | Format::Ply => assert_eq!(back.positions(), mesh.positions()),
        _ => assert_eq!(back.positions().to_f32(), mesh.positions().to_f32()),
    }
}

/// The positions of the corners of each triangle, as 32-bit floats.
fn corners(mesh: &Mesh) -> Vec<Vec<f32>> {
    let (numbers, stride) = (mesh.positions().to_f32(), mesh.dimension().stride());
    mesh.triangles().iter().map(|&v| numbers[stride * v as usize..][..stride].to_vec()).collect()
}
