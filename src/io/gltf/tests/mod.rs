//! Tests of reading and rewriting glTF: the triangles that are read, and that only indices change.

mod hostile;

use super::container;
use super::document::Document;
use super::read::Content;
use super::write::new_file;
use crate::io::options::ReadFile;
use crate::io::parsed::Parsed;
use crate::{Dimension, Error, Mesh, Positions};
use serde_json::{Value, json};

/// A file with one buffer, made of the bytes for the buffer views of the JSON.
fn glb(json: &Value, buffer: &[u8]) -> Vec<u8> {
    container::glb(json.to_string().as_bytes(), Some(buffer), &[]).unwrap()
}

fn denied(_: &str) -> Result<Vec<u8>, String> {
    Err("not allowed".into())
}

/// The triangles of a file.
struct Scene {
    positions: Vec<f32>,
    triangles: Vec<u32>,
    document: Document,
    notes: Vec<String>,
}

fn parse(bytes: Vec<u8>, read: ReadFile<'_>, max_bytes: u64) -> Result<Scene, Error> {
    let Content { parsed, document, notes } = super::read::read(bytes, read, max_bytes)?;
    let Parsed { positions: Positions::F32(positions), faces, .. } = parsed else {
        unreachable!("glTF has 32-bit floats")
    };
    Ok(Scene { positions, triangles: faces.triangles, document, notes })
}

fn read(bytes: &[u8]) -> Result<Scene, Error> {
    parse(bytes.to_vec(), &denied, 1 << 20)
}

#[track_caller]
fn refused(bytes: &[u8], message: &str) {
    assert_eq!(read(bytes).err().unwrap().to_string(), message);
}

/// Two triangles of a square, 0-1-2 and 0-2-3, whose diagonal becomes 1-3 in [`FLIPPED`].
const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
const INDICES: [u32; 6] = [0, 1, 2, 0, 2, 3];
const FLIPPED: [u32; 6] = [0, 1, 3, 1, 2, 3];

fn floats(positions: &[[f32; 3]]) -> Vec<u8> {
    positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn shorts(indices: &[u32]) -> Vec<u8> {
    indices.iter().flat_map(|&i| (i as u16).to_le_bytes()).collect()
}

/// The square: positions in accessor 0, 6 short indices in accessor 1, 12 of their bytes at 48.
fn square() -> (Value, Vec<u8>) {
    let json = json!({
        "asset": { "version": "2.0" },
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [2, 1, 0] },
            { "bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 48 },
            { "buffer": 0, "byteOffset": 48, "byteLength": 12 },
        ],
        "buffers": [{ "byteLength": 60 }],
    });
    (json, [floats(&SQUARE), shorts(&INDICES)].concat())
}

/// The square with changes to its JSON, `(pointer, value)`; a missing member is added.
fn changed(changes: &[(&str, Value)]) -> Vec<u8> {
    let (mut json, buffer) = square();
    for (pointer, value) in changes {
        let (parent, member) = pointer.rsplit_once('/').unwrap();
        let parent = json.pointer_mut(parent).unwrap();
        match parent {
            Value::Array(array) => match member.parse::<usize>() {
                Ok(index) if index < array.len() => array[index] = value.clone(),
                _ => array.push(value.clone()),
            },
            _ => parent[member] = value.clone(),
        }
    }
    glb(&json, &buffer)
}

fn placed(scene: &Scene) -> Vec<f32> {
    let mesh = Mesh::new(Dimension::Three, scene.positions.clone(), scene.triangles.clone()).unwrap();
    scene.document.placed(&mesh)
}

fn numbers(scene: &Scene) -> Vec<f32> {
    scene.positions.clone()
}

#[test]
fn only_the_bytes_of_indices_change() {
    let (json, buffer) = square();
    let other = [&5u32.to_le_bytes()[..], b"OWN\0", b"12345"].concat();
    let bytes = container::glb(json.to_string().as_bytes(), Some(&buffer), &[&other]).unwrap();
    let scene = read(&bytes).unwrap();
    assert_eq!(numbers(&scene), SQUARE.as_flattened());
    assert_eq!(scene.triangles, INDICES);
    let same = scene.document.with_triangles(&INDICES, &INDICES, true).unwrap();
    assert_eq!(same, bytes);
    let after = scene.document.with_triangles(&INDICES, &FLIPPED, true).unwrap();
    let differ: Vec<usize> = (0..bytes.len()).filter(|&i| after[i] != bytes[i]).collect();
    let start = bytes.windows(12).position(|window| window == shorts(&INDICES)).unwrap();
    assert!(!differ.is_empty() && differ.iter().all(|i| (start..start + 12).contains(i)), "{differ:?}");
    assert_eq!(read(&after).unwrap().triangles, FLIPPED);
}

