//! Reads the triangles of a glTF file.

use super::accessors::Accessors;
use super::buffers::{Buffers, is_in_other_file, name_of};
use super::container::Container;
use super::document::{Document, Part};
use super::errors::refuse;
use super::placement::{Placement, placements};
use super::root::{Root, json, uses};
use crate::Error;
use crate::io::options::ReadFile;
use crate::io::parsed::{CutFaces, Dropped, Parsed};
use glam::{DMat4, DVec3};
use gltf::json::mesh::{Mesh as JsonMesh, Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use std::collections::BTreeMap;

/// The extension that compresses positions and indices of a primitive.
const DRACO: &str = "KHR_draco_mesh_compression";

/// Bytes of a vertex and of a triangle in memory while a file is read.
const VERTEX_BYTES: u64 = 12;
const TRIANGLE_BYTES: u64 = 12;

/// The triangles of a file, the file itself, and notes about it.
pub(in crate::io) struct Content {
    pub(in crate::io) parsed: Parsed,
    pub(in crate::io) document: Document,
    pub(in crate::io) notes: Vec<String>,
}

/// Reads a file's bytes. `max_bytes` limits the bytes of the mesh, and the total bytes of other files.
pub(in crate::io) fn read(bytes: Vec<u8>, read: ReadFile<'_>, max_bytes: u64) -> Result<Content, Error> {
    let container = Container::of(&bytes)?;
    let root = json(&bytes[container.json.clone()])?;
    let files = std::cell::RefCell::new(BTreeMap::new());
    let taken = std::cell::Cell::new(0);
    let kept = |name: &str| {
        let content = read(name)?;
        // A small file may name a large one many times.
        taken.set(taken.get() + content.len() as u64);
        if taken.get() > max_bytes {
            let taken = taken.get();
            return Err(format!(
                "the buffers up to here take {taken} bytes, more than the {max_bytes} allowed"
            ));
        }
        files.borrow_mut().insert(name.to_owned(), content.clone());
        Ok(content)
    };
    let buffers = Buffers::of(&root, container.binary.map(|range| &bytes[range]), &kept)?;
    let mut reader = Reader {
        accessors: Accessors { root: &root, buffers: &buffers },
        uses: uses(&root, positions_of),
        max_bytes,
        found: BTreeMap::new(),
        parts: Vec::new(),
        positions: Vec::new(),
        triangles: Vec::new(),
        packed: 0,
        others: 0,
    };
    let mut ambiguous = 0;
    let (placements, loops) = placements(&root)?;
    for (index, (mesh, placement)) in root.meshes.iter().zip(placements).enumerate() {
        ambiguous += usize::from(placement.is_ambiguous());
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            reader.add([index, number], primitive, &placement)?;
        }
    }
    let Reader { parts, positions, triangles, packed, others, .. } = reader;
    if parts.is_empty() && packed > 0 {
        let message = "its meshes are compressed (KHR_draco_mesh_compression or EXT_meshopt_compression); \
                       uncompress the file first, for example with glTF-Transform";
        return Err(refuse("meshes", message));
    }
    let mut notes = Vec::new();
    for (count, what) in [
        (packed, "compressed primitives, left as they are"),
        (others, "primitives of points or lines, left as they are"),
        (loops, "nodes with two parents or among their own descendants, used once"),
        (ambiguous, "meshes that nodes stretch in several ways, read as the first node stretches them"),
    ] {
        if count > 0 {
            notes.push(format!("{what}: {count}"));
        }
    }
    let dropped = Dropped(dropped(&root).into_iter().map(String::from).collect());
    let faces = CutFaces::of(triangles);
    let parsed = Parsed { stride: 3, positions: positions.into(), faces, dropped, loses: false };
    let images = root.images.iter().filter_map(|image| image.uri.as_str());
    let images = images.filter(|uri| is_in_other_file(uri)).map(name_of).collect();
    let document = Document { bytes, files: files.into_inner(), images, embeds: false, parts };
    Ok(Content { parsed, document, notes })
}

/// What a mesh cannot hold.
fn dropped(root: &Root) -> Vec<&'static str> {
    let primitives = || root.meshes.iter().flat_map(|mesh: &JsonMesh| &mesh.primitives);
    let has_more = |primitive: &Primitive| {
        primitive.attributes.keys().any(|semantic| *semantic != Checked::Valid(Semantic::Positions))
    };
    [
        (primitives().any(has_more), "attributes of vertices besides positions"),
        (primitives().any(|primitive| primitive.targets.is_some()), "morph targets"),
        (!root.materials.is_null(), "materials"),
        (!root.skins.is_null(), "skins"),
        (!root.animations.is_null(), "animations"),
    ]
    .into_iter()
    .filter_map(|(is_there, what)| is_there.then_some(what))
    .collect()
}

fn positions_of(primitive: &Primitive) -> Option<usize> {
    primitive.attributes.get(&Checked::Valid(Semantic::Positions)).map(|accessor| accessor.value())
}

/// Two primitives with equal keys have the same triangles: positions, indices, mode, and the mesh if it is stretched.
type Key = (usize, Option<usize>, u32, Option<usize>);

