//! Which way round the components of a 2D mesh lie: the sign of their total areas.

use crate::mesh::{Dimension, Mesh};
use crate::predicates::{area_sign, total_area_sign};
use crate::{Adjacency, NONE};

/// One bit a triangle: 1 where its edge-connected component has a negative total area. Empty where no
/// component has, which is known at once when no triangle is clockwise, and in 3D, where it has no meaning.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Winding {
    pub(crate) clockwise: Vec<u32>,
}

impl Winding {
    pub(crate) fn new(mesh: &Mesh, adjacency: impl FnOnce() -> Adjacency) -> Self {
        let triangle = |t: usize| [0, 1, 2].map(|k| mesh.point2(mesh.triangles()[3 * t + k]));
        let is_clockwise = |t: usize| {
            let [a, b, c] = triangle(t);
            area_sign(a, b, c).is_lt()
        };
        if mesh.dimension() == Dimension::Three || !(0..mesh.triangle_count()).any(is_clockwise) {
            return Self::default();
        }
        let twins = adjacency().twins;
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
                    let neighbour = *twin as usize / 3;
                    if *twin != NONE && !visited[neighbour] {
                        visited[neighbour] = true;
                        component.push(neighbour);
                    }
                }
                at += 1;
            }
            if total_area_sign(component.iter().map(|&t| triangle(t))).is_lt() {
                for t in component {
                    clockwise[t / 32] |= 1 << (t % 32);
                }
            }
        }
        Self { clockwise }
    }

    /// Whether triangle `t` belongs to a component of negative area.
    pub(crate) fn is_clockwise(&self, t: u32) -> bool {
        self.clockwise.get(t as usize / 32).is_some_and(|word| word >> (t % 32) & 1 == 1)
    }
}