#[test]
fn a_file_goes_from_one_form_to_the_other_and_back() {
    let bytes = changed(&[("/asset/extras", json!({ "π": [1, 2.5, null] }))]);
    let document = read(&bytes).unwrap().document;
    let text = document.with_triangles(&INDICES, &FLIPPED, false).unwrap();
    let value: Value = serde_json::from_slice(&text).unwrap();
    assert_eq!(value["asset"]["extras"], json!({ "π": [1, 2.5, null] }));
    let scene = read(&text).unwrap();
    assert_eq!((numbers(&scene), &scene.triangles[..]), (SQUARE.concat(), &FLIPPED[..]));
    let back = scene.document.with_triangles(&FLIPPED, &INDICES, true).unwrap();
    assert_eq!(back, bytes);
}

#[test]
fn every_primitive_keeps_its_own_index() {
    // The second primitive is a strip, with the same positions and a range of the same accessor's indices.
    let strip = json!({ "attributes": { "POSITION": 0 }, "indices": 2, "mode": 5 });
    let accessor =
        json!({ "bufferView": 1, "componentType": 5123, "count": 4, "type": "SCALAR", "byteOffset": 4 });
    let bytes = changed(&[("/meshes/0/primitives/-", strip), ("/accessors/-", accessor)]);
    let scene = read(&bytes).unwrap();
    // The strip has 2, 0, 2, 3: triangles 2-0-2 and 0-3-2, of vertices 0, 2 and 3.
    assert_eq!(scene.triangles, [0, 1, 2, 0, 2, 3, 5, 4, 5, 4, 6, 5]);
    assert_eq!(numbers(&scene)[12..], [SQUARE[0], SQUARE[2], SQUARE[3]].concat());
    let mut after = scene.triangles.clone();
    after[..6].copy_from_slice(&FLIPPED);
    after[6..9].copy_from_slice(&[4, 5, 6]);
    for is_binary in [true, false] {
        let written = scene.document.with_triangles(&scene.triangles, &after, is_binary).unwrap();
        let again = read(&written).unwrap();
        assert_eq!(again.triangles, after);
        assert_eq!(numbers(&again), numbers(&scene));
    }
}

#[test]
fn a_strip_and_a_fan_become_lists() {
    for (mode, read_as) in [(5, [0, 1, 2, 1, 3, 2]), (6, [1, 2, 0, 2, 3, 0])] {
        for indices in [Some(json!(1)), None] {
            let mut primitive = json!({ "attributes": { "POSITION": 0 }, "mode": mode });
            let mut accessor = square().0["accessors"][1].clone();
            accessor["count"] = 4.into();
            if let Some(indices) = indices {
                primitive["indices"] = indices;
            }
            let (mut json, _) = square();
            json["meshes"][0]["primitives"][0] = primitive;
            json["accessors"][1] = accessor;
            let buffer = [floats(&SQUARE), shorts(&[0, 1, 2, 3, 9, 9])].concat();
            let scene = read(&glb(&json, &buffer)).unwrap();
            assert_eq!(scene.triangles, read_as);
            for is_binary in [true, false] {
                let written = scene.document.with_triangles(&read_as, &FLIPPED, is_binary).unwrap();
                let again = read(&written).unwrap();
                assert_eq!((numbers(&again), again.triangles), (SQUARE.concat(), FLIPPED.to_vec()));
            }
        }
    }
}

#[test]
fn what_is_drawn_twice_is_read_once() {
    let bytes = changed(&[
        (
            "/meshes/-",
            json!({ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "mode": 4 }] }),
        ),
        ("/nodes/-", json!({ "mesh": 1, "translation": [5, 0, 0] })),
        ("/scenes/0/nodes", json!([0, 1])),
    ]);
    let scene = read(&bytes).unwrap();
    assert_eq!(scene.triangles.len(), 6);
    let after = scene.document.with_triangles(&INDICES, &FLIPPED, true).unwrap();
    assert_eq!(after.len(), bytes.len());
}

