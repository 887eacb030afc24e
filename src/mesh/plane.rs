//! The plan of a surface: the mesh in the plane that two of its three coordinates make.

use super::Mesh;
use super::dimension::Dimension;
use super::positions::Positions;
use crate::Error;
use crate::predicates::area_sign;
use glam::DVec2;

/// The plane of a terrain: the two coordinates that decide. The third is its height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// x and y decide, and z is up.
    Xy,
    /// x and z decide, and y is up.
    Xz,
    /// y and z decide, and x is up.
    Yz,
}

impl Plane {
    /// All planes.
    pub const ALL: [Self; 3] = [Self::Xy, Self::Xz, Self::Yz];

    /// `xy`, `xz` or `yz`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Xy => "xy",
            Self::Xz => "xz",
            Self::Yz => "yz",
        }
    }

    /// The two coordinates, in the order in which a triangle that is counter-clockwise from above is positive.
    #[must_use]
    pub fn axes(self) -> [usize; 2] {
        match self {
            Self::Xy => [0, 1],
            Self::Xz => [2, 0],
            Self::Yz => [1, 2],
        }
    }
}

impl Mesh {
    /// The plan of a terrain: a mesh in the plane with the same vertices and triangles, without heights. Its runs decide
    /// by two coordinates; [`Mesh::with_triangles`] gives the terrain the triangles that they make.
    ///
    /// ```
    /// use edgeflip::{Dimension, Mesh, Options, Plane, make_delaunay};
    /// use std::ops::ControlFlow;
    ///
    /// // y is up.
    /// let positions = vec![-3.0, 7.0, 0.0, 0.0, 8.5, -1.0, 3.0, 6.0, 0.0, 0.0, 9.0, 1.0];
    /// let terrain = Mesh::new(Dimension::Three, positions, vec![0, 2, 1, 0, 3, 2])?;
    /// let plan = terrain.plan(Plane::Xz)?;
    /// let outcome = make_delaunay(&plan, &Options::default(), |_, _| ControlFlow::Continue(()))?;
    /// let terrain = terrain.with_triangles(outcome.triangles)?;
    /// assert_eq!((outcome.flips, terrain.positions().len()), (1, 12));
    /// # Ok::<(), edgeflip::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Option`] for a mesh in the plane and another plane than xy.
    pub fn plan(&self, plane: Plane) -> Result<Self, Error> {
        let axes = plane.axes();
        let positions: Positions = match (self.dimension(), self.positions()) {
            (Dimension::Two, _) if plane == Plane::Xy => return Ok(self.clone()),
            (Dimension::Two, _) => {
                let message = format!("a mesh in the plane has no coordinate z for {}", plane.name());
                return Err(Error::Option { option: "plane", message });
            }
            (Dimension::Three, Positions::F32(numbers)) => pairs(numbers, axes).into(),
            (Dimension::Three, Positions::F64(numbers)) => pairs(numbers, axes).into(),
        };
        Ok(Self::of_checked(Dimension::Two, positions.narrowed(), self.triangles().to_vec()))
    }

    /// The first plane in which no triangle is turned over: those that are not flat there have one orientation. `None`
    /// if there is none, and for a mesh in the plane.
    #[must_use]
    pub fn terrain_plane(&self) -> Option<Plane> {
        if self.dimension() == Dimension::Two {
            return None;
        }
        Plane::ALL.into_iter().find(|plane| {
            let [u, v] = plane.axes();
            let sign = |corners: &[u32; 3]| {
                let [a, b, c] =
                    self.positions().points3(*corners).map(|point| DVec2::new(point[u], point[v]));
                area_sign(a, b, c)
            };
            let mut signs = self.triangles().as_chunks().0.iter().map(sign).filter(|sign| sign.is_ne());
            signs.next().is_some_and(|first| signs.all(|sign| sign == first))
        })
    }
}

/// Two of each three numbers.
fn pairs<T: Copy>(numbers: &[T], axes: [usize; 2]) -> Vec<T> {
    numbers.as_chunks::<3>().0.iter().flat_map(|point| axes.map(|axis| point[axis])).collect()
}
