//! PLY in its three encodings.

use super::*;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{
    Addable, DefaultElement, ElementDef, Encoding, Ply, Property, PropertyDef, PropertyType, ScalarType,
};
use ply_rs_bw::writer::Writer;

/// The header of a text file with three vertices and a face.
pub(super) const HEAD: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
    property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
const POINTS: &str = "0 0 0\n1 0 0\n0 1 0.5\n";

fn ply(bytes: impl AsRef<[u8]>) -> Result<Loaded, Error> {
    parsed(Format::Ply, bytes)
}

const RAISED: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.5];

#[test]
fn every_common_form_of_text_is_read() {
    let text = format!("{HEAD}{POINTS}3 0 1 2\n");
    for text in [
        text.clone(),
        text.replace('\n', "\r\n"),
        text.replace('\n', "\r"),
        text.replace("end_header\n", "comment a b c d e f g\nobj_info\n\nend_header\n\n \n"),
        text.replace("float z\n", "float32 z\n").replace("list uchar int", "list int8 uint16"),
        text.replace("vertex_indices", "vertex_index").replace("3 0 1 2\n", "  3\t0 +1 2 "),
    ] {
        let loaded = mesh(ply(&text), Three, &RAISED, &[0, 1, 2]);
        assert_eq!((loaded.polygons, loaded.dropped.len()), (0, 0), "{text}");
    }
    let plane = text.replace("property float z\n", "").replace(" 0\n", "\n").replace(" 0.5", "");
    mesh(ply(&plane), Two, &[0., 0., 1., 0., 0., 1.], &[0, 1, 2]);
}

#[test]
fn dropped_properties_are_named_and_elements_come_in_any_order() {
    let text = "ply\nformat ascii 1.0\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n\
        element nothing 18446744073709551615\nelement none 0\nproperty int a\nelement face 2\nproperty uchar flags\n\
        property list uchar float texcoord\nproperty list uint ushort vertex_index\nelement vertex 5\n\
        property list int int seen\nproperty uchar red\nproperty double z\nproperty short y\nproperty int nx\n\
        property int8 x\nend_header\n0 1\n1 2 0.5 nan 4 0 1 2 3\n2 0 3 0 1 4\n0 .5 0.1 -7 1e9 3\n\
        2 7 8 0 0 0 0 0\n0 0 0 0 0 1\n0 0 0 0 0 2\n0 0 0 0 0 4\n";
    let loaded = ply(text.replace("18446744073709551615", "9223372036854775807")).unwrap();
    assert_eq!(loaded.mesh.triangles(), [0, 1, 2, 0, 2, 3, 0, 1, 4]);
    let points = [3., -7., 0.1, 0., 0., 0., 1., 0., 0., 2., 0., 0., 4., 0., 0.];
    assert_eq!(*loaded.mesh.positions(), Positions::F64(points.to_vec()));
    assert_eq!(loaded.polygons, 1);
    assert_eq!(
        loaded.dropped,
        [
            "face properties `flags`, `texcoord`",
            "vertex properties `seen`, `red`, `nx`",
            "elements `edge`, `nothing`",
        ]
    );
    let many: String = (0..15).map(|i| format!("property float p{i}\n")).collect();
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n{many}property float y\nend_header\n{}",
        "1 ".repeat(17)
    );
    let names: Vec<_> = (0..12).map(|i| format!("`p{i}`")).collect();
    assert_eq!(ply(text).unwrap().dropped, [format!("vertex properties {}, and 3 more", names.join(", "))]);
}

#[test]
fn strips_turn_and_end() {
    let text = "ply\nformat ascii 1.0\nelement vertex 6\nproperty char x\nproperty char y\nelement tristrips 2\n\
        property list int int vertex_indices\nend_header\n0 0\n1 0\n0 1\n1 1\n0 2\n1 2\n\
        9 0 1 2 3 4 -1 2 3 4\n8 0 1 2 2 2 3 -1 -1";
    let text = text.replace("8 0 1", "10 0 1").replace("-1 -1", "4 5 -1 -1");
    let loaded = ply(text).unwrap();
    assert_eq!(loaded.mesh.triangles(), [0, 1, 2, 2, 1, 3, 2, 3, 4, 2, 3, 4, 0, 1, 2, 2, 3, 4, 4, 3, 5]);
}

