//! The result of a parser.

use super::pieces;
use super::polygon::{self, Cut};
use crate::system::threads::Threads;
use crate::{Dimension, Plane, Positions};
use glam::DVec3;

/// The most polygons of one piece of work.
const POLYGONS: usize = 1 << 12;

/// Faces as triangles. A polygon is the fan around its first corner until [`CutFaces::cut`], which needs the positions.
#[derive(Default)]
pub(super) struct CutFaces {
    /// Vertex indices, 3 per triangle.
    pub(super) triangles: Vec<u32>,
    /// The number of faces.
    faces: u32,
    polygons: Vec<Polygon>,
}

/// A face with more than 3 corners.
#[derive(Clone, Copy)]
struct Polygon {
    /// Its number in the file, from 0.
    face: u32,
    /// The number of its first triangle.
    first: u32,
    corners: u32,
}

/// How the polygons of a file are cut.
#[derive(Default)]
pub(super) struct Polygons {
    pub(super) count: usize,
    /// Those that are not cut into fans.
    pub(super) others: Others,
    /// The numbers of those whose outline crosses or touches itself, seen along their normal.
    pub(super) crossing: Vec<u32>,
}

/// The first triangle of each polygon that is not cut into a fan, and its triangles of corners, in the order of the file.
pub(super) type Others = Vec<(u32, Vec<[usize; 3]>)>;

impl CutFaces {
    /// Triangles, and no polygons.
    pub(super) fn of(triangles: Vec<u32>) -> Self {
        Self { triangles, ..Self::default() }
    }

    /// Adds a face of at least 3 corners.
    pub(super) fn push(&mut self, corners: &[u32]) {
        let Some((&first, rest)) = corners.split_first() else { return };
        if rest.len() > 2 {
            // More triangles than u32 counts are refused with the mesh.
            let first = (self.triangles.len() / 3) as u32;
            self.polygons.push(Polygon { face: self.faces, first, corners: corners.len() as u32 });
        }
        self.faces = self.faces.wrapping_add(1);
        for pair in rest.windows(2) {
            self.triangles.extend_from_slice(&[first, pair[0], pair[1]]);
        }
    }

    /// Joins the pieces of a file, in order.
    pub(super) fn joined(parts: Vec<Self>, threads: &Threads) -> Self {
        let (mut polygons, mut faces, mut triangles) = (Vec::new(), 0, 0);
        for part in &parts {
            polygons.extend(part.polygons.iter().map(|&Polygon { face, first, corners }| Polygon {
                face: faces + face,
                first: triangles + first,
                corners,
            }));
            faces += part.faces;
            triangles += (part.triangles.len() / 3) as u32;
        }
        let triangles = parts.into_iter().map(|part| part.triangles).collect();
        Self { triangles: pieces::joined(triangles, threads), faces, polygons }
    }

    /// Cuts the polygons that their fans leave in another way: along their normals, or from above in a plane.
    pub(super) fn cut(
        &mut self,
        positions: &Positions,
        dimension: Dimension,
        plane: Option<Plane>,
    ) -> Polygons {
        let threads = Threads::default().for_triangles(self.polygons.len());
        let stride = dimension.stride();
        let point = |vertex: u32| {
            let at = |axis| if axis < stride { positions.at(stride * vertex as usize + axis) } else { 0.0 };
            match plane.map(Plane::axes) {
                Some([u, v]) => DVec3::new(at(u), at(v), 0.0),
                None => DVec3::new(at(0), at(1), at(2)),
            }
        };
        let cuts = threads.map_each(self.polygons.chunks(POLYGONS).collect(), |piece: &[Polygon]| {
            let mut corners = Vec::new();
            let cut = |polygon: &Polygon| {
                if let Some(corners) = polygon.quadrilateral(&self.triangles)
                    && polygon::is_far_from_concave(corners.map(point))
                {
                    return None;
                }
                corners.clear();
                corners.extend(polygon.vertices(&self.triangles).map(point));
                Some((*polygon, polygon::cut(&corners))).filter(|(_, cut)| *cut != Cut::Fan)
            };
            piece.iter().filter_map(cut).collect::<Vec<_>>()
        });
        let mut polygons = Polygons { count: self.polygons.len(), ..Polygons::default() };
        for (polygon, cut) in cuts.into_iter().flatten() {
            match cut {
                Cut::Fan => {}
                Cut::Crossing => polygons.crossing.push(polygon.face),
                Cut::Others(triangles) => {
                    let vertices: Vec<u32> = polygon.vertices(&self.triangles).collect();
                    let corners = triangles.as_flattened().iter().map(|&corner| vertices[corner]);
                    let start = 3 * polygon.first as usize;
                    self.triangles.splice(start..start + 3 * triangles.len(), corners);
                    polygons.others.push((polygon.first, triangles));
                }
            }
        }
        polygons
    }
}

impl Polygon {
    /// Its four corners, if it has four.
    fn quadrilateral(self, triangles: &[u32]) -> Option<[u32; 4]> {
        match &triangles[3 * self.first as usize..] {
            &[a, b, c, _, _, d, ..] if self.corners == 4 => Some([a, b, c, d]),
            _ => None,
        }
    }

    /// The vertices of its corners, from its fan.
    fn vertices(self, triangles: &[u32]) -> impl Iterator<Item = u32> {
        let first = 3 * self.first as usize;
        let fan = &triangles[first..first + 3 * (self.corners as usize - 2)];
        fan[..2].iter().chain(fan[2..].iter().step_by(3)).copied()
    }
}

/// What a file has that a [`crate::Mesh`] cannot hold, each named once.
#[derive(Default)]
pub(super) struct Dropped(pub(super) Vec<String>);

impl Dropped {
    /// Adds a name.
    pub(super) fn note(&mut self, what: &str) {
        if !self.0.iter().any(|known| known == what) {
            self.0.push(what.to_owned());
        }
    }
}

/// The result of a parser: finite positions, and indices in range.
pub(super) struct Parsed {
    /// Numbers per vertex: 2 or 3.
    pub(super) stride: usize,
    /// `stride` numbers per vertex.
    pub(super) positions: Positions,
    /// The faces.
    pub(super) faces: CutFaces,
    /// What was dropped.
    pub(super) dropped: Dropped,
    /// Whether the positions lose digits of the file. If the parser was asked to notice, the rest was not read.
    pub(super) loses: bool,
}
