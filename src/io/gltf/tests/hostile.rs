//! Tests of wrong glTF files: which errors the reader reports, and which it ignores.

use super::*;
use proptest::prelude::*;

#[test]
fn errors_of_hostile_files_name_their_location() {
    let huge = json!(u64::MAX);
    for (pointer, value, message) in [
        (
            "/accessors/1/count",
            huge.clone(),
            "accessor 1: it needs 18446744073709551615 bytes of buffer view 1, which has 12",
        ),
        (
            "/accessors/1/byteOffset",
            huge.clone(),
            "accessor 1: it needs 18446744073709551615 bytes of buffer view 1, which has 12",
        ),
        ("/accessors/1/byteOffset", json!(1), "accessor 1: it needs 13 bytes of buffer view 1, which has 12"),
        (
            "/bufferViews/1/byteOffset",
            huge.clone(),
            "accessor 1: it needs 18446744073709551615 bytes of buffer 0, which has 60",
        ),
        (
            "/bufferViews/1/byteStride",
            json!(1),
            "accessor 1: elements of 2 bytes lie 1 bytes apart in buffer view 1",
        ),
        ("/bufferViews/1/buffer", json!(3), "accessor 1: there is no buffer 3"),
        ("/accessors/1/bufferView", json!(9), "accessor 1: there is no buffer view 9"),
        (
            "/accessors/1/componentType",
            json!(5126),
            "accessor 1: indices are not unsigned integers of type SCALAR",
        ),
        ("/accessors/1/componentType", json!(1), "accessor 1: its component type is not known"),
        (
            "/accessors/0/count",
            json!(3),
            "mesh 0, primitive 0: it names element 3 of accessor 0, which has 3",
        ),
        ("/accessors/0/type", json!("VEC2"), "accessor 0: positions are not of type VEC3"),
        ("/meshes/0/primitives/0/indices", json!(7), "accessor 7: out of range, the file has 2"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(7), "accessor 7: out of range, the file has 2"),
        ("/meshes/0/primitives/0/mode", json!(70), "mesh 0, primitive 0: its mode is not known"),
        ("/nodes/0/mesh", json!(5), "node 0: there is no mesh 5"),
        (
            "/accessors/1/count",
            json!("6"),
            "JSON, accessors[1].count: invalid type: string \"6\", expected u64 at line 1 column 304",
        ),
        ("/nodes/0/children", json!([4]), "node 4: out of range, the file has 1"),
        (
            "/buffers/0/uri",
            json!("data:;base64,AAAA"),
            "accessor 1: it needs 60 bytes of buffer 0, which has 3",
        ),
        (
            "/buffers/0/uri",
            json!("data:;base64,?"),
            "buffer 0: its data URI is not valid base64: Invalid symbol 63, offset 0.",
        ),
        (
            "/asset/version",
            json!("1.0"),
            "asset: the file has glTF version `1.0`, only version 2 is supported",
        ),
    ] {
        refused(&changed(&[(pointer, value)]), message);
    }
    let count = json!({ "componentType": 5126, "count": 4_000_000_000u64, "type": "VEC3" });
    refused(
        &changed(&[("/accessors/0", count)]),
        "mesh 0, primitive 0: the meshes up to here take 48000000000 bytes, more than the 1048576 allowed",
    );
    let count = json!({ "componentType": 5126, "count": 70_000, "type": "VEC3" });
    refused(
        &changed(&[("/accessors/0", count)]),
        "accessor 0: it announces 70000 elements and has no data for them",
    );
    // Many meshes that all read the same bytes.
    let mut changes = Vec::new();
    for number in 0..20_000 {
        let accessor = json!({ "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" });
        let primitive = json!({ "attributes": { "POSITION": number + 2 }, "indices": 1 });
        changes.extend([("/accessors/-", accessor), ("/meshes/0/primitives/-", primitive)]);
    }
    let found = read(&changed(&changes)).err().unwrap().to_string();
    assert!(found.contains("more than the 1048576 allowed"), "{found}");
    for no_object in ["[1]", "null", "7"] {
        assert!(read(no_object.as_bytes()).err().unwrap().to_string().starts_with("JSON, "), "{no_object}");
    }
    let deep = "[".repeat(100_000);
    let found = read(deep.as_bytes()).err().unwrap().to_string();
    assert!(found.starts_with("JSON, "), "{found}");
}

