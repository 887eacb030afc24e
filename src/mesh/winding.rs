//! The winding of the components of a 2D mesh: the sign of their total areas.

use crate::NONE;
use crate::mesh::Mesh;
use crate::mesh::half_edge::{next, triangle_of, unflagged};
use crate::predicates::total_area_sign;
use std::cmp::Ordering;

/// One bit per triangle: 1 if its edge-connected component has a negative total area. Empty if no component has, and in
/// 3D, where winding has no meaning.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Winding {
    pub(crate) clockwise: Vec<u32>,
    /// Whether all bits are known to be 1.
    is_all_clockwise: bool,
    /// Whether every triangle is known to have the strict sign of its component: positive, or negative where the bit is
    /// 1.
    pub(crate) is_strict: bool,
}

/// The signs that occur among areas of triangles: one bit each for negative, zero and positive. Also the number of
/// triangles without the strict sign of their winding.
#[derive(Clone, Copy, Default)]
pub(crate) struct Signs {
    bits: u32,
    pub(crate) not_positive: u32,
}

impl Signs {
    #[inline(always)]
    pub(crate) fn add(&mut self, sign: Ordering, is_positive: bool) {
        self.bits |= 1 << (sign as i8 + 1);
        self.not_positive += u32::from(!is_positive);
    }

    /// The signs of both sets of triangles.
    pub(crate) fn and(self, other: Self) -> Self {
        Self { bits: self.bits | other.bits, not_positive: self.not_positive + other.not_positive }
    }

    /// The winding of a mesh whose triangles have these signs; `None` if both signs occur: then the components decide.
    pub(crate) fn winding(self, triangles: usize) -> Option<Winding> {
        let [negative, zero, positive] = [1, 2, 4].map(|bit| self.bits & bit != 0);
        // If all triangles are flat, no edge flips, whatever the winding.
        let words = if negative { triangles.div_ceil(32) } else { 0 };
        (!(negative & positive)).then(|| Winding {
            clockwise: vec![u32::MAX; words],
            is_all_clockwise: negative,
            is_strict: !zero,
        })
    }
}

/// The components of a mesh, joined by its twins, and the boundary of each. Flips change neither.
pub(crate) struct Outline {
    /// The component of each triangle.
    component: Vec<u32>,
    /// The vertices of the half-edges without a twin, component by component.
    boundary: Vec<[u32; 2]>,
    /// The end of each component in `boundary`.
    ends: Vec<u32>,
}

impl Outline {
    pub(crate) fn new(triangles: &[u32], twins: &[u32]) -> Self {
        let mut component = vec![NONE; triangles.len() / 3];
        let (mut boundary, mut ends, mut open) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 0..component.len() as u32 {
            if component[seed as usize] != NONE {
                continue;
            }
            component[seed as usize] = ends.len() as u32;
            open.push(seed);
            while let Some(t) = open.pop() {
                for h in 3 * t..3 * t + 3 {
                    let twin = twins[h as usize];
                    if twin == NONE {
                        boundary.push([h, next(h)].map(|x| triangles[x as usize]));
                        continue;
                    }
                    let neighbour = triangle_of(unflagged(twin));
                    if component[neighbour as usize] == NONE {
                        component[neighbour as usize] = ends.len() as u32;
                        open.push(neighbour);
                    }
                }
            }
            ends.push(boundary.len() as u32);
        }
        Self { component, boundary, ends }
    }

    /// The component of each triangle: its number, counted from 0 in the order of their first triangles.
    pub(crate) fn components(&self) -> &[u32] {
        &self.component
    }

    /// The winding for these positions. The area of a component is the area that its boundary encloses, because each
    /// other edge occurs in both directions.
    pub(crate) fn winding(&self, mesh: &Mesh) -> Winding {
        let mut first = 0;
        let mut negative = Vec::with_capacity(self.ends.len());
        for &end in &self.ends {
            let edges = &self.boundary[first as usize..end as usize];
            first = end;
            // Triangles from one vertex of the boundary to each of its edges.
            let triangle = |i: usize| mesh.positions().points2([edges[i][0], edges[i][1], edges[0][0]]);
            negative.push(total_area_sign(edges.len(), &triangle).is_lt());
        }
        let mut clockwise = vec![0u32; self.component.len().div_ceil(32)];
        if negative.contains(&true) {
            for (t, &component) in self.component.iter().enumerate() {
                clockwise[t / 32] |= u32::from(negative[component as usize]) << (t % 32);
            }
        }
        Winding { clockwise, is_all_clockwise: false, is_strict: false }
    }
}

impl Winding {
    /// Whether both are the same for `triangles` triangles.
    pub(crate) fn equals(&self, other: &Self, triangles: usize) -> bool {
        self.clockwise == other.clockwise
            || (0..triangles as u32).all(|t| self.is_clockwise(t) == other.is_clockwise(t))
    }

    /// The sign of the total area of the component of triangle `t`.
    #[inline]
    pub(crate) fn positive(&self, t: u32) -> Ordering {
        if self.is_clockwise(t) { Ordering::Less } else { Ordering::Greater }
    }

    /// The sign of triangle `t`, reversed if its component is clockwise.
    #[inline]
    pub(crate) fn relative(&self, t: u32, sign: Ordering) -> Ordering {
        if self.is_clockwise(t) { sign.reverse() } else { sign }
    }

    /// The bits of four triangles.
    #[inline]
    pub(crate) fn bits(&self, triangles: [u32; 4]) -> u32 {
        if self.clockwise.is_empty() {
            return 0;
        }
        if self.is_all_clockwise {
            return 0xf;
        }
        (0..).zip(triangles).fold(0, |bits, (lane, t)| bits | u32::from(self.is_clockwise(t)) << lane)
    }

    /// Whether triangle `t` belongs to a component of negative area.
    #[inline]
    pub(crate) fn is_clockwise(&self, t: u32) -> bool {
        self.clockwise.get(t as usize / 32).is_some_and(|word| word >> (t % 32) & 1 == 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Adjacency, Dimension};
    use proptest::prelude::*;

    proptest! {
        /// On dirty meshes with small integer coordinates: each component has the sign of the sum of its areas.
        #[test]
        fn the_boundary_gives_the_sign_of_the_area(
            points in prop::collection::vec((-4i32..5, -4i32..5), 7),
            corners in prop::collection::vec(0u32..7, 3..40),
        ) {
            let positions: Vec<f64> = points.iter().flat_map(|&(x, y)| [x, y]).map(f64::from).collect();
            let triangles = corners[..corners.len() / 3 * 3].to_vec();
            let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
            let twins = Adjacency::new(&mesh).twins;
            let outline = Outline::new(mesh.triangles(), &twins);
            let winding = outline.winding(&mesh);
            let mut areas = vec![0; outline.ends.len()];
            for (t, corners) in mesh.triangles().chunks(3).enumerate() {
                let [a, b, c] = [0, 1, 2].map(|k| points[corners[k] as usize]);
                let area = (a.0 - c.0) * (b.1 - c.1) - (a.1 - c.1) * (b.0 - c.0);
                areas[outline.component[t] as usize] += area;
                for &twin in twins[3 * t..3 * t + 3].iter().filter(|&&twin| twin != NONE) {
                    let neighbour = triangle_of(twin) as usize;
                    prop_assert_eq!(outline.component[t], outline.component[neighbour]);
                }
            }
            for t in 0..mesh.triangle_count() {
                prop_assert_eq!(winding.is_clockwise(t as u32), areas[outline.component[t] as usize] < 0);
            }
            prop_assert!(winding.equals(&winding, mesh.triangle_count()));
        }
    }
}
