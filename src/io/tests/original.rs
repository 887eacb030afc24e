//! Held files, written again with other triangles and otherwise unchanged.

use super::*;
use crate::{make_delaunay, reoriented};
use flate2::read::GzDecoder;
use std::io::Read;
use std::ops::ControlFlow;

/// A square whose corner 1 is moved inwards: the diagonal 1-3 is Delaunay, 0-2 is not.
///
/// ```text
///   3-----2
///   |   //
///   | /  1
///   0 -'
/// ```
pub(super) const SQUARE: [&str; 4] = ["0 0 0", "0.9000000001 0.2 0", "1 1 0", "0 1 0"];
/// The triangles after the flip of 0-2 in 0 1 2, 0 2 3, as the engines write them.
pub(super) const FLIPPED: [u32; 6] = [3, 1, 2, 0, 1, 3];

/// Makes the mesh of a file Delaunay, with locks for its attributes. Returns the number of locked edges, and the file
/// written in the same format.
fn run(format: Format, bytes: impl AsRef<[u8]>) -> (usize, Vec<u32>, Vec<u8>) {
    let loaded = parsed(format, bytes).unwrap();
    let mut options = Options { backend: crate::Backend::Cpu, ..Options::default() };
    let locked = loaded.constrain(&mut options).unwrap().count;
    let outcome = make_delaunay(&loaded.mesh, &options, |_, _| ControlFlow::Continue(())).unwrap();
    let written = loaded.file_bytes(named(format), outcome.triangles.clone()).unwrap();
    let back = in_dimension(format, &written, loaded.mesh.dimension()).unwrap();
    if format != Format::Stl {
        assert_eq!(back.mesh, loaded.mesh.with_triangles(outcome.triangles.clone()).unwrap());
    }
    (locked, outcome.triangles, written)
}

pub(super) fn named(format: Format) -> &'static str {
    match format {
        Format::Off => "a.off",
        Format::Obj => "a.obj",
        Format::Ply => "a.ply",
        _ => "a.stl",
    }
}

pub(super) fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap()
}

/// An OBJ file of [`SQUARE`], followed by these lines.
pub(super) fn square_obj(rest: &str) -> String {
    SQUARE.map(|point| format!("v {point}\n")).concat() + rest
}

/// A PLY file as text: vertices with a colour, and faces with these additional properties.
pub(super) fn square_ply(properties: &str, faces: &str) -> String {
    let points = SQUARE.map(|point| format!("{point} 7\n")).concat();
    let count = faces.lines().count();
    format!(
        "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\nproperty float y\n\
         property float z\nproperty uchar red\nelement face {count}\n{properties}end_header\n{points}{faces}"
    )
}

#[test]
fn without_a_flip_a_file_stays_as_it_is() {
    let obj = square_obj(
        "# c \\\nmtllib a b.mtl\no x\nvt 1 2\nvn 0 0 1\n f  1/1 2//1 3 4/1/1 # quad\nl 1 2\nf -1 \\\n -2 -3",
    );
    let off = format!("COFF # c\n\n4 1 5 \n{} 9\n\n 4 0 1 2 3  .5 # f\n", SQUARE.join(" 1 0 0\n"));
    let ply = square_ply("property list uchar int vertex_index\nproperty uchar blue\n", "4 0 1 2 3 7\n");
    let utf_16 = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 # é\n";
    let mut stl = vec![b' '; 80];
    stl.extend(1u32.to_le_bytes());
    stl.extend((0..12).flat_map(|i| (i as f32).to_le_bytes()));
    stl.extend([0xab, 0xcd]);
    for (format, file) in [(Format::Obj, obj), (Format::Off, off), (Format::Ply, ply)] {
        for file in [file.clone(), file.replace('\n', "\r\n"), file.replace('\n', "\r")] {
            unchanged(format, file.as_bytes(), file.as_bytes());
        }
    }
    unchanged(Format::Stl, &stl, &stl);
    let words: Vec<u8> = format!("\u{feff}{utf_16}").encode_utf16().flat_map(u16::to_be_bytes).collect();
    unchanged(Format::Obj, &words, utf_16.as_bytes());
}

