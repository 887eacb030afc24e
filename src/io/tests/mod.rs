//! Tests of the parsers and writers: what they read and refuse, with which message, and that nothing is lost.

mod coordinates;
mod gzip;
mod ignored;
mod original;
#[cfg(feature = "threads")]
mod pieces;
mod ply;
mod points;
mod polygon;
mod stl;

use super::*;
use crate::{Dimension, Error, Mesh, Options, Plane, Positions};
use proptest::prelude::*;
use std::path::Path;

/// The text formats whose triangles share vertices.
const INDEXED: [Format; 3] = [Format::Off, Format::Obj, Format::Ply];
const ALL: [Format; 4] = [Format::Off, Format::Obj, Format::Ply, Format::Stl];

fn parsed(format: Format, bytes: impl AsRef<[u8]>) -> Result<Loaded, Error> {
    parse(format, bytes.as_ref(), &ReadOptions::default())
}

fn off(text: impl AsRef<[u8]>) -> Result<Loaded, Error> {
    parsed(Format::Off, text)
}

fn obj(text: impl AsRef<[u8]>) -> Result<Loaded, Error> {
    parsed(Format::Obj, text)
}

fn in_dimension(format: Format, bytes: impl AsRef<[u8]>, dimension: Dimension) -> Result<Loaded, Error> {
    parse(format, bytes.as_ref(), &ReadOptions { dimension: Some(dimension), ..ReadOptions::default() })
}

#[track_caller]
fn refused(result: Result<Loaded, Error>, message: &str) {
    let found = result.unwrap_err().to_string();
    assert_eq!(found, message);
    assert!(!found.contains('\n'));
}

#[track_caller]
fn mesh(result: Result<Loaded, Error>, dimension: Dimension, positions: &[f32], triangles: &[u32]) -> Loaded {
    let loaded = result.unwrap();
    let bits = |x: &[f32]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&loaded.mesh.positions().to_f32()), bits(positions));
    assert_eq!(loaded.mesh.triangles(), triangles);
    assert_eq!(loaded.mesh.dimension(), dimension);
    loaded
}

use Dimension::{Three, Two};

#[test]
fn every_common_form_of_off_is_read() {
    let flat = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0];
    for text in [
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF 3 1 3\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2",
        "OFF3 1 0\r0 0 0\r1 0 0\r0 1 0\r3 0 1 2\r",
        "\u{feff}# c\n\n OFF # OFF\n#\n3 1\n\n0 0 0 # origin\n +1 .0 -0\n\t0\t1.\t0e9 \n# f\n3 0 1 2 # end\n\n#",
        "nOFF 2\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2",
        "nOFF\n2\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2",
        "2OFF\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2",
    ] {
        let loaded = mesh(off(text), Two, &flat, &[0, 1, 2]);
        assert_eq!((loaded.polygons, loaded.dropped.len()), (0, 0), "{text}");
    }
    let raised = [0.0, 0.0, 1e-45, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    for text in [
        "COFF\n3 1 0\n0 0 1e-45 255 0 0 255\n1 0 0 0.5 0.5 0.5 1\n0 1 0 1 1 1 1\n3 0 1 2 255 0 0\n",
        "STCNOFF\n3 1 0\n0 0 1e-45 nan nan nan 0 0 0 1 0 0\n1 0 0 0 0 1\n0 1 0\n3 0 1 2 7\n",
    ] {
        let loaded = mesh(off(text), Three, &raised, &[0, 1, 2]);
        assert_eq!(loaded.dropped.len(), 2);
    }
    mesh(off("OFF 0 0 0"), Two, &[], &[]);
}

#[test]
fn polygons_become_fans() {
    let text =
        "OFF 6 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n9 9 0\n2 2 0\n4 0 1 2 3 0.1 0.2 0.3\n3 0 1 2\n5 5 0 1 2 3\n";
    let flat = [0., 0., 1., 0., 1., 1., 0., 1., 9., 9., 2., 2.];
    let triangles = [0, 1, 2, 0, 2, 3, 0, 1, 2, 5, 0, 1, 5, 1, 2, 5, 2, 3];
    assert_eq!(mesh(off(text), Two, &flat, &triangles).polygons, 2);
}

