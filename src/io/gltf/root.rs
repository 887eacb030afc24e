//! The JSON of a glTF file.

use super::errors::{one_line, quoted, refuse};
use super::nesting;
use crate::Error;
use gltf::json::mesh::{Mesh as JsonMesh, Primitive};
use gltf::json::scene::Node;
use gltf::json::{Accessor, Buffer, Index, buffer::View};
use serde::Deserialize;
use serde_json::Value;

/// The parts of a file's JSON that define triangles. The other parts are not checked, and are kept.
#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Root {
    pub(super) scene: Value,
    pub(super) scenes: Vec<Scene>,
    pub(super) nodes: Vec<Node>,
    pub(super) meshes: Vec<JsonMesh>,
    pub(super) accessors: Vec<Accessor>,
    pub(super) buffer_views: Vec<View>,
    pub(super) buffers: Vec<Buffer>,
    pub(super) images: Vec<Image>,
    pub(super) materials: Value,
    pub(super) skins: Value,
    pub(super) animations: Value,
}

#[derive(Default, Deserialize)]
#[serde(default)]
pub(super) struct Scene {
    pub(super) nodes: Vec<Index<Node>>,
}

#[derive(Default, Deserialize)]
#[serde(default, rename_all = "camelCase")]
pub(super) struct Image {
    pub(super) buffer_view: Option<Index<View>>,
    pub(super) uri: Value,
}

/// The part that is read first: another version may have another structure.
#[derive(Deserialize)]
struct Head {
    asset: Asset,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: String,
    min_version: Option<String>,
}

/// The JSON of a file.
pub(super) fn json(bytes: &[u8]) -> Result<Root, Error> {
    nesting::refuse_deep(bytes)?;
    let Asset { version, min_version } = deserialized::<Head>(bytes)?.asset;
    let version = min_version.unwrap_or(version);
    if !version.starts_with("2.") {
        let message = format!("the file has glTF version {}, only version 2 is supported", quoted(&version));
        return Err(refuse("asset", message));
    }
    deserialized(bytes)
}

pub(super) fn deserialized<'a, T: Deserialize<'a>>(bytes: &'a [u8]) -> Result<T, Error> {
    let mut json = serde_json::Deserializer::from_slice(bytes);
    let value = serde_path_to_error::deserialize(&mut json).map_err(|error| {
        refuse(one_line(format!("JSON, {}", error.path())), one_line(error.inner().to_string()))
    })?;
    json.end().map_err(|error| refuse("JSON", error.to_string()))?;
    Ok(value)
}

/// How many primitives use each accessor. `accessor_of` returns the accessor that a primitive uses.
pub(super) fn uses(root: &Root, accessor_of: impl Fn(&Primitive) -> Option<usize>) -> Vec<usize> {
    let mut uses = vec![0; root.accessors.len()];
    for accessor in root.meshes.iter().flat_map(|mesh| &mesh.primitives).filter_map(accessor_of) {
        if let Some(uses) = uses.get_mut(accessor) {
            *uses += 1;
        }
    }
    uses
}