#[track_caller]
fn unchanged(format: Format, file: &[u8], expected: &[u8]) {
    let loaded = parsed(format, file).unwrap();
    assert!(loaded.keeps(format) && loaded.dropped_in(format).is_empty());
    let triangles = loaded.mesh.triangles().to_vec();
    assert_eq!(loaded.file_bytes(named(format), triangles.clone()).unwrap(), expected);
    let packed = loaded.file_bytes(format!("{}.gz", named(format)), triangles.clone()).unwrap();
    let mut bytes = Vec::new();
    GzDecoder::new(packed.as_slice()).read_to_end(&mut bytes).unwrap();
    assert_eq!(bytes, expected);
    // A file that is not held, or is written in another format, keeps only the mesh.
    let options = ReadOptions { keep: false, ..ReadOptions::default() };
    let bare = parse(format, file, &options).unwrap();
    assert!(!bare.keeps(format));
    assert_eq!((bare.dropped_in(format), &bare.mesh), (bare.dropped.as_slice(), &loaded.mesh));
    for (loaded, format) in
        [(&bare, format), (&loaded, if format == Format::Off { Format::Obj } else { Format::Off })]
    {
        let written = loaded.file_bytes(named(format), triangles.clone()).unwrap();
        assert_eq!(written, to_bytes(format, &loaded.mesh).unwrap());
    }
}

#[test]
fn only_the_faces_of_an_obj_file_change() {
    let file = square_obj(
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nv 5 5 5\nv 6 5 5\nv 6 6 5\nv 5 6 5\n\
        usemtl a # 1\n  f 1/1/1 2/2/1 \\\n 3/3/1 4/4/1 # 2\nf -4 -3 -2 -1\nf 5 8 1",
    );
    let (locked, triangles, written) = run(Format::Obj, &file);
    assert_eq!((locked, &triangles[..6]), (0, FLIPPED.as_slice()));
    let lines = "  f 4/4/1 2/2/1 3/3/1\nf 1/1/1 2/2/1 4/4/1 # 2\nf -4 -3 -2 -1\n";
    assert_eq!(text(written), file.replace("  f 1/1/1 2/2/1 \\\n 3/3/1 4/4/1 # 2\nf -4 -3 -2 -1\n", lines));
    // Line ends stay.
    for end in ["\r", "\r\n"] {
        let (_, _, written) = run(Format::Obj, file.replace('\n', end));
        assert!(text(written).contains(&lines.replace('\n', end)));
    }
}

#[test]
fn groups_of_obj_faces_keep_their_border() {
    let border = square_obj("g a\nusemtl m\nf 1 2 3\nusemtl n\nf 1 3 4\n");
    for (from, to, is_locked) in [
        ("n\n", "n\n", true),
        ("usemtl n\n", "g b\n", true),
        ("usemtl n\n", "o b\n", true),
        ("usemtl n\n", "s 1\n", true),
        ("usemtl n\n", "g b\ng a\n", false),
        ("usemtl n\n", "usemtl m#2\n", true),
        ("usemtl n\n", " usemtl  m\n", false),
        ("usemtl n\n", "mtllib n\n", false),
    ] {
        let file = border.replace(from, to);
        let (locked, triangles, written) = run(Format::Obj, &file);
        assert_eq!(locked, usize::from(is_locked), "{file}");
        if is_locked {
            assert_eq!((triangles, text(written)), (vec![0, 1, 2, 0, 2, 3], file));
        } else {
            assert_eq!(triangles, FLIPPED);
        }
    }
}

#[test]
fn groups_of_the_options_are_divided_further() {
    let loaded = obj(square_obj("f 1 2 3\nusemtl n\nf 1 3 4\nf 4 3 1\n")).unwrap();
    let mut options = Options { groups: vec![9, 9, 5], ..Options::default() };
    assert_eq!(loaded.constrain(&mut options).unwrap().count, 1);
    assert_eq!(options.groups, [0, 1, 2]);
}