#[test]
fn off_refused_with_its_line() {
    let tail = "OFF 3 1 0\n0 0 0\n1 0 0\n";
    for (text, message) in [
        ("", "line 1: the file is empty"),
        (" \n\t\n", "line 1: the file is empty"),
        ("# nothing\n", "line 1: the file ends before the keyword OFF"),
        ("ply\nformat ascii 1.0\n", "line 1: expected the keyword OFF of an OFF file, found `ply`"),
        ("OFF\n", "line 1: the file ends before the numbers of vertices and faces"),
        ("OFF BINARY\n", "line 1: binary OFF is not supported, only text"),
        ("4OFF\n", "line 1: vertices with four coordinates (4OFF) are not supported"),
        ("nOFF 5\n", "line 1: an nOFF file must have 2 or 3 dimensions"),
        ("nOFF", "line 1: the file ends before the number of dimensions"),
        ("OFF\n3\n", "line 2: expected the numbers of vertices, faces and edges, found 1 words"),
        ("OFF\n-3 1 0\n", "line 2: expected a number of vertices, faces or edges, found `-3`"),
        ("OFF\n3 1.0 0\n", "line 2: expected a number of vertices, faces or edges, found `1.0`"),
        ("OFF\n4000000000 1 0\n0 0 0\n", "line 3: the file ends after 1 of 4000000000 vertices"),
        ("OFF 0 4294967295\n", "line 1: the file ends after 0 of 4294967295 faces"),
        (
            "OFF 99999999999999999999999 99999999999999999999999 0\n",
            "line 1: the file ends after 0 of 9223372036854775807 vertices",
        ),
        ("OFF 3 1 0\n0 0 0\n1 0\n", "line 3: expected 3 coordinates, found 2"),
        ("OFF 1 0\n0 x 0\n", "line 2: expected a number, found `x`"),
        ("OFF 1 0\n0 0 0 x\n", "line 2: expected a number, found `x`"),
        ("OFF 1 0\n0 1,5 0\n", "line 2: expected a number, found `1,5`"),
        ("OFF 1 0\n0 nan 0\n", "line 2: `nan` is not a finite number"),
        ("OFF 1 0\n0 -inf 0\n", "line 2: `-inf` is not a finite number"),
        ("OFF 1 0\n0 0 1e999\n", "line 2: `1e999` is not a finite number"),
        ("OFF 1 0\n0 0 0\nmore\n", "line 3: expected the end of the file after 0 faces, found `more`"),
    ] {
        refused(off(text), message);
    }
    for (line, message) in [
        ("", "line 4: the file ends after 0 of 1 faces"),
        ("x 0 1 2", "line 5: expected a face's number of corners, found `x`"),
        ("2 0 1", "line 5: a face with 2 corners, but a face needs at least 3"),
        ("-1", "line 5: a face with -1 corners, but a face needs at least 3"),
        ("3 0 1", "line 5: expected 3 vertex indices, found 2"),
        ("9223372036854775807 0 1", "line 5: expected 9223372036854775807 vertex indices, found 2"),
        ("3 0 1 3", "line 5: vertex index `3` is out of range, the mesh has 3 vertices"),
        ("3 0 1 -1", "line 5: vertex index `-1` is out of range, the mesh has 3 vertices"),
        ("3 0 1 4294967297", "line 5: vertex index `4294967297` is out of range, the mesh has 3 vertices"),
        ("3 0 1 2.0", "line 5: expected a vertex index, found `2.0`"),
        ("3 0 1 2 red", "line 5: expected a number, found `red`"),
    ] {
        refused(off(format!("{tail}0 1 0\n{line}")), message);
    }
    refused(off(b"OFF 1 0\n0 \xff\xfe 0\n"), r"line 2: expected a number, found `\xff\xfe`");
    refused(
        off([0x7f; 100]),
        &format!("line 1: expected the keyword OFF of an OFF file, found `{}…`", r"\x7f".repeat(32)),
    );
}