/// A mesh with many kinds of elements and properties, which the other crate writes to files.
fn other_crates(
    encoding: Encoding,
    coordinate: ScalarType,
    length: ScalarType,
    index: ScalarType,
) -> Vec<u8> {
    let number = |scalar: &ScalarType, x: f64| match scalar {
        ScalarType::Char => Property::Char(x as i8),
        ScalarType::UChar => Property::UChar(x as u8),
        ScalarType::Short => Property::Short(x as i16),
        ScalarType::UShort => Property::UShort(x as u16),
        ScalarType::Int => Property::Int(x as i32),
        ScalarType::UInt => Property::UInt(x as u32),
        ScalarType::Float => Property::Float(x as f32),
        ScalarType::Double => Property::Double(x),
    };
    let list = |scalar: &ScalarType, x: [u8; 4]| match scalar {
        ScalarType::Char => Property::ListChar(x.map(|x| x as i8).to_vec()),
        ScalarType::UChar => Property::ListUChar(x.to_vec()),
        ScalarType::Short => Property::ListShort(x.map(Into::into).to_vec()),
        ScalarType::UShort => Property::ListUShort(x.map(Into::into).to_vec()),
        ScalarType::Int => Property::ListInt(x.map(Into::into).to_vec()),
        ScalarType::UInt => Property::ListUInt(x.map(Into::into).to_vec()),
        ScalarType::Float => Property::ListFloat(x.map(Into::into).to_vec()),
        ScalarType::Double => Property::ListDouble(x.map(Into::into).to_vec()),
    };
    let mut ply = Ply::<DefaultElement>::new();
    ply.header.encoding = encoding;
    let mut vertex = ElementDef::new("vertex".into());
    let mut face = ElementDef::new("face".into());
    for name in ["z", "nx", "x", "y"] {
        vertex.properties.add(PropertyDef::new(name.into(), PropertyType::Scalar(coordinate.clone())));
    }
    for name in ["colours", "vertex_indices"] {
        let scalar = if name == "colours" { ScalarType::Double } else { index.clone() };
        face.properties.add(PropertyDef::new(name.into(), PropertyType::List(length.clone(), scalar)));
    }
    ply.header.elements.add(vertex);
    ply.header.elements.add(face);
    let points = [[0., 0., 7.], [100., 1., 7.], [99., 98., 7.], [1., 97., 8.]];
    let vertices = points.map(|[x, y, z]| {
        let fields = [("x", x), ("y", y), ("z", z), ("nx", 55.0)];
        fields.map(|(name, x)| (name.to_owned(), number(&coordinate, x))).into_iter().collect()
    });
    let face =
        [("colours", list(&ScalarType::Double, [9; 4])), ("vertex_indices", list(&index, [3, 2, 1, 0]))];
    let face = face.map(|(name, list)| (name.to_owned(), list)).into_iter().collect();
    ply.payload.insert("vertex".into(), vertices.to_vec());
    ply.payload.insert("face".into(), vec![face]);
    let mut bytes = Vec::new();
    Writer::new().write_ply(&mut bytes, &mut ply).unwrap();
    bytes
}

#[test]
fn every_type_in_every_encoding_as_another_crate_writes_it() {
    use ScalarType::*;
    let types = [Char, UChar, Short, UShort, Int, UInt, Float, Double];
    for encoding in [Encoding::Ascii, Encoding::BinaryLittleEndian, Encoding::BinaryBigEndian] {
        for coordinate in types.clone() {
            for integer in &types[..6] {
                for length in &types[..6] {
                    let bytes = other_crates(encoding, coordinate.clone(), length.clone(), integer.clone());
                    let points = [0., 0., 7., 100., 1., 7., 99., 98., 7., 1., 97., 8.];
                    let loaded = mesh(ply(&bytes), Three, &points, &[3, 2, 1, 3, 1, 0]);
                    assert_eq!(loaded.polygons, 1);
                    assert_eq!(loaded.dropped, ["vertex properties `nx`", "face properties `colours`"]);
                }
            }
        }
    }
}

#[test]
fn another_crate_reads_what_is_written() {
    for (positions, is_wide) in [
        (Positions::F32(vec![0.1, -0.0, 1e-45, 3.0, 4.0, 5.5, f32::MAX, 0.0, 0.0]), false),
        (Positions::F64(vec![0.1, -0.0, 5e-324, 3.0, 4.0, 5.5, f64::MAX, 0.0, 0.0]), true),
    ] {
        let mesh = Mesh::new(Three, positions, vec![0, 1, 2, 2, 1, 0]).unwrap();
        let bytes = to_bytes(Format::Ply, &mesh).unwrap();
        let read = Parser::<DefaultElement>::new().read_ply(&mut bytes.as_slice()).unwrap();
        let numbers: Vec<f64> = read.payload["vertex"]
            .iter()
            .flat_map(|vertex| ["x", "y", "z"].map(|name| vertex[name].clone()))
            .map(|property| match property {
                Property::Float(x) if !is_wide => x.into(),
                Property::Double(x) if is_wide => x,
                _ => panic!("{property:?}"),
            })
            .collect();
        let bits = |x: Vec<f64>| x.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        assert_eq!(bits(numbers), bits(mesh.positions().iter().collect()));
        let faces = read.payload["face"].iter().map(|face| face["vertex_indices"].clone());
        let expected = [[0, 1, 2], [2, 1, 0]].map(|face| Property::ListUInt(face.to_vec()));
        assert!(faces.eq(expected));
        let loaded = ply(&bytes).unwrap();
        assert_eq!(loaded.mesh, mesh);
        assert_eq!(to_bytes(Format::Ply, &loaded.mesh).unwrap(), bytes);
    }
}

