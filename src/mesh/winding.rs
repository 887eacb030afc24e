//! Which way round the components of a 2D mesh lie: the sign of their total areas.

use crate::NONE;
use crate::mesh::Mesh;
use crate::mesh::half_edge::unflagged;
use crate::predicates::total_area_sign;
use std::cmp::Ordering;

/// One bit a triangle: 1 where its edge-connected component has a negative total area. Empty where no
/// component has, and in 3D, where it has no meaning.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Winding {
    pub(crate) clockwise: Vec<u32>,
    /// Whether all triangles are known to be positive, those of the components with a bit negative.
    pub(crate) is_strict: bool,
}

/// Which signs the areas of triangles have: a bit each for negative, zero and positive.
#[derive(Clone, Copy, Default)]
pub(crate) struct Signs(u32);

impl Signs {
    #[inline(always)]
    pub(crate) fn add(&mut self, sign: Ordering) {
        self.0 |= 1 << (sign as i8 + 1);
    }

    /// Those of these triangles and of others.
    pub(crate) fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// What they say of all the triangles of a mesh; `None` where they disagree, and components have to be found.
    pub(crate) fn winding(self, triangles: usize) -> Option<Winding> {
        let [negative, zero, positive] = [1, 2, 4].map(|bit| self.0 & bit != 0);
        // Where all triangles are flat no edge flips, whatever the sign.
        let words = if negative { triangles.div_ceil(32) } else { 0 };
        (!(negative & positive)).then(|| Winding { clockwise: vec![u32::MAX; words], is_strict: !zero })
    }
}

impl Winding {
    /// What the components say, joined by `twins`.
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

    /// The sign of the area of triangle `t` where it lies as its component does.
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