#[test]
fn seams_stay_and_new_corners_have_what_their_sector_has() {
    let corners = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    // The corners of a seam may have different references, or references to different texts.
    for (faces, locked) in [
        ("f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n", 0),
        ("f 1/1 2/2 3/3\nf 1/2 3/3 4/4\n", 1),
        ("f 1/1 2/2 3/3\nf 1/1 3/3/1 4/4\n", 1),
        ("vt 0 0\nf 1/1 2/2 3/3\nf 1/5 3/3 4/4\n", 0),
        ("vt 0 0 0\nf 1/1 2/2 3/3\nf 1/5 3/3 4/4\n", 1),
        ("vn 0 0 1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n", 0),
        ("vn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n", 1),
        // A reference to a line that the file does not have.
        ("f 1/9 2/9 3/9\nf 1/9 3/9 4/9\n", 0),
        ("f 1/9 2/9 3/9\nf 1/8 3/9 4/9\n", 1),
        ("f 1/9 2 3\nf 1/9 3/-99 4/0\n", 0),
    ] {
        let file = square_obj(corners) + faces;
        let (found, triangles, written) = run(Format::Obj, &file);
        assert_eq!(found, locked, "{faces}");
        if locked > 0 {
            assert_eq!(text(written), file);
        } else {
            assert_eq!(triangles, FLIPPED);
        }
    }
    // The flip is beside the seam 2-3: vertex 2 has two texture vertices, 3 has three.
    let file = square_obj(corners)
        + "vt 7 7\nvt 8 8\nv 0.5 9 0\nvt 1 1\n\
        f 1/1/ 2/2/ 3/3/\nf 1/1 3/7 4/4\nf 4/5 3/6 5/1\n";
    let (locked, triangles, written) = run(Format::Obj, &file);
    assert_eq!((locked, &triangles[..6]), (1, FLIPPED.as_slice()));
    let lines = "f 4/4 2/2 3/3\nf 1/1 2/2 4/4\nf 4/5 3/6 5/1\n";
    assert!(text(written).ends_with(lines));
}

#[test]
fn flips_across_seams_are_refused() {
    let loaded = obj(square_obj("vt 0 0\nvt 1 0\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n")).unwrap();
    let error = loaded.file_bytes("a.obj", vec![0, 2, 1, 0, 3, 2]).unwrap_err().to_string();
    assert!(error.contains("cannot result from flips while seams are locked"), "{error}");
    loaded.file_bytes("a.off", FLIPPED.to_vec()).unwrap();
}

#[test]
fn triangles_may_have_been_reversed_first() {
    // The second triangle is reversed; the first is next to a seam.
    let file = square_obj(
        "v 0.5 -9 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
        f 1/1 2/2 3/3\nf 1/1 4/4 3/3\nf 2/1 1/3 5/1\n",
    );
    let loaded = obj(&file).unwrap();
    let mut options = Options::default();
    assert_eq!(loaded.constrain(&mut options).unwrap().count, 1);
    options.locked_edges.dedup();
    assert_eq!(options.locked_edges, [[0, 1]]);
    let (turned, count) = reoriented(&loaded.mesh).unwrap();
    assert_eq!(count, 1);
    let outcome = make_delaunay(&turned, &options, |_, _| ControlFlow::Continue(())).unwrap();
    assert_eq!(outcome.flips, 1);
    let written = text(loaded.file_bytes("a.obj", outcome.triangles).unwrap());
    for corner in
        written.lines().filter(|line| line.starts_with('f')).take(2).flat_map(|line| line[2..].split(' '))
    {
        let (v, vt) = corner.split_once('/').unwrap();
        assert_eq!(v, vt, "{written}");
    }
    assert!(written.ends_with("\nf 2/1 1/3 5/1\n"));
    // No triangle was reversed.
    let same = loaded.file_bytes("a.obj", loaded.mesh.triangles().to_vec()).unwrap();
    assert_eq!(text(same), file);
}

