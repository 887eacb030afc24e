//! The parameters of the kernels of the phases.

use crate::engine::gpu::cosine::Cosine;
use crate::engine::gpu::upload::Upload;
use crate::{Dimension, Mesh};

/// The longest list that the tail works on.
const TAIL_LENGTH: u32 = 2048;
/// The same on drivers that end loops too early: a few thousand rounds for each of a few triangles are safe.
const SHORT_TAIL_LENGTH: u32 = 256;
/// The largest mesh that uses lists from the start.
const SMALL_MESH: usize = 4096;

/// Word offsets in the topology buffer. The winding bits are at 0.
pub(super) struct TopologyOffsets {
    pub(super) embedded: u32,
    pub(super) fans: u32,
}

impl TopologyOffsets {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let bits = |count: usize| match mesh.dimension() {
            Dimension::Two => count.div_ceil(32) as u32,
            Dimension::Three => 0,
        };
        let embedded = bits(mesh.triangle_count());
        Self { embedded, fans: embedded + bits(mesh.vertex_count()) }
    }
}

/// Words at the start of the parameters that the device writes.
pub(super) const DEVICE_WORDS: usize = 3;

// What is known of the winding, as in `state.wgsl`.
pub(super) const WINDING_UNKNOWN: u32 = 0;
pub(super) const WINDING_BITS: u32 = 1;
pub(super) const WINDING_CLOCKWISE: u32 = 2;
pub(super) const WINDING_COUNTER_CLOCKWISE: u32 = 3;

/// Bits of the signs of triangles, as in `state.wgsl`.
pub(super) const NEGATIVE: u32 = 1;
pub(super) const POSITIVE: u32 = 4;
/// Set with them if some star is not known to be embedded.
#[cfg(any(test, feature = "baseline"))]
pub(super) const UNEMBEDDED: u32 = 8;

/// The same layout as in `state.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct Params {
    /// Written by the device, after the preparation, as the next two.
    pub(super) signs: u32,
    pub(super) highest: u32,
    pub(super) depth: u32,
    pub(super) vertices: u32,
    pub(super) triangles: u32,
    pub(super) first: u32,
    pub(super) fans: u32,
    pub(super) fans_length: u32,
    pub(super) tail: u32,
    pub(super) cos: f32,
    pub(super) cos_sign: i32,
    pub(super) any_angle: u32,
    pub(super) tail_iterations: u32,
    pub(super) tail_length: u32,
    pub(super) list_below: u32,
    pub(super) embedded: u32,
    pub(super) winding: u32,
    pub(super) update: u32,
    pub(super) changes: u32,
    pub(super) untangles: u32,
    pub(super) cos_digits: [[i32; 8]; 2],
    pub(super) deviation: [u32; 4],
}

impl Params {
    /// The parameters of the first iteration, for a mesh whose vertices have one fan each.
    pub(super) fn new(upload: &Upload, topology: &TopologyOffsets, ends_loops_early: bool) -> Self {
        let (mesh, cosine) = (&upload.mesh, Cosine::new(upload.thresholds.cos));
        let count = mesh.triangle_count();
        Self {
            signs: 0,
            highest: 0,
            depth: 0,
            vertices: mesh.vertex_count() as u32,
            triangles: count as u32,
            first: 0,
            fans: topology.fans,
            fans_length: 0,
            tail: 0,
            cos: cosine.rounded,
            cos_sign: cosine.sign,
            any_angle: u32::from(cosine.is_of_any_angle),
            tail_iterations: 0,
            tail_length: if ends_loops_early { SHORT_TAIL_LENGTH } else { TAIL_LENGTH },
            // A flip appends at most six triangles to a list. For a small mesh, a sweep is never faster.
            list_below: if count <= SMALL_MESH { u32::MAX } else { count as u32 / 256 },
            embedded: topology.embedded,
            winding: WINDING_UNKNOWN,
            update: 0,
            changes: 0,
            untangles: 0,
            cos_digits: [cosine.mantissa, cosine.power],
            deviation: upload.deviation,
        }
    }

    /// The byte offset and the bytes of the part that the host writes.
    pub(super) fn of_host(&self) -> (u64, &[u8]) {
        (4 * DEVICE_WORDS as u64, &bytemuck::bytes_of(self)[4 * DEVICE_WORDS..])
    }
}