#[test]
fn obj_with_everything_that_exporters_write() {
    let text = b"\xef\xbb\xbf# an exporter \xe9 \\\n\
        mtllib C:\\materials\\stone.mtl\n\
        o first\nv 0 0 0\nv 1 0 0.5 1.0\nvt 0.1 0.2\nvn 0 0 1\n\
        v 1 1 0 0.9 0.8 0.7\r\n\
        g a b\nusemtl Stone#25\ns off\n\
        f 1/1/1 2/1/1 3/1/1\n\
        o second\n\
        v 0 1 -0\n\
        \x20 v  5 5 5 # of no face\n\
        f -5//1 \\\n  -3/1 \\\r\n  -2\n\
        f 6 1 2 3\n\
        v 7 7 7\n\
        l 1 2\np 1\nlod 3\ncstype bezier\n\
        f 1/ 2// 4";
    let loaded = mesh(
        obj(text),
        Three,
        &[0., 0., 0., 1., 0., 0.5, 1., 1., 0., 0., 1., -0., 5., 5., 5., 7., 7., 7.],
        &[0, 1, 2, 0, 2, 3, 5, 0, 1, 5, 1, 2, 0, 1, 3],
    );
    assert_eq!(loaded.polygons, 1);
    assert_eq!(
        loaded.dropped,
        [
            "groups, objects and materials",
            "vertex weights and colours",
            "texture coordinates",
            "normals",
            "points and lines",
            "display attributes",
            "free-form curves and surfaces",
        ]
    );
}

#[test]
fn obj_refused_with_its_line() {
    for (text, message) in [
        ("", "line 1: the file is empty"),
        ("# nothing\n\n", "line 2: the file ends without a vertex (v) line"),
        ("o a\nhello\n", "line 2: expected a keyword of an OBJ file, found `hello`"),
        ("v 0 0\n", "line 1: expected 3 coordinates, found 2"),
        ("v 0 0 z\n", "line 1: expected a number, found `z`"),
        ("v 0 0 0 z\n", "line 1: expected a number, found `z`"),
        ("v 0 0 NaN\n", "line 1: `NaN` is not a finite number"),
        ("v 0 0 -1e999\n", "line 1: `-1e999` is not a finite number"),
        ("v 0 0 0\nf 1 1\n", "line 2: a face with 2 corners, but a face needs at least 3"),
        ("v 0 0 0\nf\n", "line 2: a face with 0 corners, but a face needs at least 3"),
        ("v 0 0 0\nf 1 1 0\n", "line 2: vertex index 0 is out of range, OBJ counts from 1"),
        (
            "v 0 0 0\nf 1 1 -2\nv 0 0 0",
            "line 2: vertex index `-2` is out of range, there are 1 vertices so far",
        ),
        (
            "v 0 0 0\nf 1 1 2\nf 1 3 1\nv 0 0 0",
            "line 3: vertex index `3` is out of range, the mesh has 2 vertices",
        ),
        (
            "v 0 0 0\nf 1 \\\n 1 \\\n 99999999999999999999\n",
            "line 2: vertex index `99999999999999999999` is out of range, the mesh has 1 vertices",
        ),
        (
            "v 0 0 0\nf 1 1 -99999999999999999999\n",
            "line 2: vertex index `-99999999999999999999` is out of range, there are 1 vertices so far",
        ),
        ("v 0 0 0\nf 1 1 a\n", "line 2: expected a corner such as 1, 1/2, 1//3 or 1/2/3, found `a`"),
        ("v 0 0 0\nf 1 1 1/x\n", "line 2: expected a corner such as 1, 1/2, 1//3 or 1/2/3, found `1/x`"),
        (
            "v 0 0 0\nf 1 1 1/1/1/1\n",
            "line 2: expected a corner such as 1, 1/2, 1//3 or 1/2/3, found `1/1/1/1`",
        ),
        ("f 1 2 3\n", "line 1: the file ends without a vertex (v) line"),
    ] {
        refused(obj(text), message);
    }
    refused(obj(b"v 0 0 \x80\n"), r"line 1: expected a number, found `\x80`");
}

