//! The module of the entry `edgeflip/files` of the npm package: mesh files, generated meshes and measures, without an
//! engine. Only `src/js/files.ts` calls it. It has checked the types of all arguments, but not their values. Every
//! exception is an `Error` with a `code`.

mod constraints;
mod weld;

use crate::error::number;
use crate::io::{self, Coordinates, Format, Loaded, ReadOptions};
use crate::system::memory;
use crate::system::threads::Threads;
use crate::wasm::values::{JsPositions, dimension_of, mesh_of, object, thrown};
use crate::{Error, Mesh, Options, Plane, Positions, families, quality, reoriented};
use js_sys::{Array, Float32Array, Float64Array, Reflect, Uint8Array, Uint32Array};
use std::path::Path;
use wasm_bindgen::prelude::*;

/// The most bins of a histogram: more would only cost memory.
const MAX_BINS: u32 = 1 << 16;

#[wasm_bindgen]
extern "C" {
    /// A file. `files` is an object with the bytes of other files by their names; `maxBytes`, `coordinates`, 32 or 64,
    /// `ignoreAttributes` and `plane`, a name, are as in [`ReadOptions`].
    #[wasm_bindgen(
        typescript_type = "Required<import('../original.js').Original> & { plane?: import('../types.js').Plane | undefined }"
    )]
    pub type JsFile;

    #[wasm_bindgen(method, getter)]
    fn bytes(this: &JsFile) -> Uint8Array;
    #[wasm_bindgen(method, getter)]
    fn name(this: &JsFile) -> String;
    #[wasm_bindgen(method, getter)]
    fn files(this: &JsFile) -> JsValue;
    #[wasm_bindgen(method, getter, js_name = maxBytes)]
    fn max_bytes(this: &JsFile) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn coordinates(this: &JsFile) -> Option<u32>;
    #[wasm_bindgen(method, getter, js_name = ignoreAttributes)]
    fn ignore_attributes(this: &JsFile) -> Vec<String>;
    #[wasm_bindgen(method, getter)]
    fn plane(this: &JsFile) -> Option<String>;
}

/// Reads the mesh of a file; `dimension` is as in [`ReadOptions`].
///
/// # Errors
/// Those of [`Format::of`] and [`io::parse_with`]; [`Error::Option`] for `maxBytes` and `ignoreAttributes`.
#[wasm_bindgen(js_name = readMesh, unchecked_return_type = "import('../files.js').FileMesh")]
pub fn read_mesh(file: &JsFile, dimension: Option<u32>) -> Result<JsValue, JsValue> {
    let loaded = load(file, dimension).map_err(thrown)?;
    let mut constraints = Options::default();
    let locked = loaded.constrain(&mut constraints).map_err(thrown)?;
    let attribute_edges = locked
        .by_name
        .into_iter()
        .map(|(name, edges)| object([("name", name.into()), ("edges", (edges as f64).into())]));
    let numbers = |numbers: &[u32]| {
        if numbers.is_empty() { JsValue::UNDEFINED } else { Uint32Array::from(numbers).into() }
    };
    let texts = |texts: &[String]| texts.iter().map(JsValue::from).collect::<Array>().into();
    let placed =
        loaded.placed().map_or(JsValue::UNDEFINED, |placed| Float32Array::from(placed.as_slice()).into());
    let [positions, indices, dimension] = fields(&loaded.mesh);
    Ok(object([
        positions,
        indices,
        dimension,
        ("polygons", (loaded.polygons as f64).into()),
        ("crossing", numbers(&loaded.crossing)),
        ("dropped", texts(&loaded.dropped)),
        ("keeps", Format::of(Path::new(&file.name())).is_ok_and(|format| loaded.keeps(format)).into()),
        ("notes", texts(&loaded.notes)),
        ("placed", placed),
        ("attributeEdges", attribute_edges.collect::<Array>().into()),
        ("groups", numbers(&constraints.groups)),
        ("lockedEdges", numbers(constraints.locked_edges.as_flattened())),
        ("lockedTriangles", numbers(&constraints.locked_triangles)),
    ]))
}