#[test]
fn nodes_place_a_mesh_and_stretch_it() {
    let turned = changed(&[
        ("/nodes/0", json!({ "children": [1], "scale": [2, 2, 2], "translation": [0, 0, 7] })),
        ("/nodes/-", json!({ "mesh": 0, "rotation": [0.0, 0.0, 0.70710677, 0.70710677] })),
    ]);
    let scene = read(&turned).unwrap();
    assert_eq!(numbers(&scene), SQUARE.concat());
    let in_scene = placed(&scene);
    for (found, expected) in in_scene.iter().zip([0., 0., 7., 0., 4., 7., -2., 4., 7., -2., 0., 7.]) {
        assert!((found - expected).abs() < 1e-6, "{in_scene:?}");
    }
    let stretched =
        changed(&[("/nodes/0/scale", json!([1, 4, 1])), ("/nodes/0/translation", json!([1, 0, 0]))]);
    let scene = read(&stretched).unwrap();
    assert_eq!(numbers(&scene), [0., 0., 0., 2., 0., 0., 2., 4., 0., 0., 4., 0.]);
    assert_eq!(placed(&scene)[..3], [1., 0., 0.]);
    let after = scene.document.with_triangles(&INDICES, &FLIPPED, true).unwrap();
    assert_eq!(after.len(), stretched.len());
}

