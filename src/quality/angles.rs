//! The angles of a mesh, and their histogram.

use crate::Mesh;
use glam::DVec3;

/// A histogram of the angles of a mesh, with equal bins from 0° to 180°.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AngleHistogram {
    /// Angles in each bin. A bin includes its lower end, and the last one also 180°.
    pub counts: Vec<u64>,
}

impl AngleHistogram {
    /// Width of a bin in degrees.
    pub fn bin_width(&self) -> f64 {
        180.0 / self.counts.len().max(1) as f64
    }
}

/// Statistics of the angles of a mesh. A flat triangle counts with the smallest angle 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Angles {
    /// Smallest angle of the mesh in degrees; 60 for a mesh without triangles.
    pub min: f64,
    /// Mean of the smallest angles of the triangles, in degrees; 60 for a mesh without triangles.
    pub mean_min: f64,
    /// All angles, three per triangle.
    pub histogram: AngleHistogram,
}

/// The angles of `mesh`, with a histogram of `bins` bins (at least one). They are computed in f64, for statistics only:
/// no flip depends on them.
pub fn angles(mesh: &Mesh, bins: usize) -> Angles {
    let mut counts = vec![0u64; bins.max(1)];
    let (mut min, mut sum) = (60f64, 0f64);
    for triangle in mesh.triangles().chunks_exact(3) {
        let corners = [triangle[0], triangle[1], triangle[2]].map(|v| mesh.point3(v));
        let angles = triangle_angles(corners);
        for angle in angles {
            let bin = (angle / 180.0 * counts.len() as f64) as usize;
            counts[bin.min(bins.max(1) - 1)] += 1;
        }
        let smallest = angles[0].min(angles[1]).min(angles[2]);
        min = min.min(smallest);
        sum += smallest;
    }
    let mean_min = if mesh.triangle_count() == 0 { 60.0 } else { sum / mesh.triangle_count() as f64 };
    Angles { min, mean_min, histogram: AngleHistogram { counts } }
}

/// The angles at the three corners, in degrees.
pub(super) fn triangle_angles(corners: [DVec3; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let p = direction(corners[k], corners[(k + 1) % 3]);
        let q = direction(corners[k], corners[(k + 2) % 3]);
        libm::atan2(p.cross(q).length(), p.dot(q)).to_degrees()
    })
}

/// A vector from one point towards the other: their difference, scaled if products of differences would overflow or
/// underflow. f32 coordinates never need scaling.
fn direction(from: DVec3, to: DVec3) -> DVec3 {
    let difference = to - from;
    let difference = if difference.is_finite() { difference } else { to / 2.0 - from / 2.0 };
    let size = difference.abs().max_element();
    if size == 0.0 || (1e-70..1e70).contains(&size) { difference } else { difference / size }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dimension;

    fn mesh(positions: &[f32], triangles: &[u32]) -> Mesh {
        Mesh::new(Dimension::Two, positions.to_vec(), triangles.to_vec()).unwrap()
    }

    #[test]
    fn angles_of_a_right_triangle() {
        let angles = angles(&mesh(&[0., 0., 1., 0., 0., 1.], &[0, 1, 2]), 18);
        assert!((angles.min - 45.0).abs() < 1e-12 && (angles.mean_min - 45.0).abs() < 1e-12);
        let mut expected = vec![0; 18];
        (expected[4], expected[9]) = (2, 1);
        assert_eq!(angles.histogram.counts, expected);
        assert_eq!(angles.histogram.bin_width(), 10.0);
    }

    #[test]
    fn degenerate_triangles_count_as_zero() {
        let positions = [0., 0., 1., 0., 2., 0., 0., 1e38, 1e38, 0.];
        for triangle in [[0, 1, 2], [0, 0, 1], [1, 1, 1]] {
            assert_eq!(angles(&mesh(&positions, &triangle), 1).min, 0.0);
        }
        assert!((angles(&mesh(&positions, &[0, 4, 3]), 1).min - 45.0).abs() < 1e-12);
        for [x, y] in [[1e-300, 1e300], [f64::MAX, -f64::MAX], [0.0, f64::from_bits(1)]] {
            let right = Mesh::new(Dimension::Two, vec![x, x, y, x, x, y], vec![0, 1, 2]).unwrap();
            assert!((angles(&right, 1).min - 45.0).abs() < 1e-12);
        }
        assert_eq!(angles(&mesh(&positions, &[0, 1, 2]), 2).histogram.counts, [2, 1]);
        assert_eq!(angles(&mesh(&positions, &[]), 1).min, 60.0);
        assert_eq!(angles(&mesh(&positions, &[0, 1, 2]), 0).histogram.counts, [3]);
    }
}