#[test]
fn off_keeps_vertices_and_colours_and_counts_faces() {
    let points = format!("{} 1 0 0 255", SQUARE.join(" 1 0 0 255\n"));
    let file = format!("COFF # c\n4 1 5\n{points}\n\n 4  0 1 2 3 0.1 0.2  0.3 # f\n");
    let (locked, triangles, written) = run(Format::Off, &file);
    assert_eq!((locked, triangles.as_slice()), (0, FLIPPED.as_slice()));
    let expected = file
        .replace("4 1 5", "4 2 6")
        .replace("4  0 1 2 3 0.1 0.2  0.3", "3 3 1 2 0.1 0.2  0.3\n3 0 1 3 0.1 0.2  0.3");
    assert_eq!(text(written), expected);
    let (_, _, written) = run(Format::Off, file.replace("4 1 5", "4 1 0"));
    assert!(text(written).starts_with("COFF # c\n4 2 0\n"));
    let glued = format!("OFF4 2\n{}\n3 0 1 2 red\n3 0 2 3 green\n", SQUARE.join("\n"))
        .replace("red", "1 0 0")
        .replace("green", "0 1 0");
    let (locked, _, written) = run(Format::Off, &glued);
    assert_eq!((locked, text(written)), (1, glued));
}

#[test]
fn ply_keeps_all_elements_and_properties_in_every_encoding() {
    let properties = "property uchar a\nproperty list uchar uchar vertex_indices\nproperty list ushort short b\n\
        element more 1\nproperty double c\n";
    let file = square_ply(properties, "9 4 0 1 2 3 2 -5  6\n 0.25\n").replace("face 2", "face 1");
    let (locked, _, written) = run(Format::Ply, &file);
    let lines = "9 3 3 1 2 2 -5  6\n9 3 0 1 3 2 -5  6\n";
    assert_eq!(
        (locked, text(written)),
        (0, file.replace("face 1", "face 2").replace("9 4 0 1 2 3 2 -5  6\n", lines))
    );

    for is_big in [false, true] {
        let number = |mut bytes: Vec<u8>| {
            if is_big {
                bytes.reverse();
            }
            bytes
        };
        let name = if is_big { "binary_big_endian" } else { "binary_little_endian" };
        let header = file.split_inclusive("end_header\n").next().unwrap().replace("ascii", name);
        let points = [[0.0f32, 0.0], [0.9, 0.2], [1.0, 1.0], [0.0, 1.0]];
        let mut vertices = Vec::new();
        for [x, y] in points {
            vertices.extend([x, y, 0.0].into_iter().flat_map(|x| number(x.to_le_bytes().to_vec())));
            vertices.push(7);
        }
        let b = [[2u16, 5, 6].map(|x| number(x.to_le_bytes().to_vec())).concat()].concat();
        let more = number(0.25f64.to_le_bytes().to_vec());
        let face = [&[9, 4, 0, 1, 2, 3], b.as_slice()].concat();
        let file = [header.as_bytes(), &vertices, &face, &more].concat();
        let (_, _, written) = run(Format::Ply, &file);
        let faces = [[9, 3, 3, 1, 2].as_slice(), &b, &[9, 3, 0, 1, 3], &b].concat();
        let header = header.replace("face 1", "face 2");
        assert_eq!(written, [header.as_bytes(), &vertices, &faces, &more].concat());
    }
}

#[test]
fn ply_faces_that_differ_are_groups() {
    let properties = "property list uchar int vertex_indices\nproperty uchar red\n";
    for (faces, locked) in [("3 0 1 2 5\n3 0 2 3 6\n", 1), ("3 0 1 2 5\n3 0 2 3 5\n", 0)] {
        let file = square_ply(properties, faces);
        let (found, _, written) = run(Format::Ply, &file);
        assert_eq!((found, text(written) == file), (locked, locked == 1));
    }
}

