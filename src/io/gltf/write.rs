//! Writes a held glTF file with other indices, or a new file.
//!
//! New indices overwrite the old ones if nothing else uses these bytes, so that no other byte changes. If not, the
//! primitive gets a new accessor.

use super::accessors::{Accessors, component};
use super::buffers::{Buffers, data_uri, is_in_other_file};
use super::container::{Container, glb};
use super::document::{Document, Part};
use super::errors::refuse;
use super::root::{json, uses};
use crate::io::rounded::rounded;
use crate::{Error, Mesh};
use gltf::json::accessor::ComponentType;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::io;
use std::ops::Range;

const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const ARRAY_BUFFER: u32 = 34962;
const TRIANGLES: u32 = 4;

impl Document {
    /// The bytes of the file with the triangles `after` instead of `before`, as `.glb` or as `.gltf`. Vertices,
    /// materials and everything else stay. A change of the form moves buffers.
    ///
    /// # Errors
    /// [`Error::TooLarge`] for a `.glb` file of 4 GiB or more; [`Error::Parse`].
    pub(in crate::io) fn with_triangles(
        &self,
        before: &[u32],
        after: &[u32],
        is_binary: bool,
    ) -> Result<Vec<u8>, Error> {
        let container = Container::of(&self.bytes)?;
        let text = &self.bytes[container.json.clone()];
        let root = json(text)?;
        let buffers = self.buffers(&root, &container)?;
        let accessors = Accessors { root: &root, buffers: &buffers };
        let mut file = File { buffers: &buffers, changed: BTreeMap::new(), appended: Vec::new() };
        let is_alone = alone(&accessors, &self.parts);
        for part in &self.parts {
            let range = 3 * part.triangles.start..3 * part.triangles.end;
            if before[range.clone()] != after[range.clone()] {
                let indices = part.elements_of(&after[range])?;
                match part.indices.filter(|&accessor| is_alone[accessor]) {
                    Some(accessor) if accessors.can_hold(accessor, &indices)? => {
                        file.overwrite(&accessors, accessor, &indices)?;
                    }
                    _ => file.appended.push((part, indices)),
                }
            }
        }
        for (index, buffer) in root.buffers.iter().enumerate() {
            if self.embeds && buffer.uri.as_deref().is_some_and(is_in_other_file) {
                file.changed.entry(index).or_insert_with(|| buffers[index].to_vec());
            }
        }
        let is_in_chunk = |buffer: usize| buffer == 0 && root.buffers[0].uri.is_none();
        let is_same_form = is_binary == container.is_binary;
        if is_same_form && file.appended.is_empty() && file.changed.keys().all(|&buffer| is_in_chunk(buffer))
        {
            let mut bytes = self.bytes.clone();
            if let (Some(changed), Some(chunk)) = (file.changed.get(&0), container.binary) {
                bytes[chunk][..changed.len()].copy_from_slice(changed);
            }
            return Ok(bytes);
        }
        let mut root: Value =
            serde_json::from_slice(text).map_err(|error| refuse("JSON", error.to_string()))?;
        let others: Vec<&[u8]> = container.others.iter().map(|range| &self.bytes[range.clone()]).collect();
        // The reader accepts an array for an object.
        let meshes = root["meshes"].as_array().into_iter().flatten();
        let primitives = meshes.flat_map(|mesh| mesh["primitives"].as_array().into_iter().flatten());
        let buffers = root["buffers"].as_array().into_iter().flatten();
        if !root.is_object() || !primitives.chain(buffers).all(Value::is_object) {
            return Err(refuse("JSON", "expected an object, found an array"));
        }
        file.finish(&mut root, is_binary, &others)
    }
}

impl Part {
    /// The elements of the accessor of positions for the corners of its triangles.
    ///
    /// # Errors
    /// [`Error::Parse`] for a vertex of another part.
    fn elements_of(&self, corners: &[u32]) -> Result<Vec<u32>, Error> {
        let element = |(i, &vertex): (usize, &u32)| {
            if !self.vertices.contains(&(vertex as usize)) {
                let location = format!("triangle {}", self.triangles.start + i / 3);
                return Err(refuse(location, format!("vertex {vertex} is of another primitive")));
            }
            let rank = vertex as usize - self.vertices.start;
            Ok(self.elements.as_ref().map_or(rank as u32, |elements| elements[rank]))
        };
        corners.iter().enumerate().map(element).collect()
    }
}