#[test]
fn positions_may_be_sparse_and_integers() {
    let sparse = json!({
        "count": 1,
        "indices": { "bufferView": 1, "byteOffset": 2, "componentType": 5123 },
        "values": { "bufferView": 0, "byteOffset": 12 },
    });
    // The sparse part sets element 1 to (2, 0, 0), its old value. Without a buffer view, all other elements are zeros.
    assert_eq!(
        numbers(&read(&changed(&[("/accessors/0/sparse", sparse.clone())])).unwrap()),
        SQUARE.concat()
    );
    let (mut json, buffer) = square();
    let accessor = json!({ "componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse });
    json["accessors"][0] = accessor;
    assert_eq!(numbers(&read(&glb(&json, &buffer)).unwrap())[..6], [0.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    let (mut json, _) = square();
    json["accessors"][0] =
        json!({ "bufferView": 0, "componentType": 5122, "normalized": true, "count": 4, "type": "VEC3" });
    json["bufferViews"][0]["byteStride"] = 8.into();
    let position = |x: i16, y: i16| [x, y, -1, 9].into_iter().flat_map(i16::to_le_bytes).collect::<Vec<_>>();
    let positions = [position(0, 0), position(200, 0), position(200, 100), position(0, 100)].concat();
    let buffer = [positions, vec![0; 16], shorts(&INDICES)].concat();
    let scene = read(&glb(&json, &buffer)).unwrap();
    assert_eq!(numbers(&scene)[3..6], [200.0, 0.0, -1.0]);
}

#[test]
fn indices_may_be_sparse() {
    // The sparse part sets corner 2 to 3, and corner 3 to 1: the bytes of these indices are 3 of the first and 1.
    let sparse = json!({
        "count": 2,
        "indices": { "bufferView": 2, "componentType": 5121 },
        "values": { "bufferView": 2, "byteOffset": 2, "componentType": 5123 },
    });
    let (mut json, mut buffer) = square();
    buffer.extend([2, 3, 3, 0, 1, 0]);
    json["buffers"][0]["byteLength"] = 66.into();
    json["bufferViews"]
        .as_array_mut()
        .unwrap()
        .push(json!({ "buffer": 0, "byteOffset": 60, "byteLength": 6 }));
    json["accessors"][1]["sparse"] = sparse;
    let scene = read(&glb(&json, &buffer)).unwrap();
    assert_eq!(scene.triangles, FLIPPED);
    // The indices that are written are new, since the sparse part would change them.
    let after = scene.document.with_triangles(&FLIPPED, &INDICES, true).unwrap();
    assert_eq!(read(&after).unwrap().triangles, INDICES);
    // Without a buffer view, the other indices are 0.
    json["accessors"][1].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(read(&glb(&json, &buffer)).unwrap().triangles, [0, 0, 3, 1, 0, 0]);
    buffer[60] = 6;
    refused(&glb(&json, &buffer), "accessor 1: it has no element 6, which its sparse part changes");
    // Positions that have only a sparse part, of a primitive without indices.
    let (mut json, buffer) = square();
    json["accessors"][0] = json!({ "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {
        "count": 3,
        "indices": { "bufferView": 1, "componentType": 5123 },
        "values": { "bufferView": 0 },
    } });
    json["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
    let scene = read(&glb(&json, &buffer)).unwrap();
    assert_eq!((numbers(&scene), scene.triangles), (SQUARE[..3].concat(), vec![0, 1, 2]));
}

#[test]
fn indices_where_something_else_lies_are_not_overwritten() {
    let (mut json, buffer) = square();
    // An image uses the bytes of the indices.
    json["images"] = json!([{ "bufferView": 1, "mimeType": "image/png" }]);
    let bytes = glb(&json, &buffer);
    let scene = read(&bytes).unwrap();
    let after = scene.document.with_triangles(&INDICES, &FLIPPED, true).unwrap();
    assert!(after.windows(12).any(|window| window == shorts(&INDICES)));
    assert_eq!(read(&after).unwrap().triangles, FLIPPED);
    // Two meshes have different positions and the same indices.
    let accessor = json!({ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" });
    let mesh = json!({ "primitives": [{ "attributes": { "POSITION": 2 }, "indices": 1 }] });
    let bytes = changed(&[("/accessors/-", accessor), ("/meshes/-", mesh)]);
    let scene = read(&bytes).unwrap();
    assert_eq!(scene.triangles, [0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7]);
    let mut after = scene.triangles.clone();
    after[..6].copy_from_slice(&FLIPPED);
    let written = scene.document.with_triangles(&scene.triangles, &after, true).unwrap();
    assert_eq!(read(&written).unwrap().triangles, after);
}

#[test]
fn triangles_that_are_none_of_the_file_are_refused() {
    let scene = read(&changed(&[])).unwrap();
    let found = scene.document.with_triangles(&INDICES, &[0, 1, 3, 1, 2, 4], true).unwrap_err();
    assert_eq!(found.to_string(), "triangle 1: vertex 4 is of another primitive");
    // The reader accepts an array for an object: a buffer's length, its URI, and its extensions.
    let scene = read(&changed(&[("/buffers/0", json!([60, null, null, {}]))])).unwrap();
    let found = scene.document.with_triangles(&INDICES, &FLIPPED, false).unwrap_err();
    assert_eq!(found.to_string(), "JSON: expected an object, found an array");
}

#[test]
fn indices_that_their_type_does_not_hold_get_another() {
    let mut positions = SQUARE.to_vec();
    positions.extend([[5.0, 5.0, 0.0]; 300]);
    let (mut json, _) = square();
    json["accessors"][0]["count"] = positions.len().into();
    json["accessors"][1]["componentType"] = 5121.into();
    json["bufferViews"][0]["byteLength"] = (12 * positions.len()).into();
    json["bufferViews"][1] = json!({ "buffer": 0, "byteOffset": 12 * positions.len(), "byteLength": 6 });
    json["buffers"][0]["byteLength"] = (12 * positions.len() + 6).into();
    let scene = read(&glb(&json, &[floats(&positions), INDICES.map(|i| i as u8).to_vec()].concat())).unwrap();
    for last in [2, 254, 255, 303] {
        let after = [0, 1, 3, 1, last, 3];
        let written = scene.document.with_triangles(&scene.triangles, &after, true).unwrap();
        assert_eq!(read(&written).unwrap().triangles, after);
    }
}

#[test]
fn a_new_file_is_read_as_it_was_written() {
    let positions = SQUARE.concat();
    let mesh = Mesh::new(Dimension::Three, positions.clone(), INDICES.to_vec()).unwrap();
    let flat = Mesh::new(Dimension::Two, vec![0f32, 0.1, 1.0, 0.0, -0.0, 1.0], vec![2, 0, 1]).unwrap();
    let points = Mesh::new(Dimension::Three, positions.clone(), Vec::new()).unwrap();
    let nothing = Mesh::new(Dimension::Three, Vec::<f32>::new(), Vec::new()).unwrap();
    for is_binary in [true, false] {
        let scene = read(&new_file(&mesh, is_binary).unwrap()).unwrap();
        assert_eq!((numbers(&scene), &scene.triangles[..]), (positions.clone(), &INDICES[..]));
        let scene = read(&new_file(&flat, is_binary).unwrap()).unwrap();
        assert_eq!(numbers(&scene), [0.0, 0.1, 0.0, 1.0, 0.0, 0.0, -0.0, 1.0, 0.0]);
        assert_eq!(scene.triangles, [2, 0, 1]);
        for mesh in [&points, &nothing] {
            assert!(read(&new_file(mesh, is_binary).unwrap()).unwrap().triangles.is_empty());
        }
    }
    let large = Mesh::new(Dimension::Two, vec![0.0, 0.0, 1e300, 0.0, 0.0, 1.0], vec![0, 1, 2]).unwrap();
    let found = new_file(&large, true).unwrap_err().to_string();
    assert_eq!(found, "vertex 1 is too far away for the 32-bit numbers of glTF; write PLY, OBJ or OFF");
}

#[test]
fn buffers_beside_the_file_are_read_if_that_is_allowed() {
    let (mut json, buffer) = square();
    json["buffers"][0]["uri"] = "a%20b.bin".into();
    let text = json.to_string();
    refused(text.as_bytes(), "buffer 0: it is in the file `a b.bin`: not allowed");
    let given = |name: &str| if name == "a b.bin" { Ok(buffer.clone()) } else { denied(name) };
    let scene = parse(text.clone().into_bytes(), &given, 1 << 20).unwrap();
    assert_eq!(scene.triangles, INDICES);
    let after = scene.document.with_triangles(&INDICES, &FLIPPED, false).unwrap();
    assert_eq!(read(&after).unwrap().triangles, FLIPPED);
    let same = scene.document.with_triangles(&INDICES, &INDICES, false).unwrap();
    assert_eq!(same, text.as_bytes());
    for elsewhere in
        ["../a.bin", "/etc/passwd", "a/%2e%2e/b", "https://example.org/a.bin", "C:\\a.bin", "file:a"]
    {
        json["buffers"][0]["uri"] = elsewhere.into();
        let message = format!("buffer 0: `{}` is not a file beside this one", elsewhere.escape_default());
        let anything = |_: &str| Ok(buffer.clone());
        let found = parse(json.to_string().into_bytes(), &anything, 1 << 20).err().unwrap().to_string();
        assert_eq!(found, message);
    }
}

/// The scheme and the mark `;base64` may be in upper or lower case.
#[test]
fn data_uris_may_be_in_upper_or_lower_case() {
    let (mut json, buffer) = square();
    let uri = crate::io::gltf::buffers::data_uri(&buffer);
    for uri in [
        uri.clone(),
        uri.replace("data:", "DATA:"),
        uri.replace("data:", "Data:").replace(";base64", ";BASE64"),
    ] {
        json["buffers"][0]["uri"] = uri.into();
        assert_eq!(read(json.to_string().as_bytes()).unwrap().triangles, INDICES);
    }
}

#[test]
fn compressed_primitives_are_left() {
    let draco = json!({ "KHR_draco_mesh_compression": { "bufferView": 0, "attributes": {} } });
    let primitive = json!({ "attributes": { "POSITION": 0 }, "indices": 1, "extensions": draco });
    let scene = read(&changed(&[("/meshes/0/primitives/-", primitive.clone())])).unwrap();
    assert_eq!(scene.notes, ["compressed primitives, left as they are: 1"]);
    assert_eq!(scene.triangles, INDICES);
    let message = "meshes: its meshes are compressed (KHR_draco_mesh_compression or EXT_meshopt_compression); \
                   uncompress the file first, for example with glTF-Transform";
    refused(&changed(&[("/meshes/0/primitives/0", primitive)]), message);
    let packed = json!({ "EXT_meshopt_compression": { "buffer": 0 } });
    refused(&changed(&[("/bufferViews/1/extensions", packed)]), message);
}