#[test]
fn ply_texture_coordinates_are_at_corners() {
    let properties =
        "property list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int number\n";
    for (faces, expected, locked) in [
        ("4 0 1 2 3 8 0 0 1 0 1 1 0 1 5\n", "3 3 1 2 6 0 1 1 0 1 1 5\n3 0 1 3 6 0 0 1 0 0 1 5\n", 0),
        (
            "3 0 1 2 6 0 0 1 0 1 1 5\n3 0 2 3 6 0 0 1 1 0 1 5\n",
            "3 3 1 2 6 0 1 1 0 1 1 5\n3 0 1 3 6 0 0 1 0 0 1 5\n",
            0,
        ),
        ("3 0 1 2 6 0 0 1 0 1 1 5\n3 0 2 3 6 .5 0 1 1 0 1 5\n", "", 1),
        ("3 0 1 2 6 0 0 1 0 1 1 5\n3 0 2 3 0 5\n", "", 1),
        // A list with another length belongs to the face, not to its corners.
        ("4 0 1 2 3 3 7 8 9 5\n", "3 3 1 2 3 7 8 9 5\n3 0 1 3 3 7 8 9 5\n", 0),
        ("4 0 1 2 3 0 5\n", "3 3 1 2 0 5\n3 0 1 3 0 5\n", 0),
    ] {
        let file = square_ply(properties, faces);
        let (found, _, written) = run(Format::Ply, &file);
        let expected = if locked > 0 { faces } else { expected };
        assert_eq!((found, text(written)), (locked, square_ply(properties, expected)));
    }
    let loaded =
        parsed(Format::Ply, square_ply(properties, "3 0 1 2 6 0 0 1 0 1 1 5\n3 1 3 2 0 5\n")).unwrap();
    let error = loaded.file_bytes("a.ply", vec![1, 2, 3, 1, 3, 2]).unwrap_err().to_string();
    assert_eq!(error, "option triangles: no triangle with these attributes has a `texcoord` at vertex 2");
}

#[test]
fn indices_too_large_for_their_type_are_refused() {
    let mut file =
        "ply\nformat ascii 1.0\nelement vertex 130\nproperty float x\nproperty float y\nelement face 1\n\
        property list uchar char vertex_index\nend_header\n"
            .to_owned();
    file += &(0..130).map(|v| format!("{v} {}\n", v * v)).collect::<String>();
    let loaded = parsed(Format::Ply, file + "3 0 1 2\n").unwrap();
    loaded.file_bytes("a.ply", vec![0, 1, 127]).unwrap();
    let error = loaded.file_bytes("a.ply", vec![0, 1, 128]).unwrap_err().to_string();
    assert_eq!(error, "element `face`: vertex index 128 does not fit the type of `vertex_index`");
}

#[test]
fn a_file_with_strips_is_not_held() {
    let file = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty uchar red\n\
        element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 1\n1 0 1\n0 1 1\n3 0 1 2\n";
    let loaded = parsed(Format::Ply, file).unwrap();
    assert_eq!(
        (loaded.keeps(Format::Ply), loaded.dropped_in(Format::Ply)),
        (false, loaded.dropped.as_slice())
    );
    assert_eq!(loaded.dropped, ["vertex properties `red`"]);
}

