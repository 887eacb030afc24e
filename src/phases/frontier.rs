//! The frontier: the triangles that the next iteration looks at. An edge's verdict can change only where one
//! of its triangles has changed, or, for duplicates, anywhere.

use crate::NONE;
use crate::adjacency::unflagged;

/// A list of triangles, each once.
#[derive(Clone, Debug)]
pub(crate) struct Frontier {
    pub(crate) active: Vec<u32>,
    next: Vec<u32>,
    /// The iteration, plus one, in which a triangle was last appended.
    stamps: Vec<u32>,
}

impl Frontier {
    /// All triangles of a mesh.
    pub(crate) fn all(triangles: u32) -> Self {
        let next = Vec::with_capacity(triangles as usize);
        Self { active: (0..triangles).collect(), next, stamps: vec![0; triangles as usize] }
    }

    /// Replaces the list, after the flips of `iteration`: the flipped triangles and their neighbours, and
    /// those with an edge that was labelled and not flipped or was blocked as a duplicate.
    pub(crate) fn advance(&mut self, iteration: u32, twins: &[u32], best: &[u32], selected: &[u32]) {
        let Self { active, next, stamps } = self;
        let mut append = |t: u32| {
            let stamp = &mut stamps[t as usize];
            if *stamp != iteration + 1 {
                *stamp = iteration + 1;
                next.push(t);
            }
        };
        for &t in active.iter() {
            if selected[t as usize] != NONE {
                append(t);
                for &twin in &twins[3 * t as usize..3 * t as usize + 3] {
                    if twin != NONE {
                        append(unflagged(twin) / 3);
                    }
                }
            } else if best[t as usize] != NONE {
                append(t);
            }
        }
        std::mem::swap(active, next);
        next.clear();
    }
}
