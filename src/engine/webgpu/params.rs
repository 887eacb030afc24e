//! The parameters that every kernel of the phases reads.

use crate::engine::cosine::Cosine;
use crate::mesh::Mesh;

/// Iterations of the tail run on lists of up to so many triangles.
const TAIL_LENGTH: u32 = 2048;
/// The same where loops end too early: a few thousand rounds for each of a few triangles are safe.
const SHORT_TAIL_LENGTH: u32 = 256;
/// Meshes of up to so many triangles go by lists from the start.
const SMALL_MESH: usize = 4096;

/// As in `state.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Params {
    pub(super) vertices: u32,
    pub(super) triangles: u32,
    pub(super) first: u32,
    pub(super) fans: u32,
    pub(super) fans_length: u32,
    pub(super) winding_length: u32,
    pub(super) tail: u32,
    pub(super) cos: f32,
    pub(super) cos_sign: i32,
    pub(super) any_angle: u32,
    pub(super) tail_iterations: u32,
    pub(super) tail_length: u32,
    pub(super) list_below: u32,
    pub(super) embedded: u32,
    pub(super) padding: [u32; 2],
    pub(super) cos_mantissa: [i32; 8],
    pub(super) cos_power: [i32; 8],
}

impl Params {
    /// Before the first iteration, with no winding bits. `cos` is the cosine of β; the table of the fans has
    /// `fans_length` words from `fans` on.
    pub(super) fn new(
        mesh: &Mesh,
        cos: f64,
        (fans, fans_length): (usize, usize),
        ends_loops_early: bool,
    ) -> Self {
        let cosine = Cosine::new(cos);
        let count = mesh.triangle_count();
        Self {
            vertices: mesh.vertex_count() as u32,
            triangles: count as u32,
            first: 0,
            fans: fans as u32,
            fans_length: fans_length as u32,
            winding_length: 0,
            tail: 0,
            cos: cosine.rounded,
            cos_sign: cosine.sign,
            any_angle: u32::from(cosine.is_of_any_angle),
            tail_iterations: 0,
            tail_length: if ends_loops_early { SHORT_TAIL_LENGTH } else { TAIL_LENGTH },
            // A flip appends six triangles at most; a small mesh is not worth a sweep.
            list_below: if count <= SMALL_MESH { u32::MAX } else { count as u32 / 24 },
            embedded: (fans + fans_length) as u32,
            padding: [0; 2],
            cos_mantissa: cosine.mantissa,
            cos_power: cosine.power,
        }
    }
}