/// The parts so far.
struct Reader<'a> {
    accessors: Accessors<'a>,
    uses: Vec<usize>,
    max_bytes: u64,
    /// The index of the part for each key.
    found: BTreeMap<Key, usize>,
    parts: Vec<Part>,
    positions: Vec<f32>,
    triangles: Vec<u32>,
    /// Primitives that are compressed.
    packed: usize,
    /// Primitives without triangles.
    others: usize,
}

impl Reader<'_> {
    fn add(&mut self, user: [usize; 2], primitive: &Primitive, placement: &Placement) -> Result<(), Error> {
        let location = || format!("mesh {}, primitive {}", user[0], user[1]);
        let Checked::Valid(mode) = primitive.mode else {
            return Err(refuse(location(), "its mode is not known"));
        };
        let Some(position) = positions_of(primitive) else {
            self.others += 1;
            return Ok(());
        };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.others += 1;
            return Ok(());
        }
        let index = primitive.indices.map(|accessor| accessor.value());
        let is_draco = primitive.extensions.as_ref().is_some_and(|others| others.others.contains_key(DRACO));
        if is_draco || [Some(position), index].into_iter().flatten().any(|i| self.accessors.is_packed(i)) {
            self.packed += 1;
            return Ok(());
        }
        let key = (position, index, mode.as_gl_enum(), placement.stretch.map(|_| user[0]));
        if let Some(&part) = self.found.get(&key) {
            self.parts[part].users.push(user);
            return Ok(());
        }
        let accessor = self.accessors.get(position)?;
        let (count, is_sparse) = (accessor.count.0, accessor.sparse.is_some());
        // If several primitives use the accessor, each may use a different range of it. A part then takes only the
        // elements that it uses.
        let is_shared = self.uses[position] > 1 && !is_sparse;
        self.limit(if is_shared { 0 } else { count }, 0, location)?;
        let mut corners = match index {
            Some(index) => self.accessors.indices(index)?,
            // A primitive without indices has one element per corner.
            None if is_sparse || self.accessors.elements(position)?.is_some() => (0..count as u32).collect(),
            None => Vec::new(),
        };
        if let Some(corner) = corners.iter().find(|&&corner| u64::from(corner) >= count) {
            let message = format!("it names element {corner} of accessor {position}, which has {count}");
            return Err(refuse(location(), message));
        }
        let mut triangles = triangles(mode, &corners);
        let mut elements = Vec::new();
        if is_shared {
            corners.sort_unstable();
            corners.dedup();
            elements = corners;
        }
        let vertices = if is_shared { elements.len() } else { count as usize };
        self.limit(vertices as u64, triangles.len() as u64 / 3, location)?;
        let first = self.positions.len() / 3;
        for vertex in &mut triangles {
            let rank =
                if is_shared { elements.binary_search(vertex).unwrap_or_default() } else { *vertex as usize };
            *vertex = (first + rank) as u32;
        }
        self.positions.extend(self.accessors.positions(position, is_shared.then_some(&elements))?);
        if let Some(stretch) = placement.stretch {
            for position in self.positions[3 * first..].as_chunks_mut().0 {
                *position = (stretch * DVec3::from_array(position.map(f64::from))).as_vec3().to_array();
            }
        }
        let start = self.triangles.len() / 3;
        self.triangles.append(&mut triangles);
        self.found.insert(key, self.parts.len());
        self.parts.push(Part {
            users: vec![user],
            vertices: first..first + vertices,
            elements: is_shared.then_some(elements),
            triangles: start..self.triangles.len() / 3,
            indices: index.filter(|_| mode == Mode::Triangles),
            world: placement
                .stretch
                .map_or(placement.world, |_| DMat4::from_translation(placement.world.w_axis.truncate())),
        });
        Ok(())
    }

    /// Refuses a mesh that would take more than `max_bytes` with these additional vertices and triangles.
    fn limit(&self, vertices: u64, triangles: u64, location: impl Fn() -> String) -> Result<(), Error> {
        let bytes = |present: usize, more: u64, each: u64| {
            (present as u64 / 3).saturating_add(more).saturating_mul(each)
        };
        let bytes = bytes(self.positions.len(), vertices, VERTEX_BYTES).saturating_add(bytes(
            self.triangles.len(),
            triangles,
            TRIANGLE_BYTES,
        ));
        if bytes <= self.max_bytes {
            return Ok(());
        }
        let message =
            format!("the meshes up to here take {bytes} bytes, more than the {} allowed", self.max_bytes);
        Err(refuse(location(), message))
    }
}

/// The triangles of the corners in a given mode.
fn triangles(mode: Mode, corners: &[u32]) -> Vec<u32> {
    let (whole, _) = corners.as_chunks::<3>();
    match mode {
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            .flat_map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] })
            .collect(),
        Mode::TriangleFan => match corners {
            [hub, rim @ ..] => rim.windows(2).flat_map(|pair| [pair[0], pair[1], *hub]).collect(),
            [] => Vec::new(),
        },
        _ => whole.as_flattened().to_vec(),
    }
}
