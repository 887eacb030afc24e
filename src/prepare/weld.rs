//! Vertices at one place joined, so that edges flip where only attributes change from one vertex to the other, or where
//! triangles share no vertices at all; and the triangles of such a mesh given their own vertices again.

use crate::{Error, Mesh, Wedges, reoriented};

/// A mesh whose vertices at one place are one.
#[derive(Clone, Debug, PartialEq)]
pub struct Welded {
    /// The same vertices, of which triangles name the first of each place.
    pub mesh: Mesh,
    /// What has to be locked, so that each corner finds a vertex with its attributes again.
    pub wedges: Wedges,
    /// For each vertex the first one at its place.
    pub places: Vec<u32>,
    /// The vertex of each corner before.
    corners: Vec<u32>,
}

/// Joins the vertices at exactly the same position; -0 is 0. `attributes` is a number for each vertex: vertices of one
/// place with the same number are the same in all else. Without it all vertices of a place are.
///
/// # Errors
/// [`Error::Option`] for another number of vertices.
pub fn welded(mesh: &Mesh, attributes: Option<&[u32]>) -> Result<Welded, Error> {
    let count = mesh.vertex_count();
    if let Some(attributes) = attributes
        && attributes.len() != count
    {
        let message = format!("it has {} numbers, the mesh has {count} vertices", attributes.len());
        return Err(Error::Option { option: "attributes", message });
    }
    let places = first_alike((0..count as u32).map(|vertex| place(mesh, vertex)));
    Welded::new(mesh, places, attributes.unwrap_or(&vec![0; count]))
}

impl Welded {
    /// `places` and `attributes` have a number for each vertex: the first one at its place, and that of [`welded`].
    pub(crate) fn new(mesh: &Mesh, places: Vec<u32>, attributes: &[u32]) -> Result<Self, Error> {
        let corners = mesh.triangles().to_vec();
        let joined = mesh.with_triangles(corners.iter().map(|&v| places[v as usize]).collect())?;
        let wedges = Wedges::new(&joined, corners.iter().map(|&v| attributes[v as usize]).collect())?;
        Ok(Self { mesh: joined, wedges, places, corners })
    }

    /// How many vertices are joined to another one.
    pub fn joined(&self) -> usize {
        (0..).zip(&self.places).filter(|&(vertex, first)| *first != vertex).count()
    }

    /// The same with triangles turned, as by [`reoriented`], and how many were.
    ///
    /// # Errors
    /// None for a mesh that is one.
    pub fn reoriented(mut self) -> Result<(Self, u32), Error> {
        let (mesh, turned) = reoriented(&self.mesh)?;
        let mut classes = self.wedges.into_classes();
        for i in (1..self.corners.len()).step_by(3) {
            if mesh.triangles()[i] != self.mesh.triangles()[i] {
                self.corners.swap(i, i + 1);
                classes.swap(i, i + 1);
            }
        }
        let wedges = Wedges::new(&mesh, classes)?;
        Ok((Self { mesh, wedges, ..self }, turned))
    }

    /// The triangles of a result, each corner with a vertex of its place that has its attributes: the one that it had, if
    /// its triangle has that still, or one that another corner had. [`Wedges::carried`] says what a result is.
    ///
    /// # Errors
    /// As there.
    pub fn split(&self, triangles: &[u32]) -> Result<Vec<u32>, Error> {
        let mut sources = self.wedges.sources(triangles)?;
        for (corner, source) in (0..).zip(&mut sources) {
            let is_there = self.mesh.triangles()[corner as usize] == triangles[corner as usize];
            if is_there && self.wedges.class(corner) == self.wedges.class(*source) {
                *source = corner;
            }
            *source = self.corners[*source as usize];
        }
        Ok(sources)
    }
}

/// The bits of a position, of which equal ones have the same.
pub(crate) fn place(mesh: &Mesh, vertex: u32) -> [u64; 3] {
    // -0 + 0 is 0.
    mesh.point3(vertex).to_array().map(|x| (x + 0.0).to_bits())
}

/// For each of these the place of the first one that is equal. They are sorted: nothing can make that slow, as it can
/// hashes.
pub(crate) fn first_alike<T: Ord>(these: impl Iterator<Item = T>) -> Vec<u32> {
    let mut sorted: Vec<(T, u32)> = these.zip(0..).collect();
    sorted.sort_unstable();
    let mut first = vec![0; sorted.len()];
    for alike in sorted.chunk_by(|x, y| x.0 == y.0) {
        alike.iter().for_each(|&(_, i)| first[i as usize] = alike[0].1);
    }
    first
}