#[test]
fn the_requested_dimension_is_used() {
    let flat = "OFF 2 0\n0 0 0\n1 2 -0\n";
    let raised = "OFF 2 0\n0 0 0\n1 2 0.25\n";
    mesh(off(flat), Two, &[0., 0., 1., 2.], &[]);
    mesh(off(raised), Three, &[0., 0., 0., 1., 2., 0.25], &[]);
    let forced = |text, dimension| in_dimension(Format::Off, text, dimension);
    mesh(forced(flat, Three), Three, &[0., 0., 0., 1., 2., -0.], &[]);
    mesh(forced("2OFF 1 0\n1 2", Three), Three, &[1., 2., 0.], &[]);
    refused(
        forced(raised, Two),
        "vertex 1: z is 0.25, but every z must be 0 in the 2D mesh that was requested; a terrain needs plane",
    );
}

#[test]
fn numbers_are_rounded_once() {
    // Slightly more than halfway between 1 and the next f32: rounds up. Rounded to f64 first, it would round down.
    let text = "OFF 1 0\n1.000000059604644775390625000000000001 0 0\n";
    let narrow = ReadOptions { coordinates: Some(Coordinates::F32), ..ReadOptions::default() };
    mesh(parse(Format::Off, text.as_bytes(), &narrow), Two, &[f32::from_bits(0x3f80_0001), 0.0], &[]);
}

#[test]
fn written_with_the_fewest_digits() {
    let mesh = Mesh::new(Two, vec![0.0f32, -0.0, 1.0, 0.1, 1e-45, -1e30], vec![0, 1, 2]).unwrap();
    let text = |format| String::from_utf8(to_bytes(format, &mesh).unwrap()).unwrap();
    assert_eq!(text(Format::Off), "OFF\n3 1 0\n0 -0 0\n1 0.1 0\n1e-45 -1e+30 0\n3 0 1 2\n");
    assert_eq!(text(Format::Obj), "v 0 -0 0\nv 1 0.1 0\nv 1e-45 -1e+30 0\nf 1 2 3\n");
}

#[test]
fn formats_by_extension() {
    assert_eq!(Format::of(Path::new("a/b.OFF")).unwrap(), Format::Off);
    assert_eq!(Format::of(Path::new("b.x.obj")).unwrap(), Format::Obj);
    assert_eq!(Format::of(Path::new("b.Ply.GZ")).unwrap(), Format::Ply);
    assert_eq!(Format::of(Path::new(".stl.stl")).unwrap(), Format::Stl);
    assert_eq!(Format::of(Path::new("a.csv")).unwrap(), Format::Csv);
    for name in ["off", "a.gz", ".gz", "a.off.gz.gz", ""] {
        let found = Format::of(Path::new(name));
        let message = format!(
            "{name}: unknown format; use one of: .off, .obj, .ply, .stl, .gltf, .glb, .csv, .xyz, also gzip'd (.gz)"
        );
        assert_eq!(found.unwrap_err().to_string(), message);
    }
}

#[cfg(not(target_arch = "wasm32"))]
#[test]
fn a_target_is_replaced_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.off");
    let mesh = Mesh::new(Three, vec![0.0, 0.5, 1.0], vec![]).unwrap();
    write(&path, &mesh).unwrap();
    assert_eq!(read(&path, &ReadOptions::default()).unwrap(), mesh);
    #[cfg(unix)]
    {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let link = folder.path().join("link.off");
        symlink("a.off", &link).unwrap();
        std::fs::set_permissions(&path, PermissionsExt::from_mode(0o640)).unwrap();
        write(&link, &mesh).unwrap();
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        std::fs::remove_file(&link).unwrap();
    }
    std::fs::create_dir(folder.path().join("folder.off")).unwrap();
    assert!(matches!(write(folder.path().join("folder.off"), &mesh), Err(Error::Io { .. })));
    assert!(matches!(write(folder.path().join("none/a.off"), &mesh), Err(Error::Io { .. })));
    assert!(matches!(read(folder.path().join("none.off"), &ReadOptions::default()), Err(Error::Io { .. })));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
}

/// A finite f32, with equally likely bit patterns.
fn coordinate() -> impl Strategy<Value = f32> {
    any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |x| x.is_finite())
}

