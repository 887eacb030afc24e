//! Edges that the user names by their two vertices.

use super::half_edge::next;
use crate::{Error, Mesh};

/// The half-edges of the edges that `pairs` name by their vertices, in ascending order.
///
/// # Errors
/// [`Error::Option`] with the first pair that is no edge of the mesh.
pub(crate) fn half_edges(mesh: &Mesh, pairs: &[[u32; 2]]) -> Result<Vec<u32>, Error> {
    let mut half_edges = Vec::new();
    if pairs.is_empty() {
        return Ok(half_edges);
    }
    let ordered = |[u, v]: [u32; 2]| (u.min(v), u.max(v));
    let mut edges: Vec<(u32, u32)> = pairs.iter().map(|&pair| ordered(pair)).collect();
    edges.sort_unstable();
    edges.dedup();
    let mut is_found = vec![false; edges.len()];
    // One lookup rules out most half-edges.
    let mut is_end = vec![false; mesh.vertex_count()];
    for &(u, _) in &edges {
        if let Some(is_end) = is_end.get_mut(u as usize) {
            *is_end = true;
        }
    }
    for h in 0..mesh.triangles().len() as u32 {
        let ends = ordered([h, next(h)].map(|x| mesh.triangles()[x as usize]));
        if is_end[ends.0 as usize]
            && let Ok(index) = edges.binary_search(&ends)
        {
            is_found[index] = true;
            half_edges.push(h);
        }
    }
    match pairs.iter().find(|&&pair| edges.binary_search(&ordered(pair)).is_ok_and(|index| !is_found[index]))
    {
        None => Ok(half_edges),
        Some([u, v]) => {
            let message = format!("the mesh has no edge between vertices {u} and {v}");
            Err(Error::Option { option: "locked_edges", message })
        }
    }
}