#[test]
fn what_is_wrong_elsewhere_does_not_matter() {
    for (pointer, value) in [
        ("/materials", json!([{ "pbrMetallicRoughness": ["not an object"] }])),
        ("/cameras", json!("none")),
        ("/scene", json!("hello")),
        ("/scenes/-", json!({})),
    ] {
        assert_eq!(read(&changed(&[(pointer, value)])).unwrap().triangles, INDICES);
    }
    let scene =
        read(&changed(&[("/nodes/0/children", json!([0, 1])), ("/nodes/-", json!({ "children": [0] }))]));
    assert_eq!(scene.unwrap().notes, ["nodes with two parents or among their own descendants, used once: 2"]);
}

#[test]
fn a_deep_graph_is_no_deep_recursion() {
    let (mut json, buffer) = square();
    let last = 200_000;
    json["nodes"] = (0..last).map(|i| json!({ "children": [i + 1] })).collect();
    json["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0 }));
    assert_eq!(read(&glb(&json, &buffer)).unwrap().triangles, INDICES);
}

#[test]
fn broken_containers_are_refused() {
    let bytes = changed(&[]);
    for (at, value, message) in [
        (4, 1u32, "byte 4: the file has glTF version 1, only version 2 is supported"),
        (
            8,
            1 << 30,
            "byte 8: the header announces 1073741824 bytes, the file has 720; it may have been cut off",
        ),
        (8, 0, "byte 12: there is no JSON chunk"),
        (12, u32::MAX, "byte 12: a chunk announces 4294967295 bytes, 700 are left"),
        (16, 0, "byte 16: the first chunk is not the JSON"),
    ] {
        let mut broken = bytes.clone();
        broken[at..at + 4].copy_from_slice(&value.to_le_bytes());
        let found = read(&broken).err().unwrap().to_string();
        let length = bytes.len().to_string();
        assert_eq!(found, message.replace("720", &length).replace("700", &(bytes.len() - 20).to_string()));
    }
    for end in 0..bytes.len() {
        assert!(read(&bytes[..end]).is_err(), "cut off at {end}");
    }
}

proptest! {
    #[test]
    fn mutated_files_never_panic(
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        is_binary: bool,
    ) {
        let bytes = changed(&[]);
        let mut bytes = if is_binary {
            bytes
        } else {
            read(&bytes).unwrap().document.with_triangles(&INDICES, &FLIPPED, false).unwrap()
        };
        for (at, value) in edits {
            let at = at.index(bytes.len());
            // Digits and punctuation keep more of the JSON valid.
            bytes[at] = if value < 128 { b"0123456789[]{}\",:-.e"[value as usize % 20] } else { value };
        }
        if let Ok(scene) = read(&bytes) {
            let mut after = scene.triangles.clone();
            after.reverse();
            let parts = &scene.document.parts;
            if parts.len() == 1 {
                let written = scene.document.with_triangles(&scene.triangles, &after, is_binary).unwrap();
                prop_assert_eq!(read(&written).unwrap().triangles, after);
            }
        }
    }
}

#[test]
fn a_file_named_many_times_counts_as_often() {
    let (mut json, _) = square();
    json["buffers"] = json!(vec![json!({ "byteLength": 60, "uri": "a" }); 9]);
    let read = |_: &str| Ok(vec![0; 1 << 17]);
    let error = parse(json.to_string().into_bytes(), &read, 1 << 20).err().unwrap();
    let message = "buffer 8: it is in the file `a`: the buffers up to here take 1179648 bytes, more than the 1048576 allowed";
    assert_eq!(error.to_string(), message);
}

#[test]
fn a_message_has_one_line_whatever_the_names() {
    let found =
        read(br#"{"asset":{"version":"2.0"},"nodes":[{"extensions":{"a\nb":1e999}}]}"#).err().unwrap();
    let message = "JSON, nodes[0].extensions.a\u{fffd}b: number out of range at line 1 column 63";
    assert_eq!(found.to_string(), message);
}
