//! STL as text and binary, and how its corners become vertices.

use super::super::stl as io_stl;
use super::*;
use glam::Vec3;

fn stl(bytes: impl AsRef<[u8]>) -> Result<Loaded, Error> {
    parsed(Format::Stl, bytes)
}

const TEXT: &str = "solid a facet of b\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1 0 0\n\
    \x20     vertex 0 1 0.5\n    endloop\n  endfacet\n  facet normal nan nan nan\n    outer loop\n\
    \x20     vertex 0 1 0.5\n      vertex 1 0 -0\n      vertex 5 5 5\n    endloop\n  endfacet\nendsolid a facet of b\n";
const POINTS: [f32; 12] = [0., 0., 0., 1., 0., 0., 0., 1., 0.5, 5., 5., 5.];

/// A binary file with these facets, given by their corners.
fn binary(head: &[u8], facets: &[[f32; 9]]) -> Vec<u8> {
    let mut bytes = head.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((facets.len() as u32).to_le_bytes());
    for facet in facets {
        bytes.extend([0; 12]);
        bytes.extend(facet.iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const FACETS: [[f32; 9]; 2] = [[0., 0., 0., 1., 0., 0., 0., 1., 0.5], [0., 1., 0.5, 1., 0., -0., 5., 5., 5.]];

#[test]
fn every_common_form_of_text_is_read() {
    for text in [
        TEXT.to_owned(),
        TEXT.to_uppercase(),
        TEXT.replace('\n', "\r\n"),
        TEXT.replace(" a facet of b", ""),
        TEXT.replace("  facet normal nan", "endsolid\n\nsolid second\nfacet normal nan"),
        TEXT.replace("      vertex", "vertex")
            .replace("outer loop\n", "outer loop ")
            .replace("endloop\n", "endloop "),
        format!("\u{feff}\n {TEXT}"),
    ] {
        let loaded = mesh(stl(&text), Three, &POINTS, &[0, 1, 2, 2, 1, 3]);
        assert_eq!((loaded.polygons, loaded.dropped.len()), (0, 0), "{text}");
    }
    let polygon = TEXT.replace("vertex 5 5 5", "vertex 5 5 5 vertex 0 0 0");
    assert_eq!(mesh(stl(polygon), Three, &POINTS, &[0, 1, 2, 2, 1, 3, 2, 3, 0]).polygons, 1);
    mesh(stl("solid\nendsolid"), Two, &[], &[]);
}

#[test]
fn binary_whatever_it_begins_with() {
    for head in ["", "exported", "solid", "solid\nfacet normal 0 0 1"] {
        let bytes = binary(head.as_bytes(), &FACETS);
        let loaded = mesh(stl(&bytes), Three, &POINTS, &[0, 1, 2, 2, 1, 3]);
        assert!(loaded.dropped.is_empty());
        mesh(stl([&bytes, b"\n".as_slice()].concat()), Three, &POINTS, &[0, 1, 2, 2, 1, 3]);
        let mut coloured = bytes.clone();
        coloured[84 + 49] = 0x80;
        assert_eq!(stl(coloured).unwrap().dropped, ["attributes of facets"]);
    }
    mesh(stl(binary(b"", &[])), Two, &[], &[]);
    // With so many facets, no byte of their number is zero.
    let header = [b"solid".as_slice(), &[b' '; 75], &[1; 4]].concat();
    let length = 84 + 50 * 0x0101_0101;
    assert!(!io_stl::is_text(&header, length) && io_stl::is_text(&header, length + 1));
}

#[test]
fn corners_at_one_position_are_one_vertex() {
    let next = 1.0f32.next_up();
    let facets = [[-0., 0., 7., 1., 0., 7., next, 0., 7.], [1., -0., 7., 0., -0., 7., 0., 0., 7.]];
    let points = [-0., 0., 7., 1., 0., 7., next, 0., 7.];
    mesh(stl(binary(b"", &facets)), Three, &points, &[0, 1, 2, 1, 0, 0]);
}

#[test]
fn errors_name_their_location() {
    for (from, to, message) in [
        ("normal", "norm", "line 9: expected normal, found `norm`"),
        ("nan nan nan", "0 0 up", "line 9: expected a number, found `up`"),
        ("outer loop", "outer", "line 11: expected loop, found `vertex`"),
        ("vertex 5 5 5\n", "", "line 13: expected vertex, found `endloop`"),
        ("vertex 5 5 5", "vertex 5 5", "line 14: expected a number, found `endloop`"),
        ("vertex 5 5 5", "vertex 5 5 inf", "line 13: `inf` is not a finite number"),
        ("vertex 5 5 5", "vertex 5 5 5 5", "line 13: expected vertex, found `5`"),
        ("  endfacet\n", "", "line 15: expected endfacet, found `endsolid`"),
        ("endsolid a", "end solid a", "line 16: expected facet or endsolid, found `end`"),
        ("endsolid a facet of b\n", "", "line 15: expected facet or endsolid, found the end of the file"),
        ("of b\n", "of b\nmore", "line 17: expected solid, found `more`"),
    ] {
        let (before, after) = TEXT.rsplit_once(from).unwrap();
        refused(stl(format!("{before}{to}{after}")), message);
    }
    for (bytes, message) in [
        (
            b"facet normal 0 0 1".to_vec(),
            "byte 0: expected solid, or the 84 bytes before the facets of a binary STL file",
        ),
        (binary(b"solid", &FACETS)[..90].to_vec(), "byte 90: the file ends after 0 of 2 facets"),
        (binary(b"", &FACETS)[..183].to_vec(), "byte 183: the file ends after 1 of 2 facets"),
        (
            [binary(b"", &FACETS), vec![1; 3]].concat(),
            "byte 184: expected the end of the file after 2 facets, found 3 more bytes",
        ),
        (
            [binary(b"", &FACETS), vec![0; 53]].concat(),
            "byte 184: expected the end of the file after 2 facets, found 53 more bytes",
        ),
        (
            binary(b"", &[FACETS[0], [0., 0., 0., 0., f32::NAN, 0., 0., 0., 0.]]),
            "byte 162: coordinate y is NaN, not a finite number",
        ),
    ] {
        refused(stl(bytes), message);
    }
    let mut bytes = binary(b"", &FACETS);
    bytes[80..84].fill(0xff);
    refused(stl(bytes), "byte 184: the file ends after 2 of 4294967295 facets");
}

#[test]
fn no_file_that_is_cut_off_is_read() {
    for length in 0..184 {
        stl(&binary(b"solid", &FACETS)[..length]).unwrap_err();
    }
    let end = TEXT.find("endsolid").unwrap() + "endsolid".len();
    for length in 0..end {
        stl(&TEXT[..length]).unwrap_err();
    }
}

#[test]
fn another_crate_writes_and_reads_the_same() {
    let vertices = POINTS.as_chunks::<3>().0;
    let triangles = [[0, 1, 2], [2, 1, 3], [3, 3, 0]];
    let mesh = Mesh::new(Three, POINTS.to_vec(), triangles.as_flattened().to_vec()).unwrap();
    let corner = |v: u32| stl_io::Vertex::new(vertices[v as usize]);
    let facets = triangles
        .map(|t| stl_io::Triangle { normal: stl_io::Normal::new([0.0; 3]), vertices: t.map(corner) });
    let mut bytes = Vec::new();
    stl_io::write_stl(&mut bytes, facets.iter()).unwrap();
    assert_eq!(stl(&bytes).unwrap().mesh, mesh);

    let ours = to_bytes(Format::Stl, &mesh).unwrap();
    assert_eq!(stl(&ours).unwrap().mesh, mesh);
    let read = stl_io::read_stl(&mut std::io::Cursor::new(&ours)).unwrap();
    let points: Vec<_> = read.vertices.iter().map(|vertex| vertex.0).collect();
    assert_eq!(points, vertices);
    let crosses = [Vec3::new(0., -0.5, 1.), Vec3::new(-2.5, -7., 9.), Vec3::ZERO];
    for ((face, triangle), cross) in read.faces.iter().zip(triangles).zip(crosses) {
        assert_eq!(face.vertices, triangle.map(|v| v as usize));
        assert!(Vec3::from(face.normal.0).abs_diff_eq(cross.normalize_or_zero(), 1e-6));
    }
}

#[test]
fn written_numbers_have_32_bits() {
    let mut numbers = vec![0.1, 1.0, 0.0, 1.0, 0.1, 2.0];
    let flat = Mesh::new(Two, numbers.clone(), vec![0, 1, 2]).unwrap();
    let bytes = to_bytes(Format::Stl, &flat).unwrap();
    assert!(!bytes.starts_with(b"solid"));
    mesh(stl(&bytes), Two, &[0.1, 1., 0., 1., 0.1, 2.], &[0, 1, 2]);
    // Its normal points down.
    assert_eq!(bytes[84..96], [[0; 4], [0; 4], (-1.0f32).to_le_bytes()].concat());
    numbers[3] = 1e39;
    let far = Mesh::new(Two, numbers, vec![0, 1, 2]).unwrap();
    let error = to_file_bytes("a.stl", &far).unwrap_err().to_string();
    assert_eq!(error, "a.stl: vertex 1 is too far away for the 32-bit numbers of STL; write PLY, OBJ or OFF");
    // Triangles with the longest and the shortest edges have normals.
    for x in [f32::MAX, f32::from_bits(1)] {
        let mesh = Mesh::new(Two, vec![-x, -x, x, -x, x, x], vec![0, 1, 2]).unwrap();
        assert_eq!(to_bytes(Format::Stl, &mesh).unwrap()[92..96], 1.0f32.to_le_bytes());
    }
}

proptest! {
    #[test]
    fn corners_come_back_as_few_vertices(
        numbers in prop::collection::vec(prop::sample::select(vec![0.0, -0.0, 1.0, -1.0, 1e-45, f32::MAX]), 9..120),
    ) {
        let vertices = numbers.len() / 3;
        let numbers = numbers[..3 * vertices].to_vec();
        let triangles: Vec<u32> = (0..(vertices / 3 * 3) as u32).collect();
        let given = Mesh::new(Three, numbers, triangles).unwrap();
        let bytes = to_bytes(Format::Stl, &given).unwrap();
        let found = in_dimension(Format::Stl, bytes, Three).unwrap().mesh;
        // Compared as values: 0 equals -0.
        let corners = |mesh: &Mesh| mesh.triangles().iter().map(|&v| mesh.point3(v)).collect::<Vec<_>>();
        prop_assert_eq!(corners(&given), corners(&found));
        for (i, &v) in found.triangles().iter().enumerate() {
            let known = found.triangles()[..i].iter().copied().max().map_or(0, |max| max + 1);
            prop_assert!(v <= known);
            let before = corners(&found)[..i].iter().position(|&p| p == found.point3(v));
            prop_assert_eq!(before.is_none(), v == known);
        }
    }
}