#[test]
fn a_line_feed_after_a_header_of_carriage_returns_is_a_number() {
    let header = "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty char x\rproperty char y\rend_header\r";
    mesh(ply([header.as_bytes(), &[10, 13]].concat()), Two, &[10., 13.], &[]);
    for header in [header.replace('\r', "\n"), header.replace('\r', "\r\n")] {
        mesh(ply([header.as_bytes(), &[10, 13]].concat()), Two, &[10., 13.], &[]);
    }
}

#[test]
fn a_comment_needs_no_keyword() {
    let text = "ply\nformat ascii 1.0\nCreated by a program\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n5 6\n";
    mesh(ply(text), Two, &[5., 6.], &[]);
}

#[test]
fn text_refused_with_its_line() {
    for (from, to, message) in [
        ("ply\n", "plyx\n", "line 1: expected the keyword ply of a PLY file, found `plyx`"),
        ("format ascii 1.0\n", "", "line 8: the header has no line format"),
        ("ascii 1.0", "ascii 2.0", "line 2: expected a line of a PLY header, found `format ascii 2.0`"),
        ("ascii", "binary", "line 2: expected a line of a PLY header, found `format binary 1.0`"),
        ("vertex 3", "vertex -3", "line 3: expected a number of elements, found `-3`"),
        ("vertex 3", "vertex", "line 3: expected a line of a PLY header, found `element vertex`"),
        ("vertex 3", "vertices 3", "header: there is no element `vertex`"),
        ("float x", "long x", "line 4: expected a type such as float or int, found `long`"),
        ("float x", "float u", "header: element `vertex` needs the properties x and y"),
        ("float x", "list int float x", "header: element `vertex` needs the properties x and y"),
        ("float z", "float y", "header: element `vertex` has two properties `y`"),
        ("element vertex 3\n", "", "line 3: a property before the first element"),
        ("face 1", "vertex 1", "header: there are two elements `vertex`"),
        ("list uchar", "list float", "line 8: the length of a list must have an integer type"),
        (
            "uchar int",
            "uchar float",
            "header: element `face` needs one list vertex_indices of integers, but has 0",
        ),
        (
            "end_header",
            "property list uchar int vertex_index\nend_header",
            "header: element `face` needs one list vertex_indices of integers, but has 2",
        ),
        ("end_header\n", "end_header 1\n", "line 9: expected a line of a PLY header, found `end_header 1`"),
        ("1 0 0\n", "1 0\n", "line 11: expected another number, found the end of the line"),
        ("1 0 0\n", "1 0 0 0\n", "line 11: expected the end of the line, found `0`"),
        ("1 0 0\n", "1 o 0\n", "line 11: expected a number, found `o`"),
        ("1 0 0\n", "1 nan 0\n", "line 11: coordinate y is NaN, not a finite number"),
        ("1 0 0\n", "1 0 1e399\n", "line 11: coordinate z is inf, not a finite number"),
        ("3 0 1 2", "2 0 1", "line 13: a face with 2 corners, but a face needs at least 3"),
        ("3 0 1 2", "-1", "line 13: a face with -1 corners, but a face needs at least 3"),
        ("3 0 1 2", "x 0 1 2", "line 13: expected an integer of at most 32 bits, found `x`"),
        ("3 0 1 2", "4294967295 0 1", "line 13: expected another number, found the end of the line"),
        ("3 0 1 2", "3 0 1 3", "line 13: vertex index 3 is out of range, the mesh has 3 vertices"),
        ("3 0 1 2", "3 0 1 -1", "line 13: vertex index -1 is out of range, the mesh has 3 vertices"),
        (
            "3 0 1 2",
            "3 0 1 4294967296",
            "line 13: expected an integer of at most 32 bits, found `4294967296`",
        ),
        ("3 0 1 2", "3 0 1 1.0", "line 13: expected an integer of at most 32 bits, found `1.0`"),
        ("3 0 1 2", "", "line 13: the file ends after 0 of 1 elements `face`"),
        ("vertex 3", "vertex 4000000000", "line 13: expected the end of the line, found `2`"),
        (
            "2\n",
            "2\nmore 1\n",
            "line 14: expected the end of the file after the last element, found `more 1`",
        ),
    ] {
        let text = format!("{HEAD}{POINTS}3 0 1 2\n");
        assert!(text.contains(from), "{from}");
        let (before, after) = text.rsplit_once(from).unwrap();
        refused(ply(format!("{before}{to}{after}")), message);
    }
    refused(ply("ply\nformat ascii 1.0\n"), "line 2: the file ends before the line end_header");
    refused(ply(HEAD), "line 9: the file ends after 0 of 3 elements `vertex`");
    let lists = "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nelement a 2\nproperty list int int b\nend_header\n1 1\n";
    refused(ply(format!("{lists}-1\n")), "line 10: a list with -1 numbers, but it cannot have less than 0");
}

