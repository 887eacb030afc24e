//! A frame of a mesh in the plane that moves: what an update does against triangles that have turned over, before it flips.
//! A GPU does the same with the same bits: `shaders/webgpu/untangle.wgsl` has the same steps.

mod lift;
mod put_back;
mod rounds;

use crate::mesh::arrangement::Arrangement;
use crate::mesh::star::Fans;
use crate::mesh::winding::Winding;
use crate::predicates::area_sign;
use crate::{NONE, Positions};
use glam::DVec2;
use std::cmp::Ordering;

/// Numbers that the shader has, too.
#[cfg(test)]
pub(crate) const CONSTANTS: [(&str, u32); 10] = [
    ("LIFTS", rounds::LIFTS),
    ("PUTS", rounds::PUTS),
    ("STRAYS", rounds::STRAYS),
    ("KEY_BITS", rounds::KEY_BITS),
    ("MOST", rounds::MOST as u32),
    ("FIRST_MOST", rounds::FIRST_MOST),
    ("LARGE", lift::LARGE),
    ("BIAS", lift::BIAS),
    ("NEVER", lift::NEVER as u32),
    ("LONGEST", put_back::LONGEST),
];

/// The mesh of an update. During the rounds some slots have no triangle.
pub(crate) struct Frame<'a> {
    pub(crate) positions: &'a Positions,
    /// An empty slot has the corners [`NONE`].
    pub(crate) triangles: &'a mut [u32],
    /// The first word of an empty slot is a slot near it.
    pub(crate) twins: &'a mut [u32],
    pub(crate) fans: &'a mut Fans,
    pub(crate) winding: &'a Winding,
    pub(crate) arrangement: &'a Arrangement,
    /// Whether a triangle is left alone. `None`: none is.
    pub(crate) is_left: Option<fn([DVec2; 3]) -> bool>,
    /// The slots that have changed, some of them several times.
    pub(crate) written: Vec<u32>,
}

/// A vertex that is out. A vertex inside a disc has two triangles of its own: the disc without it has two fewer.
struct Loose {
    vertex: u32,
    slots: [u32; 2],
    /// The triangle that its walk has come to.
    at: u32,
    /// The triangle that it claims; [`NONE`] if it walks on.
    target: u32,
}

impl Frame<'_> {
    fn vertex(&self, h: u32) -> u32 {
        self.triangles[h as usize]
    }

    fn corners(&self, t: u32) -> [u32; 3] {
        [3 * t, 3 * t + 1, 3 * t + 2].map(|h| self.vertex(h))
    }

    /// The number of a vertex that the caller gives.
    fn name(&self, v: u32) -> u32 {
        self.arrangement.vertex(v)
    }

    /// The number of a triangle that the caller gives.
    fn triangle_name(&self, t: u32) -> u32 {
        self.arrangement.name(3 * t) / 3
    }

    /// A slot with a triangle near `slot`. A slot points to one that was not empty when it became so itself.
    fn filled(&self, mut slot: u32) -> u32 {
        while self.vertex(3 * slot) == NONE {
            slot = self.twins[3 * slot as usize];
        }
        slot
    }

    /// The sign of a triangle, reversed if the component of triangle `t` is clockwise; `None` if it is left alone.
    fn sign(&self, t: u32, corners: [u32; 3]) -> Option<Ordering> {
        let [a, b, c] = self.positions.points2(corners);
        let is_left = self.is_left.is_some_and(|is_left| is_left([a, b, c]));
        (!is_left).then(|| self.winding.relative(t, area_sign(a, b, c)))
    }

    /// Whether slot `t` has a triangle that is turned over or flat.
    fn is_turned(&self, t: u32) -> bool {
        self.vertex(3 * t) != NONE
            && matches!(self.sign(t, self.corners(t)), Some(Ordering::Less | Ordering::Equal))
    }

    fn set_triangle(&mut self, slot: u32, corners: [u32; 3]) {
        let h = 3 * slot as usize;
        self.triangles[h..h + 3].copy_from_slice(&corners);
        self.written.push(slot);
    }
}
