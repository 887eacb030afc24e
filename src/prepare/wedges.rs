//! Wedges: the corners around a vertex that share their attributes, such as texture coordinates and normals.
//!
//! A barrier is a locked edge, a boundary edge or a frozen edge: no flip removes it. A sector is a run of corners at a
//! vertex from one barrier to the next, counter-clockwise. All corners of a sector have the same attributes, whatever
//! flips inside. The half-edge of the barrier at which a sector begins exists in every result, and identifies the
//! sector. Source: Hoppe, "Efficient implementation of progressive meshes", 1998 (wedges).

use crate::mesh::adjacency::{EdgeKind, edge_kind};
use crate::mesh::buckets::for_each_edge;
use crate::mesh::half_edge::{next, prev};
use crate::mesh::named_edges::ordered;
use crate::{Error, Mesh, NONE};

/// Keeps attributes at the corners of a mesh through flips: the edges and triangles to lock, and the attributes of each
/// corner of a result.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wedges {
    /// The attributes of each corner of the mesh, as a number.
    classes: Vec<u32>,
    /// The first corner of each vertex whose corners all have the same number; [`NONE`] for other vertices.
    first: Vec<u32>,
    /// The half-edges of barriers that start at a vertex with several numbers, by their two vertices.
    barriers: Vec<([u32; 2], u32)>,
    locked_edges: Vec<[u32; 2]>,
    locked_triangles: Vec<u32>,
    /// The vertices of the locked triangles.
    locked_vertices: Vec<u32>,
}

impl Wedges {
    /// Takes a number for each corner, 3 per triangle. Corners of the same vertex have the same attributes if they have
    /// the same number. Fast if the corners of each vertex have one number; else it visits all edges.
    ///
    /// # Errors
    /// [`Error::Option`] for a wrong number of corners.
    pub fn new(mesh: &Mesh, classes: Vec<u32>) -> Result<Self, Error> {
        let triangles = mesh.triangles();
        if classes.len() != triangles.len() {
            let message =
                format!("it has {} numbers, the mesh has {} corners", classes.len(), triangles.len());
            return Err(Error::Option { option: "classes", message });
        }
        let first = first_corners(mesh, &classes);
        let is_mixed = |h: u32| first[triangles[h as usize] as usize] == NONE;
        let class = |corner: u32| classes[corner as usize];
        let mut locked_edges = Vec::new();
        let mut locked_triangles = Vec::new();
        let mut barriers = Vec::new();
        if (0..triangles.len() as u32).any(is_mixed) {
            let mut twins = vec![NONE; triangles.len()];
            for_each_edge(mesh.vertex_count(), triangles, |half_edges| {
                if !is_mixed(half_edges[0]) && !is_mixed(next(half_edges[0])) {
                    return;
                }
                if let (EdgeKind::Interior, &[h, g]) = (edge_kind(half_edges, triangles), half_edges) {
                    if class(h) == class(next(g)) && class(next(h)) == class(g) {
                        (twins[h as usize], twins[g as usize]) = (g, h);
                        return;
                    }
                    locked_edges.push(ordered(ends(triangles, h)));
                }
                let starts = half_edges.iter().filter(|&&h| is_mixed(h));
                barriers.extend(starts.map(|&h| (ends(triangles, h), h)));
            });
            barriers.sort_unstable();
            // Half-edges with the same two vertices: in a result, only their triangles distinguish them.
            for alike in barriers.chunk_by(|x, y| x.0 == y.0) {
                if alike.iter().any(|&(_, h)| class(h) != class(alike[0].1)) {
                    locked_triangles.extend(alike.iter().map(|&(_, h)| h / 3));
                }
            }
            // A sector without a barrier goes all around its vertex.
            let mut sources = vec![NONE; triangles.len()];
            for &(_, h) in &barriers {
                spread(&mut sources, &twins, h, h);
            }
            for corner in (0..triangles.len() as u32).filter(|&corner| is_mixed(corner)) {
                if sources[corner as usize] == NONE {
                    spread(&mut sources, &twins, corner, corner);
                    locked_triangles.push(corner / 3);
                }
            }
            barriers.dedup_by_key(|&mut (ends, _)| ends);
            locked_triangles.sort_unstable();
            locked_triangles.dedup();
        }
        let locked_vertices = corners(&locked_triangles).map(|corner| triangles[corner as usize]).collect();
        Ok(Self { classes, first, barriers, locked_edges, locked_triangles, locked_vertices })
    }

    /// The seams: edges whose two triangles have different attributes at an end of the edge, in ascending order. Add
    /// them to [`Options::locked_edges`](crate::Options::locked_edges).
    pub fn locked_edges(&self) -> &[[u32; 2]] {
        &self.locked_edges
    }

    /// Triangles that have to stay, since no barrier would identify the attributes of their corners, in ascending
    /// order. They are few: only at frozen edges, and where several surfaces share a vertex. Add them to
    /// [`Options::locked_triangles`](crate::Options::locked_triangles).
    pub fn locked_triangles(&self) -> &[u32] {
        &self.locked_triangles
    }

