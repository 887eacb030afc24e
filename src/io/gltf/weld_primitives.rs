//! Finds vertices at the same position, and which of these have the same attributes.

use super::accessors::Accessors;
use super::container::Container;
use super::document::{Document, Part};
use super::root::{deserialized, json};
use crate::prepare::weld::{first_alike, position_bits};
use crate::{Error, Mesh, Welded};
use serde::Deserialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The part of the JSON that lists the attributes of vertices, including names that glTF does not define.
#[derive(Deserialize)]
struct Meshes {
    #[serde(default)]
    meshes: Vec<Primitives>,
}

#[derive(Deserialize)]
struct Primitives {
    #[serde(default)]
    primitives: Vec<Vertices>,
}

#[derive(Deserialize)]
struct Vertices {
    attributes: BTreeMap<String, Value>,
    /// Morph targets.
    #[serde(default)]
    targets: Option<Vec<BTreeMap<String, Value>>>,
}

impl Document {
    /// The mesh with the vertices of each part joined that are at the same position. `mesh` has the vertices that were
    /// read.
    ///
    /// # Errors
    /// [`Error::Parse`] for an array in the JSON where an object is expected: the reader accepts some of these.
    pub(in crate::io) fn welded(&self, mesh: &Mesh) -> Result<Welded, Error> {
        let container = Container::of(&self.bytes)?;
        let text = &self.bytes[container.json.clone()];
        let root = json(text)?;
        let Meshes { meshes } = deserialized(text)?;
        let buffers = self.buffers(&root, &container)?;
        let accessors = Accessors { root: &root, buffers: &buffers };
        let (mut places, mut attributes) = (Vec::new(), Vec::new());
        for part in &self.parts {
            let start = part.vertices.start as u32;
            let end = part.vertices.end as u32;
            let positions = (start..end).map(|v| position_bits(mesh, v));
            places.extend(first_alike(positions).iter().map(|v| start + v));
            attributes.extend(part.attributes(&meshes, &accessors));
        }
        Welded::new(mesh, places, &attributes)
    }
}