/// The bytes of a file that holds the mesh of `file` with other triangles. The positions have to be those of the file.
///
/// # Errors
/// Those of [`read_mesh`] and [`Loaded::file_bytes`]; [`Error::Option`] for the positions.
#[wasm_bindgen(js_name = rewriteMesh, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
pub fn rewrite_mesh(
    file: &JsFile,
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    target: &str,
) -> Result<Uint8Array, JsValue> {
    let rewrite = || {
        let loaded = load(file, Some(dimension))?;
        if !Positions::from(positions).iter().eq(loaded.mesh.positions().iter()) {
            let message = "its positions differ from those of the mesh, and only triangles can change: omit it to write the mesh without attributes";
            return Err(Error::Option { option: "original", message: message.to_owned() });
        }
        loaded.file_bytes(target, indices.to_vec())
    };
    rewrite().map(|bytes| Uint8Array::from(bytes.as_slice())).map_err(thrown)
}

fn load(file: &JsFile, dimension: Option<u32>) -> Result<Loaded, Error> {
    let (format, bytes, files) = (Format::of(Path::new(&file.name()))?, file.bytes(), file.files());
    let (named, usual) = (file.plane(), ReadOptions::default());
    let options = ReadOptions {
        dimension: dimension.map(dimension_of),
        plane: Plane::ALL.into_iter().find(|plane| named.as_deref() == Some(plane.name())),
        coordinates: file
            .coordinates()
            .map(|bits| if bits == 32 { Coordinates::F32 } else { Coordinates::F64 }),
        ignore_attributes: file.ignore_attributes(),
        max_bytes: file.max_bytes().map_or(Ok(usual.max_bytes), parse_max_bytes)?,
        ..usual
    };
    options.check(bytes.length().into())?;
    // The bytes, and a mesh of the same size, twice while its arrays grow. If memory ran out during the call, the
    // memory that it had allocated would be lost.
    memory::check(3 * u64::from(bytes.length()))?;
    io::parse_with(format, bytes.to_vec(), &options, &|name| {
        let given =
            Reflect::get(&files, &name.into()).ok().and_then(|file| file.dyn_into::<Uint8Array>().ok());
        given.map(|file| file.to_vec()).ok_or_else(|| "it is not among the `files` given".into())
    })
}

/// The bytes of a file that holds the mesh.
///
/// # Errors
/// Those of [`Mesh::new`] and [`io::to_file_bytes`].
#[wasm_bindgen(js_name = writeMesh, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
pub fn write_mesh(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    name: &str,
) -> Result<Uint8Array, JsValue> {
    let write = || {
        let mesh = self::mesh(positions, indices, dimension)?;
        io::to_file_bytes(name, &mesh)
    };
    write().map(|bytes| Uint8Array::from(bytes.as_slice())).map_err(thrown)
}

/// As [`families::by_name`].
///
/// # Errors
/// Those of [`families::by_name`].
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Mesh32")]
pub fn generate(spec: &str) -> Result<JsValue, JsValue> {
    let mesh = families::by_name(spec).map_err(thrown)?;
    Ok(object(fields(&mesh)))
}

/// As [`reoriented`].
///
/// # Errors
/// Those of [`Mesh::new`].
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Reoriented")]
pub fn reorient(positions: JsPositions, indices: &Uint32Array, dimension: u32) -> Result<JsValue, JsValue> {
    let turn = || reoriented(&mesh(positions, indices, dimension)?);
    let (mesh, turned) = turn().map_err(thrown)?;
    Ok(object([("indices", Uint32Array::from(mesh.triangles()).into()), ("turned", turned.into())]))
}

