//! Reverses triangles, so that neighbours have the same orientation.

use crate::mesh::buckets::for_each_edge;
use crate::{Error, Mesh, NONE};

/// Flag in a list of neighbours: this neighbour has the opposite orientation, since it runs along the edge in the same
/// direction.
const AGAINST: u32 = 1 << 31;

/// `mesh` with consistent orientation, and the number of reversed triangles. Edges of two triangles join triangles into
/// components. In each component, the triangles with the less frequent orientation are reversed. A component that is
/// not orientable, such as a Möbius strip, stays unchanged. Reversing a triangle swaps its second and its third corner.
///
/// # Errors
/// Those of [`Mesh::new`], which do not occur for a valid mesh.
pub fn reoriented(mesh: &Mesh) -> Result<(Mesh, u32), Error> {
    let neighbours = neighbours(mesh);
    let count = mesh.triangle_count();
    let mut triangles = mesh.triangles().to_vec();
    let (mut is_turned, mut is_reached) = (vec![false; count], vec![false; count]);
    let mut turned = 0;
    let mut component: Vec<u32> = Vec::new();
    for start in 0..count as u32 {
        if std::mem::replace(&mut is_reached[start as usize], true) {
            continue;
        }
        component.clear();
        component.push(start);
        let mut is_orientable = true;
        let mut next = 0;
        while let Some(&t) = component.get(next) {
            next += 1;
            for &entry in neighbours[t as usize].iter().filter(|&&entry| entry != NONE) {
                let neighbour = entry & !AGAINST;
                let should_turn = is_turned[t as usize] ^ (entry & AGAINST != 0);
                if std::mem::replace(&mut is_reached[neighbour as usize], true) {
                    is_orientable &= is_turned[neighbour as usize] == should_turn;
                } else {
                    is_turned[neighbour as usize] = should_turn;
                    component.push(neighbour);
                }
            }
        }
        let marked = component.iter().filter(|&&t| is_turned[t as usize]).count();
        let turns_marked = 2 * marked <= component.len();
        for &t in component.iter().filter(|&&t| is_orientable && is_turned[t as usize] == turns_marked) {
            triangles.swap(3 * t as usize + 1, 3 * t as usize + 2);
            turned += 1;
        }
    }
    Ok((mesh.with_triangles(triangles)?, turned))
}

/// The neighbours of each triangle, across edges of two triangles.
fn neighbours(mesh: &Mesh) -> Vec<[u32; 3]> {
    let mut neighbours = vec![[NONE; 3]; mesh.triangle_count()];
    for_each_edge(mesh.vertex_count(), mesh.triangles(), |half_edges| {
        if let &[h, g] = half_edges
            && h / 3 != g / 3
        {
            let is_against = mesh.triangles()[h as usize] == mesh.triangles()[g as usize];
            for (x, y) in [(h, g), (g, h)] {
                neighbours[x as usize / 3][x as usize % 3] = (y / 3) | if is_against { AGAINST } else { 0 };
            }
        }
    });
    neighbours
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::by_name;
    use crate::{Adjacency, Dimension};
    use oorandom::Rand64;

    fn strip(triangles: &[u32], vertices: usize) -> Mesh {
        let positions = (0..3 * vertices).map(|i| i as f32).collect::<Vec<_>>();
        Mesh::new(Dimension::Three, positions, triangles.to_vec()).unwrap()
    }

    #[test]
    fn triangles_reversed_at_random_are_reversed_back() {
        for name in ["uvsphere 9", "random 8", "roof 5"] {
            let mesh = by_name(name).unwrap();
            let mut triangles = mesh.triangles().to_vec();
            let random = &mut Rand64::new(7);
            let mut count = 0;
            for triangle in triangles.chunks_mut(3).filter(|_| random.rand_float() < 0.3) {
                triangle.swap(1, 2);
                count += 1;
            }
            let dirty = mesh.with_triangles(triangles).unwrap();
            assert!(Adjacency::new(&dirty).inconsistent > 0);
            let (clean, turned) = reoriented(&dirty).unwrap();
            assert_eq!((clean, turned), (mesh, count), "{name}");
        }
    }

    /// Two of three triangles have one orientation: the third is reversed. A component of one triangle stays.
    #[test]
    fn the_minority_is_reversed() {
        let mesh = strip(&[0, 1, 2, 1, 2, 3, 2, 3, 4, 5, 7, 6], 8);
        let (clean, turned) = reoriented(&mesh).unwrap();
        assert_eq!((clean.triangles(), turned), (&[0, 1, 2, 1, 3, 2, 2, 3, 4, 5, 7, 6][..], 1));
    }

    #[test]
    fn a_moebius_strip_stays_unchanged() {
        let moebius = strip(&[0, 1, 2, 1, 3, 2, 2, 3, 4, 3, 5, 4, 4, 5, 1, 5, 0, 1], 6);
        assert!(Adjacency::new(&moebius).inconsistent > 0);
        assert_eq!(reoriented(&moebius).unwrap(), (moebius, 0));
    }

    #[test]
    fn edges_of_three_triangles_and_repeated_corners_join_nothing() {
        let book = strip(&[0, 1, 2, 0, 1, 3, 0, 1, 4, 5, 5, 6], 7);
        assert_eq!(reoriented(&book).unwrap(), (book, 0));
    }
}
