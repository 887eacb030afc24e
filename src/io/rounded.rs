//! Positions rounded to 32-bit floats.

use crate::Mesh;
use std::io;

/// The positions of a mesh as 32-bit floats, 3 per vertex. `format` is for the message of the error.
pub(super) fn rounded(mesh: &Mesh, format: &str) -> io::Result<Vec<[f32; 3]>> {
    let round = |vertex| {
        let point = mesh.point3(vertex).as_vec3();
        let message = || {
            format!(
                "vertex {vertex} is too far away for the 32-bit numbers of {format}; write PLY, OBJ or OFF"
            )
        };
        let error = || io::Error::new(io::ErrorKind::InvalidInput, message());
        point.is_finite().then(|| point.to_array()).ok_or_else(error)
    };
    (0..mesh.vertex_count() as u32).map(round).collect()
}