    /// The number of each corner of a result: the triangles after flips with these edges and triangles locked.
    ///
    /// # Errors
    /// [`Error::TriangleCount`], [`Error::IndexOutOfRange`]; [`Error::Option`] for triangles that are not such a
    /// result, if that is noticed.
    pub fn carried(&self, triangles: &[u32]) -> Result<Vec<u32>, Error> {
        let mut sources = self.sources(triangles)?;
        sources.iter_mut().for_each(|corner| *corner = self.classes[*corner as usize]);
        Ok(sources)
    }

    /// The number of `corner` of the mesh.
    pub(crate) fn class(&self, corner: u32) -> u32 {
        self.classes[corner as usize]
    }

    /// The numbers given to [`Wedges::new`].
    pub(crate) fn into_classes(self) -> Vec<u32> {
        self.classes
    }

    /// For each corner of a result, a corner of the mesh with the same vertex and the same number.
    ///
    /// # Errors
    /// Those of [`Wedges::carried`].
    pub(crate) fn sources(&self, triangles: &[u32]) -> Result<Vec<u32>, Error> {
        let (length, expected) = (triangles.len(), self.classes.len());
        if length != expected {
            return Err(Error::TriangleCount { length, expected });
        }
        let vertices = self.first.len();
        if let Some(i) = triangles.iter().position(|&v| v as usize >= vertices) {
            return Err(Error::IndexOutOfRange { triangle: i / 3, index: triangles[i], vertices });
        }
        let mut sources: Vec<u32> = triangles.iter().map(|&v| self.first[v as usize]).collect();
        if !sources.contains(&NONE) {
            return Ok(sources);
        }
        let is_mixed = |h: u32| self.first[triangles[h as usize] as usize] == NONE;
        let mut twins = vec![NONE; triangles.len()];
        let (mut starts, mut seams) = (Vec::new(), 0);
        for_each_edge(vertices, triangles, |half_edges| {
            if !is_mixed(half_edges[0]) && !is_mixed(next(half_edges[0])) {
                return;
            }
            let is_seam = self.locked_edges.binary_search(&ordered(ends(triangles, half_edges[0]))).is_ok();
            seams += usize::from(is_seam);
            if let (EdgeKind::Interior, &[h, g]) = (edge_kind(half_edges, triangles), half_edges)
                && !is_seam
            {
                (twins[h as usize], twins[g as usize]) = (g, h);
                return;
            }
            starts.extend(half_edges.iter().filter(|&&h| is_mixed(h)));
        });
        for (&t, locked) in self.locked_triangles.iter().zip(self.locked_vertices.as_chunks().0) {
            let corner = |k: u32| 3 * t + k % 3;
            let is_turned = |turn: &u32| [0, 1, 2].map(|k| triangles[corner(k + turn) as usize]) == *locked;
            if let Some(turn) = (0..3).find(is_turned) {
                (0..3).for_each(|k| spread(&mut sources, &twins, corner(k + turn), corner(k)));
            }
        }
        for h in starts {
            if let Ok(index) =
                self.barriers.binary_search_by_key(&ends(triangles, h), |&(barrier, _)| barrier)
            {
                spread(&mut sources, &twins, h, self.barriers[index].1);
            }
        }
        let message = match sources.iter().position(|&source| source == NONE) {
            None if seams == self.locked_edges.len() => return Ok(sources),
            None => "an edge along a seam has flipped".to_owned(),
            Some(corner) => {
                format!("triangle {} cannot result from flips while seams are locked", corner / 3)
            }
        };
        Err(Error::Option { option: "triangles", message })
    }
}

/// The first corner of each vertex; [`NONE`] if its corners have several numbers.
fn first_corners(mesh: &Mesh, classes: &[u32]) -> Vec<u32> {
    let mut first = vec![NONE; mesh.vertex_count()];
    for (corner, &v) in mesh.triangles().iter().enumerate().rev() {
        first[v as usize] = corner as u32;
    }
    for (&v, class) in mesh.triangles().iter().zip(classes) {
        let first = &mut first[v as usize];
        if *first != NONE && classes[*first as usize] != *class {
            *first = NONE;
        }
    }
    first
}

/// The corners of some triangles.
fn corners(triangles: &[u32]) -> impl Iterator<Item = u32> {
    triangles.iter().flat_map(|&t| 3 * t..3 * t + 3)
}

/// The two vertices of a half-edge, in its direction.
fn ends(triangles: &[u32], h: u32) -> [u32; 2] {
    [h, next(h)].map(|x| triangles[x as usize])
}

/// Sets the source of a corner and of the following corners of its sector, counter-clockwise, up to one that has a
/// source.
fn spread(sources: &mut [u32], twins: &[u32], corner: u32, source: u32) {
    let mut at = corner;
    while at != NONE && sources[at as usize] == NONE {
        sources[at as usize] = source;
        at = twins[prev(at) as usize];
    }
}