/// Text that is almost a file: its words in random order.
fn words() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "OFF",
        "nOFF",
        "STCOFF",
        "v",
        "f",
        "vt",
        "#",
        "\\",
        "\n",
        "\r\n",
        "\r",
        "0",
        "1",
        "2",
        "3",
        "4",
        "-1",
        "1/2/3",
        "//",
        "1e38",
        "nan",
        "4294967295",
        "9223372036854775808",
        "format ascii 1.0",
        "element vertex 3",
        "element face",
        "property list int int vertex_index",
        "property float x",
        "property double y",
        "end_header",
        "facet normal 0 0 1 outer loop",
        "vertex",
        "endloop endfacet",
        "endsolid",
        "\u{feff}",
        "é",
    ]);
    prop::collection::vec((word, prop::sample::select(vec![" ", "", "\n"])), 0..60)
        .prop_map(|words| words.into_iter().flat_map(|(word, gap)| [word, gap]).collect())
}

proptest! {
    #[test]
    fn every_bit_comes_back(
        positions in prop::collection::vec([coordinate(), coordinate(), coordinate()], 1..40),
        triangles in prop::collection::vec(any::<[u32; 3]>(), 0..40),
        flat in any::<bool>(),
    ) {
        let vertices = positions.len() as u32;
        let triangles: Vec<u32> = triangles.as_flattened().iter().map(|v| v % vertices).collect();
        let dimension = if flat { Two } else { Three };
        let positions: Vec<f32> =
            positions.iter().flat_map(|p| &p[..dimension.stride()]).copied().collect();
        let mesh = Mesh::new(dimension, positions, triangles).unwrap();
        for format in INDEXED {
            let bytes = to_bytes(format, &mesh).unwrap();
            let loaded = in_dimension(format, &bytes, dimension).unwrap();
            prop_assert_eq!(loaded.mesh.triangles(), mesh.triangles());
            let bits = |mesh: &Mesh| mesh.positions().iter().map(f64::to_bits).collect::<Vec<_>>();
            prop_assert_eq!(bits(&loaded.mesh), bits(&mesh));
            prop_assert_eq!(to_bytes(format, &loaded.mesh).unwrap(), bytes);
        }
    }

    #[test]
    fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..300), format in prop::sample::select(ALL.to_vec())) {
        for head in [
            b"".as_slice(),
            b"OFF 2 2 0\n",
            b"v 0 0 0\nf ",
            b"ply\nformat ",
            b"solid\nfacet ",
            &[0; 80],
            b"\x1f\x8b\x08\x00\x00\x00\x00\x00\x00\xff",
            ply::HEAD.replace("ascii", "binary_little_endian").as_bytes(),
            ply::HEAD.replace("ascii", "binary_big_endian").as_bytes(),
        ] {
            let _ = parsed(format, [head, &bytes].concat());
        }
    }

    #[test]
    fn no_words_panic(text in words(), format in prop::sample::select(ALL.to_vec())) {
        for head in ["", "ply\n", ply::HEAD, "solid"] {
            if let Err(e) = parsed(format, [head, &text].concat()) {
                prop_assert!(!e.to_string().chars().any(char::is_control));
            }
        }
    }

    #[test]
    fn no_cut_or_changed_byte_panics(at in 0_usize..300, byte in any::<u8>(), cut in any::<bool>()) {
        let mesh = Mesh::new(Three, vec![0.5; 12], vec![0, 1, 2, 1, 2, 3]).unwrap();
        for format in ALL {
            let mut bytes = to_bytes(format, &mesh).unwrap();
            if let Some(b) = bytes.get_mut(at) {
                *b = byte;
            }
            if cut {
                bytes.truncate(at);
            }
            let _ = parsed(format, bytes);
        }
    }
}

#[test]
fn text_may_be_utf_16() {
    let text = "OFF # Kürzel 𝄞\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for bytes in [u16::to_be_bytes, u16::to_le_bytes] {
        let file: Vec<u8> = std::iter::once(0xfeff).chain(text.encode_utf16()).flat_map(bytes).collect();
        assert_eq!(off(file).unwrap().mesh.triangles(), [0, 1, 2]);
    }
}