/// A facet of the square in binary STL, with the normal 0.
pub(super) fn facet(triangle: [usize; 3], attribute: [u8; 2]) -> Vec<u8> {
    let points = [[0.0f32, 0.0, 0.0], [0.9, 0.2, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mut bytes = [0.0f32; 3].iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<u8>>();
    bytes.extend(triangle.iter().flat_map(|&v| points[v]).flat_map(f32::to_le_bytes));
    bytes.extend(attribute);
    bytes
}

#[test]
fn binary_stl_keeps_its_header_and_attributes() {
    let mut header = b"COLOR=abcd".to_vec();
    header.resize(80, b'.');
    header.extend(2u32.to_le_bytes());
    let file = |attributes: [[u8; 2]; 2]| {
        [header.clone(), facet([0, 1, 2], attributes[0]), facet([0, 2, 3], attributes[1])].concat()
    };
    let (locked, triangles, written) = run(Format::Stl, file([[1, 0x80]; 2]));
    assert_eq!((locked, triangles.as_slice()), (0, FLIPPED.as_slice()));
    let expected = [header.clone(), facet([3, 1, 2], [1, 0x80]), facet([0, 1, 3], [1, 0x80])].concat();
    // The normals are those of the new triangles.
    for start in [84, 134] {
        let normal = written[start..].as_chunks().0[..3].iter().map(|&x| f32::from_le_bytes(x));
        assert!(normal.eq([0.0, 0.0, 1.0]));
        assert_eq!(written[start + 12..start + 50], expected[start + 12..start + 50]);
    }
    assert_eq!((&written[..84], written.len()), (header.as_slice(), 184));
    let differ = file([[1, 0x80], [2, 0x80]]);
    assert_eq!(run(Format::Stl, &differ), (1, vec![0, 1, 2, 0, 2, 3], differ));
}

#[test]
fn a_small_file_does_not_become_a_large_one() {
    // Each triangle of the polygon would repeat a colour with many numbers.
    let polygon: String = (0..2000).map(|i| format!(" {}", i % 3)).collect();
    let file = format!("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000{polygon}{}\n", " 0.5".repeat(2000));
    let options = ReadOptions { max_bytes: 1 << 17, ..ReadOptions::default() };
    let loaded = parse(Format::Off, file.as_bytes(), &options).unwrap();
    let mut triangles = loaded.mesh.triangles().to_vec();
    triangles.rotate_left(1);
    let error = loaded.file_bytes("a.off", triangles).unwrap_err();
    assert!(matches!(error, Error::FileTooLarge { limit: 131_072, .. }), "{error}");
}

#[test]
fn another_mesh_than_that_of_the_file_is_refused() {
    let mut loaded = obj(square_obj("f 1 2 3\nf 1 3 4\n")).unwrap();
    loaded.mesh = loaded.mesh.with_triangles(vec![0, 1, 2]).unwrap();
    for error in [
        loaded.constrain(&mut Options::default()).unwrap_err(),
        loaded.file_bytes("a.obj", vec![0, 1, 2]).unwrap_err(),
    ] {
        assert!(matches!(error, Error::TriangleCount { length: 3, expected: 6 }), "{error}");
    }
}

proptest! {
    /// Dirty meshes whose corners have texture vertices and whose faces are in groups.
    #[test]
    fn what_corners_and_faces_have_stays_with_them(
        points in prop::collection::vec([0..5i8, 0..5i8], 3..9),
        faces in prop::collection::vec((prop::collection::vec(any::<[u8; 2]>(), 3..6), 0..3u8), 1..12),
    ) {
        let count = points.len() as u8;
        let mut file: String = points.iter().map(|[x, y]| format!("v {x} {y} 0\n")).collect();
        file += "vt 0 0\nvt 1 0\nvt 0 0\n";
        for (corners, group) in &faces {
            let corners: String = corners.iter().map(|[v, vt]| format!(" {}/{}", v % count + 1, vt % 3 + 1)).collect();
            file += &format!("usemtl {group}\nf{corners}\n");
        }
        let loaded = obj(&file).unwrap();
        let (_, _, written) = run(Format::Obj, &file);
        let attributes = |file: &str| {
            let mut found: Vec<_> = file
                .lines()
                .filter(|line| line.starts_with('f'))
                .flat_map(|line| line[2..].split(' ').map(|corner| corner.replace("/3", "/1")).collect::<Vec<_>>())
                .collect();
            found.sort();
            found.dedup();
            found
        };
        let written = text(written);
        let before = attributes(&file);
        prop_assert!(attributes(&written).iter().all(|corner| before.contains(corner)), "{}\n{}", file, written);
        let lines = |file: &str| file.lines().filter(|line| !line.starts_with('f')).map(str::to_owned).collect::<Vec<_>>();
        prop_assert_eq!(lines(&file), lines(&written));
        prop_assert_eq!(loaded.mesh.triangle_count(), obj(&written).unwrap().mesh.triangle_count());
    }
}