/// As [`quality::measures`].
///
/// # Errors
/// Those of [`Mesh::new`].
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Measures")]
pub fn measures(positions: JsPositions, indices: &Uint32Array, dimension: u32) -> Result<JsValue, JsValue> {
    let measure = || Ok(quality::measures(&mesh(positions, indices, dimension)?));
    let measures = measure().map_err(thrown)?;
    Ok(object([
        ("minAngle", measures.min_angle.into()),
        ("meanMinAngle", measures.mean_min_angle.into()),
        ("meanAspect", measures.mean_aspect.into()),
        ("flat", (measures.flat as f64).into()),
        ("area", measures.area.into()),
        ("volume", measures.volume.into()),
    ]))
}

/// As [`quality::moved`] and [`quality::distance`].
///
/// # Errors
/// Those of [`Mesh::new`]; [`Error::TriangleCount`].
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Change")]
pub fn change(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    after: &Uint32Array,
) -> Result<JsValue, JsValue> {
    let measure = || {
        let mesh = self::mesh(positions, indices, dimension)?;
        let (length, expected) = (after.length() as usize, mesh.triangles().len());
        if length != expected {
            return Err(Error::TriangleCount { length, expected });
        }
        let after = mesh.with_triangles(after.to_vec())?;
        let moved = quality::moved(mesh.triangles(), after.triangles());
        Ok((moved, quality::distance(&mesh, after.triangles())))
    };
    let (moved, distance) = measure().map_err(thrown)?;
    Ok(object([("moved", Uint32Array::from(moved.as_slice()).into()), ("distance", distance.into())]))
}

/// As [`quality::angles`], with 1 to [`MAX_BINS`] bins.
///
/// # Errors
/// Those of [`Mesh::new`]; [`Error::Option`] for the bins.
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Angles")]
pub fn angles(
    positions: JsPositions,
    indices: &Uint32Array,
    dimension: u32,
    bins: f64,
) -> Result<JsValue, JsValue> {
    let measure = || {
        let bins = parse_bins(bins)?;
        let mesh = self::mesh(positions, indices, dimension)?;
        Ok(quality::angles(&mesh, bins))
    };
    let angles = measure().map_err(thrown)?;
    // A mesh has fewer than 2^31 angles: `MAX_TRIANGLES`.
    let counts: Vec<u32> = angles.histogram.counts.iter().map(|&count| count as u32).collect();
    Ok(object([
        ("min", angles.min.into()),
        ("meanMin", angles.mean_min.into()),
        ("counts", Uint32Array::from(counts.as_slice()).into()),
    ]))
}

fn mesh(positions: JsPositions, indices: &Uint32Array, dimension: u32) -> Result<Mesh, Error> {
    mesh_of(positions, indices, dimension, &Threads::one())
}

/// The fields of a mesh, in arrays that JavaScript owns.
fn fields(mesh: &Mesh) -> [(&'static str, JsValue); 3] {
    let positions = match mesh.positions() {
        Positions::F32(numbers) => Float32Array::from(numbers.as_slice()).into(),
        Positions::F64(numbers) => Float64Array::from(numbers.as_slice()).into(),
    };
    [
        ("positions", positions),
        ("indices", Uint32Array::from(mesh.triangles()).into()),
        ("dimension", (mesh.dimension().stride() as u32).into()),
    ]
}

/// Infinity means no limit: the conversion saturates.
fn parse_max_bytes(bytes: f64) -> Result<u64, Error> {
    if bytes >= 0.0 {
        return Ok(bytes as u64);
    }
    Err(Error::Option { option: "maxBytes", message: format!("{} is not a size in bytes", number(bytes)) })
}

fn parse_bins(bins: f64) -> Result<usize, Error> {
    if bins.fract() == 0.0 && (1.0..=f64::from(MAX_BINS)).contains(&bins) {
        return Ok(bins as usize);
    }
    let message = format!("{} is not a whole number from 1 to {MAX_BINS}", number(bins));
    Err(Error::Option { option: "bins", message })
}