#[test]
fn binary_refused_with_its_byte() {
    for (encoding, is_big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let head = HEAD.replace("ascii", encoding).replace("uchar", "int");
        let start = head.len();
        let file = |numbers: &[f32], list: &[i32]| {
            let words = numbers.iter().map(|x| x.to_bits()).chain(list.iter().map(|&i| i as u32));
            let order = if is_big { u32::to_be_bytes } else { u32::to_le_bytes };
            [head.as_bytes(), words.flat_map(order).collect::<Vec<_>>().as_slice()].concat()
        };
        mesh(ply(file(&RAISED, &[3, 0, 1, 2])), Three, &RAISED, &[0, 1, 2]);
        // Some editors end a file with a line feed.
        mesh(ply([file(&RAISED, &[3, 0, 1, 2]), b"\r\n".to_vec()].concat()), Three, &RAISED, &[0, 1, 2]);
        let mut wrong = RAISED;
        wrong[4] = f32::NEG_INFINITY;
        for (numbers, list, at, message) in [
            (&wrong, [3, 0, 1, 2].as_slice(), 16, "coordinate y is -inf, not a finite number"),
            (&RAISED, &[-3, 0, 1, 2], 36, "a face with -3 corners, but a face needs at least 3"),
            (&RAISED, &[i32::MAX, 0, 1, 2], 52, "expected 4 more bytes, but the file ends after 0"),
            (&RAISED, &[3, 0, 1, 3], 48, "vertex index 3 is out of range, the mesh has 3 vertices"),
            (&RAISED, &[3, -1, 1, 2], 40, "vertex index -1 is out of range, the mesh has 3 vertices"),
            (&RAISED, &[], 36, "the file ends after 0 of 1 elements `face`"),
            (
                &RAISED,
                &[3, 0, 1, 2, 0],
                52,
                "expected the end of the file after the last element, found 4 more bytes",
            ),
        ] {
            refused(ply(file(numbers, list)), &format!("byte {}: {message}", start + at));
        }
        let lists = "property list uint double b\nelement face";
        let head = head.replace("element face", lists).replace("vertex 3", "vertex 1");
        let mut file = [head.as_bytes(), &[0; 12], &[0xff; 4]].concat();
        file.extend([0; 5]);
        let message = "expected 34359738360 more bytes, but the file ends after 5";
        refused(ply(file), &format!("byte {}: {message}", head.len() + 16));
    }
}

#[test]
fn a_large_count_in_the_header_takes_no_memory() {
    for (encoding, location) in
        [("ascii", "line 9"), ("binary_little_endian", "byte 187"), ("binary_big_endian", "byte 184")]
    {
        let head = HEAD.replace("ascii", encoding).replace("vertex 3", "vertex 4000000000000000000");
        let message = format!("{location}: the file ends after 0 of 4000000000000000000 elements `vertex`");
        refused(ply(head), &message);
    }
}

#[test]
fn no_file_that_is_cut_off_is_read() {
    let mesh = Mesh::new(Three, RAISED.to_vec(), vec![0, 1, 2, 0, 2, 1]).unwrap();
    let bytes = to_bytes(Format::Ply, &mesh).unwrap();
    for length in 0..bytes.len() {
        ply(&bytes[..length]).unwrap_err();
    }
}

proptest! {
    #[test]
    fn every_bit_of_doubles_comes_back(numbers in prop::collection::vec(any::<f64>().prop_filter("finite", |x| x.is_finite()), 2..60)) {
        let stride = 2 + usize::from(numbers.len() % 3 == 0);
        let dimension = if stride == 2 { Two } else { Three };
        let numbers = numbers[..numbers.len() / stride * stride].to_vec();
        let mesh = Mesh::new(dimension, numbers, vec![]).unwrap();
        let loaded = in_dimension(Format::Ply, to_bytes(Format::Ply, &mesh).unwrap(), dimension).unwrap();
        let bits = |mesh: &Mesh| mesh.positions().iter().map(f64::to_bits).collect::<Vec<_>>();
        prop_assert_eq!(bits(&loaded.mesh), bits(&mesh));
    }
}
