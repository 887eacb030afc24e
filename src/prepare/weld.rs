//! Welds vertices at the same position, so that edges between them can flip, and splits them again after the run. Files
//! repeat a vertex where attributes differ, or repeat the vertices of every triangle.

use crate::{Error, Mesh, Wedges, reoriented};

/// A mesh whose vertices at the same position are joined.
#[derive(Clone, Debug, PartialEq)]
pub struct Welded {
    /// The same vertices. Triangles use the first vertex at each position.
    pub mesh: Mesh,
    /// The locks that each corner needs to find a vertex with its attributes again.
    pub wedges: Wedges,
    /// For each vertex, the first vertex at its position.
    pub places: Vec<u32>,
    /// The vertex of each corner before the weld.
    corners: Vec<u32>,
}

/// Joins the vertices at exactly the same position; -0 equals 0. `attributes` is a number for each vertex: vertices at
/// the same position with the same number have the same attributes. Without `attributes`, all vertices at a position
/// have the same attributes.
///
/// # Errors
/// [`Error::Option`] for a wrong number of `attributes`.
pub fn welded(mesh: &Mesh, attributes: Option<&[u32]>) -> Result<Welded, Error> {
    let count = mesh.vertex_count();
    if let Some(attributes) = attributes
        && attributes.len() != count
    {
        let message = format!("it has {} numbers, the mesh has {count} vertices", attributes.len());
        return Err(Error::Option { option: "attributes", message });
    }
    let places = first_alike((0..count as u32).map(|vertex| position_bits(mesh, vertex)));
    Welded::new(mesh, places, attributes.unwrap_or(&vec![0; count]))
}

impl Welded {
    /// For each vertex, `places` has the first vertex at its position, and `attributes` the number as in [`welded`].
    pub(crate) fn new(mesh: &Mesh, places: Vec<u32>, attributes: &[u32]) -> Result<Self, Error> {
        let corners = mesh.triangles().to_vec();
        let joined = mesh.with_triangles(corners.iter().map(|&v| places[v as usize]).collect())?;
        let wedges = Wedges::new(&joined, corners.iter().map(|&v| attributes[v as usize]).collect())?;
        Ok(Self { mesh: joined, wedges, places, corners })
    }

    /// How many vertices are joined to an earlier one.
    pub fn joined(&self) -> usize {
        (0..).zip(&self.places).filter(|&(vertex, first)| *first != vertex).count()
    }

    /// The same with the mesh [`reoriented`], and the number of reversed triangles.
    ///
    /// # Errors
    /// Those of [`reoriented`].
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

    /// Splits the vertices again. Returns the triangles of a result, in which each corner has a vertex at its position
    /// with its attributes. A corner that did not move keeps its vertex. [`Wedges::carried`] defines a result.
    ///
    /// # Errors
    /// Those of [`Wedges::carried`].
    pub fn split(&self, triangles: &[u32]) -> Result<Vec<u32>, Error> {
        let mut sources = self.wedges.sources(triangles)?;
        for (corner, source) in (0..).zip(&mut sources) {
            let is_kept = self.mesh.triangles()[corner as usize] == triangles[corner as usize];
            if is_kept && self.wedges.class(corner) == self.wedges.class(*source) {
                *source = corner;
            }
            *source = self.corners[*source as usize];
        }
        Ok(sources)
    }
}

/// The bits of a position. Equal positions have equal bits.
pub(crate) fn position_bits(mesh: &Mesh, vertex: u32) -> [u64; 3] {
    // -0 + 0 is 0.
    mesh.point3(vertex).to_array().map(|x| (x + 0.0).to_bits())
}

/// For each item, the index of the first equal item. It sorts the items, because some inputs make hashing slow, and
/// none makes sorting slow.
pub(crate) fn first_alike<T: Ord>(these: impl Iterator<Item = T>) -> Vec<u32> {
    let mut sorted: Vec<(T, u32)> = these.zip(0..).collect();
    sorted.sort_unstable();
    let mut first = vec![0; sorted.len()];
    for alike in sorted.chunk_by(|x, y| x.0 == y.0) {
        alike.iter().for_each(|&(_, i)| first[i as usize] = alike[0].1);
    }
    first
}