/// For each accessor, whether it has the indices of only one part and nothing else uses its bytes.
fn alone(accessors: &Accessors, parts: &[Part]) -> Vec<bool> {
    let root = accessors.root;
    let uses = uses(root, |primitive| Some(primitive.indices?.value()));
    let mut is_alone = vec![false; root.accessors.len()];
    for part in parts {
        if let Some(accessor) = part.indices {
            is_alone[accessor] =
                uses[accessor] == part.users.len() && root.accessors[accessor].sparse.is_none();
        }
    }
    // What overlaps lies in one run.
    let mut claims = claims(accessors);
    claims.sort_unstable_by_key(|claim| (claim.buffer, claim.bytes.start));
    let mut start = 0;
    let mut end = 0;
    for i in 0..claims.len() {
        let claim = &claims[i];
        if i == 0 || claim.buffer != claims[i - 1].buffer || claim.bytes.start >= end {
            (start, end) = (i, claim.bytes.end);
            continue;
        }
        end = end.max(claim.bytes.end);
        for claim in [&claims[start], &claims[i - 1], claim] {
            claim.accessor.inspect(|&accessor| is_alone[accessor] = false);
        }
    }
    is_alone
}

/// Bytes that an accessor, an image or a sparse part uses.
struct Claim {
    buffer: usize,
    bytes: Range<usize>,
    accessor: Option<usize>,
}

fn claims(accessors: &Accessors) -> Vec<Claim> {
    let Accessors { root, .. } = accessors;
    let mut claims = Vec::new();
    let mut views: Vec<usize> =
        root.images.iter().filter_map(|image| Some(image.buffer_view?.value())).collect();
    for (index, accessor) in root.accessors.iter().enumerate() {
        if let Ok(Some(elements)) = accessors.elements(index) {
            claims.push(Claim { buffer: elements.buffer, bytes: elements.bytes, accessor: Some(index) });
        }
        if let Some(sparse) = &accessor.sparse {
            views.extend([sparse.indices.buffer_view.value(), sparse.values.buffer_view.value()]);
        }
    }
    for view in views.into_iter().filter_map(|view| root.buffer_views.get(view)) {
        let start = view.byte_offset.unwrap_or_default().0 as usize;
        let bytes = start..start.saturating_add(view.byte_length.0 as usize);
        claims.push(Claim { buffer: view.buffer.value(), bytes, accessor: None });
    }
    claims.retain(|claim| !claim.bytes.is_empty());
    claims
}

/// Changes to a file.
struct File<'a> {
    buffers: &'a Buffers<'a>,
    /// Buffers with changed bytes.
    changed: BTreeMap<usize, Vec<u8>>,
    /// Parts that get a new accessor, with its indices.
    appended: Vec<(&'a Part, Vec<u32>)>,
}

impl File<'_> {
    fn overwrite(&mut self, accessors: &Accessors, accessor: usize, indices: &[u32]) -> Result<(), Error> {
        let Some(elements) = accessors.elements(accessor)? else { return Ok(()) };
        let component = component(accessors.get(accessor)?, || format!("accessor {accessor}"))?;
        let stride = elements.stride;
        let buffer =
            self.changed.entry(elements.buffer).or_insert_with(|| self.buffers[elements.buffer].to_vec());
        for (slot, &index) in buffer[elements.bytes].chunks_mut(stride).zip(indices) {
            slot[..component.size()].copy_from_slice(&index.to_le_bytes()[..component.size()]);
        }
        Ok(())
    }

    /// Writes the changes into the JSON, and returns the bytes of the file.
    fn finish(mut self, root: &mut Value, is_binary: bool, others: &[&[u8]]) -> Result<Vec<u8>, Error> {
        let mut buffers = take(root, "buffers");
        // The first buffer is the binary chunk, if its bytes are known.
        let mut chunk = (is_binary && self.buffers.has(0))
            .then(|| self.changed.remove(&0).unwrap_or_else(|| self.buffers[0].to_vec()));
        if !self.appended.is_empty() {
            let home = if chunk.is_some() { 0 } else { buffers.len() };
            let mut bytes = chunk.take().unwrap_or_default();
            for (part, indices) in &self.appended {
                append(root, home, &mut bytes, part, indices);
            }
            if is_binary && home == 0 {
                chunk = Some(bytes);
            } else {
                self.changed.insert(home, bytes);
            }
            buffers.resize(buffers.len().max(home + 1), json!({}));
        }
        if !is_binary && self.buffers.has(0) && buffers[0].get("uri").is_none() {
            self.changed.entry(0).or_insert_with(|| self.buffers[0].to_vec());
        }
        for (index, bytes) in &self.changed {
            buffers[*index]["byteLength"] = bytes.len().into();
            buffers[*index]["uri"] = data_uri(bytes).into();
        }
        if let (Some(bytes), Some(Value::Object(buffer))) = (&chunk, buffers.first_mut()) {
            buffer.insert("byteLength".into(), bytes.len().into());
            buffer.shift_remove("uri");
        }
        put(root, "buffers", buffers);
        let text = root.to_string();
        if is_binary { glb(text.as_bytes(), chunk.as_deref(), others) } else { Ok(text.into_bytes()) }
    }
}