impl Part {
    /// For each vertex, the first one with the same bytes in all accessors of all its primitives, except positions. If
    /// an accessor cannot be read, every vertex counts as different.
    fn attributes(&self, meshes: &[Primitives], accessors: &Accessors) -> Vec<u32> {
        let every: Vec<u32> = (0..self.vertices.len() as u32).collect();
        let elements = self.elements.as_ref().unwrap_or(&every);
        let mut named = BTreeSet::new();
        for &[mesh, primitive] in &self.users {
            let vertices = meshes.get(mesh).and_then(|mesh| mesh.primitives.get(primitive));
            let Some(Vertices { attributes, targets }) = vertices else { return every };
            let attributes = attributes.iter().filter(|(name, _)| *name != "POSITION");
            named.extend(
                attributes.chain(targets.iter().flatten().flatten()).map(|(_, value)| value.as_u64()),
            );
        }
        let mut alike = vec![0; every.len()];
        for accessor in named {
            let bytes = accessor.and_then(|accessor| accessors.bytes(accessor as usize, elements).ok());
            let Some(bytes) = bytes else { return every };
            alike = first_alike(alike.into_iter().zip(bytes));
        }
        alike
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::gltf::container::glb;
    use crate::io::{Format, Loaded, ReadOptions, parse};
    use serde_json::json;

    /// A square of two triangles without a common vertex: corners 0 and 3 have the same position, and so do 2 and 4.
    const CORNERS: [[f32; 3]; 6] =
        [[0., 0., 0.], [2., 0., 0.], [2., 1., 0.], [0., 0., -0.], [2., 1., 0.], [0., 1., 0.]];

    /// A file with these accessors of floats and these primitives.
    fn file(accessors: &[(&str, &[f32])], primitives: &Value) -> (Value, Vec<u8>) {
        let mut json = json!({
            "asset": { "version": "2.0" },
            "meshes": [{ "primitives": primitives }],
            "accessors": [], "bufferViews": [], "buffers": [{}],
        });
        let mut buffer = Vec::new();
        let push = |array: &mut Value, value: Value| array.as_array_mut().unwrap().push(value);
        for (view, (kind, numbers)) in accessors.iter().enumerate() {
            let (start, length) = (buffer.len(), 4 * numbers.len());
            let count = numbers.len() / if *kind == "SCALAR" { 1 } else { 3 };
            let accessor = json!({ "bufferView": view, "componentType": 5126, "count": count, "type": kind });
            push(&mut json["accessors"], accessor);
            push(&mut json["bufferViews"], json!({ "buffer": 0, "byteOffset": start, "byteLength": length }));
            buffer.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        }
        json["buffers"][0]["byteLength"] = buffer.len().into();
        (json, buffer)
    }

    fn read((json, buffer): &(Value, Vec<u8>)) -> Loaded {
        let bytes = glb(json.to_string().as_bytes(), Some(buffer), &[]).unwrap();
        parse(Format::Glb, bytes, &ReadOptions::default()).unwrap()
    }

    /// Whether the diagonal is a seam.
    fn is_seam(file: &(Value, Vec<u8>)) -> bool {
        let welded = read(file).welded().unwrap();
        assert_eq!(welded.mesh.triangles(), [0, 1, 2, 0, 2, 5]);
        assert!(welded.wedges.locked_triangles().is_empty());
        !welded.wedges.locked_edges().is_empty()
    }

    fn square(numbers: &[f32; 6], primitives: Value) -> (Value, Vec<u8>) {
        file(&[("VEC3", CORNERS.as_flattened()), ("SCALAR", numbers)], &primitives)
    }

    const ALIKE: [f32; 6] = [1., 2., 3., 1., 3., 4.];
    const OTHER: [f32; 6] = [1., 2., 3., 5., 3., 4.];

    #[test]
    fn a_primitive_without_indices_gets_some() {
        let file = square(&ALIKE, json!([{ "attributes": { "POSITION": 0, "_HEAT": 1 } }]));
        let loaded = read(&file);
        let welded = loaded.welded().unwrap();
        assert_eq!((welded.joined(), welded.wedges.locked_edges().len()), (2, 0));
        assert_eq!(welded.split(welded.mesh.triangles()).unwrap(), loaded.mesh.triangles());
        let flipped = welded.split(&[0, 1, 5, 1, 2, 5]).unwrap();
        assert_eq!(flipped, [0, 1, 5, 1, 4, 5]);
        let again = loaded.file_bytes("out.glb", flipped.clone()).unwrap();
        let again = parse(Format::Glb, again, &ReadOptions::default()).unwrap();
        assert_eq!((again.mesh.positions(), again.mesh.triangles()), (loaded.mesh.positions(), &flipped[..]));
    }

    #[test]
    fn different_attributes_make_seams() {
        for name in ["TEXCOORD_0", "COLOR_0", "_HEAT", "OF_NO_STANDARD"] {
            let primitive = json!([{ "attributes": { "POSITION": 0, name: 1 } }]);
            assert!(!is_seam(&square(&ALIKE, primitive.clone())), "{name}");
            assert!(is_seam(&square(&OTHER, primitive)), "{name}");
        }
        let target = json!([{ "attributes": { "POSITION": 0 }, "targets": [{ "COLOR_0": 1 }, {}] }]);
        assert!(!is_seam(&square(&ALIKE, target.clone())));
        assert!(is_seam(&square(&OTHER, target)));
    }

    /// Two primitives with the same triangles are one part: the attributes of both count.
    #[test]
    fn all_primitives_of_the_same_triangles_count() {
        let primitives =
            json!([{ "attributes": { "POSITION": 0 } }, { "attributes": { "POSITION": 0, "COLOR_0": 1 } }]);
        assert!(!is_seam(&square(&ALIKE, primitives.clone())));
        assert!(is_seam(&square(&OTHER, primitives)));
    }

    #[test]
    fn sparse_parts_count() {
        let mut file = square(&OTHER, json!([{ "attributes": { "POSITION": 0, "_HEAT": 1 } }]));
        let start = file.1.len();
        file.1.extend([3, 0, 0, 0]);
        file.1.extend(1.0f32.to_le_bytes());
        file.0["buffers"][0]["byteLength"] = file.1.len().into();
        for offset in [start, start + 4] {
            let view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": 4 });
            file.0["bufferViews"].as_array_mut().unwrap().push(view);
        }
        assert!(is_seam(&file));
        file.0["accessors"][1]["sparse"] = json!({
            "count": 1, "indices": { "bufferView": 2, "componentType": 5121 }, "values": { "bufferView": 3 },
        });
        assert!(!is_seam(&file));
        file.0["accessors"][1].as_object_mut().unwrap().remove("bufferView");
        assert!(is_seam(&file));
    }

    /// Accessors with too few elements, without data, and with compressed data.
    #[test]
    fn unreadable_attributes_make_seams() {
        let primitives = json!([{ "attributes": { "POSITION": 0, "_HEAT": 1 } }]);
        let with = |change: &dyn Fn(&mut Value)| {
            let mut file = square(&ALIKE, primitives.clone());
            change(&mut file.0);
            is_seam(&file)
        };
        assert!(!with(&|_| {}));
        assert!(with(&|json| json["accessors"][1]["count"] = 5.into()));
        assert!(with(&|json| json["accessors"][1]["count"] = 7.into()));
        assert!(with(&|json| json["accessors"][1]["bufferView"] = 9.into()));
        assert!(with(&|json| json["meshes"][0]["primitives"][0]["attributes"]["_HEAT"] = 9.into()));
        assert!(with(&|json| {
            json["bufferViews"][1]["extensions"] = json!({ "EXT_meshopt_compression": {} });
        }));
    }

    /// Two primitives with equal positions stay apart.
    #[test]
    fn primitives_are_not_joined() {
        let file = file(
            &[("VEC3", CORNERS.as_flattened()), ("VEC3", CORNERS.as_flattened())],
            &json!([{ "attributes": { "POSITION": 0 } }, { "attributes": { "POSITION": 1 } }]),
        );
        let welded = read(&file).welded().unwrap();
        assert_eq!(welded.mesh.triangles(), [0, 1, 2, 0, 2, 5, 6, 7, 8, 6, 8, 11]);
        assert_eq!(welded.places, [0, 1, 2, 0, 2, 5, 6, 7, 8, 6, 8, 11]);
        assert!(welded.wedges.locked_edges().is_empty());
    }
}
