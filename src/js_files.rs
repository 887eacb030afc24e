//! What the second entry of the npm package calls, `edgeflip/files`, and no one else: mesh files, generated meshes and
//! angles, in a module without an engine. The hand-written `src/js/files.ts` is its public face. Arguments arrive
//! checked in type, not in value. Everything that is thrown is an `Error` with a `code`.

use crate::io::{self, Format, Loaded};
use crate::js_values::{JsPositions, object, parse_dimension, thrown};
use crate::{Error, Mesh, families, quality};
use js_sys::{Array, Float32Array, Uint8Array, Uint32Array};
use std::path::Path;
use wasm_bindgen::prelude::*;

/// Most bins of a histogram: more would only cost memory.
const MAX_BINS: u32 = 1 << 16;

/// The mesh in the bytes of a file; see [`io::parse`] for the dimension.
///
/// # Errors
/// Those of [`Format::of`] and [`io::parse`]; [`Error::Option`] for the dimension.
#[wasm_bindgen(js_name = readMesh, unchecked_return_type = "import('../files.js').FileMesh")]
pub fn read_mesh(bytes: &[u8], name: &str, dimension: Option<f64>) -> Result<JsValue, JsValue> {
    let read = || io::parse(Format::of(Path::new(name))?, bytes, dimension.map(parse_dimension).transpose()?);
    let Loaded { mesh, polygons, dropped } = read().map_err(thrown)?;
    let dropped: Array = dropped.into_iter().map(JsValue::from).collect();
    let [positions, indices, dimension] = fields(&mesh);
    Ok(object([
        positions,
        indices,
        dimension,
        ("polygons", (polygons as f64).into()),
        ("dropped", dropped.into()),
    ]))
}

/// The bytes of a file that holds the mesh.
///
/// # Errors
/// Those of [`Format::of`], [`Mesh::new`] and [`io::to_bytes`]; [`Error::Option`] for the dimension.
#[wasm_bindgen(js_name = writeMesh, unchecked_return_type = "Uint8Array<ArrayBuffer>")]
pub fn write_mesh(
    positions: JsPositions,
    indices: Vec<u32>,
    dimension: f64,
    name: &str,
) -> Result<Uint8Array, JsValue> {
    let write = || {
        let format = Format::of(Path::new(name))?;
        let mesh = Mesh::new(parse_dimension(dimension)?, positions, indices)?;
        io::to_bytes(format, &mesh).map_err(|source| Error::Io { path: name.to_owned(), source })
    };
    write().map(|bytes| Uint8Array::from(bytes.as_slice())).map_err(thrown)
}

/// As [`families::by_name`].
///
/// # Errors
/// As there.
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Mesh32")]
pub fn generate(spec: &str) -> Result<JsValue, JsValue> {
    let mesh = families::by_name(spec).map_err(thrown)?;
    Ok(object(fields(&mesh)))
}

/// As [`quality::angles`], with 1 to [`MAX_BINS`] bins.
///
/// # Errors
/// Those of [`Mesh::new`]; [`Error::Option`] for the dimension and the bins.
#[wasm_bindgen(unchecked_return_type = "import('../files.js').Angles")]
pub fn angles(
    positions: JsPositions,
    indices: Vec<u32>,
    dimension: f64,
    bins: f64,
) -> Result<JsValue, JsValue> {
    let measure = || {
        let bins = parse_bins(bins)?;
        let mesh = Mesh::new(parse_dimension(dimension)?, positions, indices)?;
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

/// The fields of a mesh of 32-bit floats, in arrays that JavaScript owns.
fn fields(mesh: &Mesh) -> [(&'static str, JsValue); 3] {
    [
        ("positions", Float32Array::from(mesh.positions().to_f32().as_slice()).into()),
        ("indices", Uint32Array::from(mesh.triangles()).into()),
        ("dimension", (mesh.dimension().stride() as u32).into()),
    ]
}

fn parse_bins(bins: f64) -> Result<usize, Error> {
    if bins.fract() == 0.0 && (1.0..=f64::from(MAX_BINS)).contains(&bins) {
        return Ok(bins as usize);
    }
    let message = format!("{bins} is not a whole number from 1 to {MAX_BINS}");
    Err(Error::Option { option: "bins", message })
}
