//! The winding of the components of a 2D mesh: the sign of their total areas.

use crate::NONE;
use crate::mesh::Mesh;
use crate::mesh::half_edge::unflagged;
use crate::predicates::total_area_sign;
use std::cmp::Ordering;

/// One bit per triangle: 1 if its edge-connected component has a negative total area. Empty if no component has, and in
/// 3D, where winding has no meaning.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Winding {
    pub(crate) clockwise: Vec<u32>,
    /// Whether every triangle is known to have the strict sign of its component: positive, or negative where the bit is
    /// 1.
    pub(crate) is_strict: bool,
}

/// The signs that occur among areas of triangles: one bit each for negative, zero and positive.
#[derive(Clone, Copy, Default)]
pub(crate) struct Signs(u32);

impl Signs {
    #[inline(always)]
    pub(crate) fn add(&mut self, sign: Ordering) {
        self.0 |= 1 << (sign as i8 + 1);
    }

    /// The signs of both sets of triangles.
    pub(crate) fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The winding of a mesh whose triangles have these signs; `None` if both signs occur: then the components decide.
    pub(crate) fn winding(self, triangles: usize) -> Option<Winding> {
        let [negative, zero, positive] = [1, 2, 4].map(|bit| self.0 & bit != 0);
        // If all triangles are flat, no edge flips, whatever the winding.
        let words = if negative { triangles.div_ceil(32) } else { 0 };
        (!(negative & positive)).then(|| Winding { clockwise: vec![u32::MAX; words], is_strict: !zero })
    }
}

impl Winding {
    /// The winding by components, joined by `twins`.
    pub(crate) fn of_components(mesh: &Mesh, twins: &[u32]) -> Self {
        let mut clockwise = vec![0u32; mesh.triangle_count().div_ceil(32)];
        let mut visited = vec![false; mesh.triangle_count()];
        for seed in 0..mesh.triangle_count() {
            if visited[seed] {
                continue;
            }
            visited[seed] = true;
            let mut component = vec![seed];
            let mut at = 0;
            while at < component.len() {
                for twin in &twins[3 * component[at]..3 * component[at] + 3] {
                    let neighbour = unflagged(*twin) as usize / 3;
                    if *twin != NONE && !visited[neighbour] {
                        visited[neighbour] = true;
                        component.push(neighbour);
                    }
                }
                at += 1;
            }
            if total_area_sign(component.len(), &|i| corners(mesh, component[i])).is_lt() {
                for t in component {
                    clockwise[t / 32] |= 1 << (t % 32);
                }
            }
        }
        Self { clockwise, is_strict: false }
    }

    /// The sign of the total area of the component of triangle `t`.
    #[inline]
    pub(crate) fn positive(&self, t: u32) -> Ordering {
        if self.is_clockwise(t) { Ordering::Less } else { Ordering::Greater }
    }

    /// The bits of four triangles.
    #[inline]
    pub(crate) fn bits(&self, triangles: [u32; 4]) -> u32 {
        if self.clockwise.is_empty() {
            return 0;
        }
        (0..).zip(triangles).fold(0, |bits, (lane, t)| bits | u32::from(self.is_clockwise(t)) << lane)
    }

    /// Whether triangle `t` belongs to a component of negative area.
    #[inline]
    pub(crate) fn is_clockwise(&self, t: u32) -> bool {
        self.clockwise.get(t as usize / 32).is_some_and(|word| word >> (t % 32) & 1 == 1)
    }
}

#[inline(always)]
fn corners(mesh: &Mesh, t: usize) -> [glam::DVec2; 3] {
    let (triangles, _) = mesh.triangles().as_chunks();
    mesh.positions().points2(triangles[t])
}