/// Appends indices to a buffer, and adds an accessor for them, which the primitives of the part use.
fn append(root: &mut Value, buffer: usize, bytes: &mut Vec<u8>, part: &Part, indices: &[u32]) {
    // The largest number of a type is reserved: it restarts a strip.
    let is_short = indices.iter().all(|&index| index < u32::from(u16::MAX));
    let component = if is_short { ComponentType::U16 } else { ComponentType::U32 };
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let start = bytes.len();
    bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes().into_iter().take(component.size())));
    let mut views = take(root, "bufferViews");
    let view = views.len();
    views.push(json!({
        "buffer": buffer, "byteOffset": start, "byteLength": bytes.len() - start, "target": ELEMENT_ARRAY_BUFFER,
    }));
    put(root, "bufferViews", views);
    let mut accessors = take(root, "accessors");
    let accessor = accessors.len();
    accessors.push(json!({
        "bufferView": view, "componentType": component.as_gl_enum(), "count": indices.len(), "type": "SCALAR",
    }));
    put(root, "accessors", accessors);
    for [mesh, primitive] in &part.users {
        if let Some(primitive) = root.pointer_mut(&format!("/meshes/{mesh}/primitives/{primitive}")) {
            primitive["indices"] = accessor.into();
            if primitive.get("mode").is_some() {
                primitive["mode"] = TRIANGLES.into();
            }
        }
    }
}

/// Takes an array out of the JSON. Its key stays, so the order of the keys does not change.
fn take(root: &mut Value, name: &str) -> Vec<Value> {
    match root.get_mut(name).map(Value::take) {
        Some(Value::Array(array)) => array,
        _ => Vec::new(),
    }
}

/// Puts an array back, unless it is empty: glTF forbids empty arrays.
fn put(root: &mut Value, name: &str, array: Vec<Value>) {
    if !array.is_empty() {
        root[name] = array.into();
    }
}

/// The bytes of a new file with one mesh. Without triangles, its vertices are points.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for a `.glb` file of 4 GiB or more, and for coordinates too large for 32-bit floats.
pub(in crate::io) fn new_file(mesh: &Mesh, is_binary: bool) -> io::Result<Vec<u8>> {
    let mut root = json!({ "asset": { "version": "2.0", "generator": "edgeflip" } });
    let mut bytes = Vec::new();
    if mesh.vertex_count() > 0 {
        let positions = rounded(mesh, "glTF")?;
        bytes.extend(positions.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
        let bound = |pick: fn(f32, f32) -> f32| -> [f32; 3] {
            std::array::from_fn(|axis| positions.iter().map(|p| p[axis]).reduce(pick).unwrap_or_default())
        };
        root["scene"] = 0.into();
        root["scenes"] = json!([{ "nodes": [0] }]);
        root["nodes"] = json!([{ "mesh": 0 }]);
        root["meshes"] = json!([{ "primitives": [{ "attributes": { "POSITION": 0 }, "mode": 0 }] }]);
        root["accessors"] = json!([{
            "bufferView": 0, "componentType": ComponentType::F32.as_gl_enum(), "count": positions.len(), "type": "VEC3",
            "min": bound(f32::min), "max": bound(f32::max),
        }]);
        root["bufferViews"] = json!([{ "buffer": 0, "byteLength": bytes.len(), "target": ARRAY_BUFFER }]);
        root["buffers"] = json!([{}]);
        if mesh.triangle_count() > 0 {
            let part = Part { users: vec![[0, 0]], ..Part::default() };
            append(&mut root, 0, &mut bytes, &part, mesh.triangles());
        }
        root["buffers"][0]["byteLength"] = bytes.len().into();
        if !is_binary {
            root["buffers"][0]["uri"] = data_uri(&bytes).into();
        }
    }
    let text = root.to_string();
    if is_binary {
        glb(text.as_bytes(), (!bytes.is_empty()).then_some(&bytes), &[])
            .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error.to_string()))
    } else {
        Ok(text.into_bytes())
    }
}
