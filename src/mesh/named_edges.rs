//! Edges that the user names by their two vertices.

use super::half_edge::next;
use crate::{Error, Mesh};

/// A constraint that was left out.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(serde::Serialize))]
pub struct LeftOut {
    /// Its index in the list of constraints.
    pub index: usize,
    /// A sentence that says why, with the vertices and what it crosses.
    pub reason: String,
}

/// The half-edges of the edges that `pairs` name by their vertices, in ascending order.
///
/// # Errors
/// [`Error::Option`] with the first pair that is no edge of the mesh.
pub(crate) fn half_edges(mesh: &Mesh, pairs: &[[u32; 2]]) -> Result<Vec<u32>, Error> {
    let mut half_edges = Vec::new();
    if pairs.is_empty() {
        return Ok(half_edges);
    }
    let tuple = |pair| <(u32, u32)>::from(ordered(pair));
    let mut edges: Vec<_> = pairs.iter().map(|&pair| tuple(pair)).collect();
    edges.sort_unstable();
    edges.dedup();
    let mut is_found = vec![false; edges.len()];
    // The edges with a smaller vertex v are those from starts[v] to starts[v + 1].
    let mut starts = vec![0u32; mesh.vertex_count() + 1];
    for &(u, _) in &edges {
        if (u as usize) < mesh.vertex_count() {
            starts[u as usize + 1] += 1;
        }
    }
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    for h in 0..mesh.triangles().len() as u32 {
        let ends = tuple([h, next(h)].map(|x| mesh.triangles()[x as usize]));
        let [start, end] = [0, 1].map(|i| starts[ends.0 as usize + i] as usize);
        if start < end
            && let Ok(index) = edges[start..end].binary_search(&ends)
        {
            is_found[start + index] = true;
            half_edges.push(h);
        }
    }
    let is_missing =
        |&&pair: &&[u32; 2]| edges.binary_search(&tuple(pair)).is_ok_and(|index| !is_found[index]);
    if is_found.contains(&false)
        && let Some([u, v]) = pairs.iter().find(is_missing)
    {
        let message = format!("the mesh has no edge between vertices {u} and {v}");
        return Err(Error::Option { option: "locked_edges", message });
    }
    Ok(half_edges)
}

/// The two vertices of an edge, the smaller one first.
pub(crate) fn ordered([u, v]: [u32; 2]) -> [u32; 2] {
    [u.min(v), u.max(v)]
}
