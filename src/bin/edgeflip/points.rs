//! Points instead of a mesh: what became of them.

use edgeflip::io::Loaded;
use edgeflip::{Dimension, Triangulation};
use indicatif::HumanCount;
use serde::Serialize;

/// The key `points` of `--json`.
#[derive(Serialize)]
pub struct Points {
    /// Whether they have a third coordinate.
    heights: bool,
    hull: Vec<u32>,
    duplicates: Vec<[u32; 2]>,
    #[serde(skip)]
    triangles: usize,
}

impl Points {
    /// The points of a file, after their triangulation.
    pub fn new(Triangulation { triangles, hull, duplicates, .. }: Triangulation, loaded: &Loaded) -> Self {
        let heights = loaded.mesh.dimension() == Dimension::Three;
        Self { heights, hull, duplicates, triangles: triangles.len() / 3 }
    }

    /// Edges whose ends are in triangles: of equal points, the first is.
    pub fn in_triangles(&self, edges: &mut [[u32; 2]]) {
        for end in edges.as_flattened_mut() {
            if let Ok(at) = self.duplicates.binary_search_by_key(end, |&[point, _]| point) {
                *end = self.duplicates[at][1];
            }
        }
    }

    /// What was read.
    pub fn found(&self, count: usize) -> String {
        let heights = if self.heights { " with heights" } else { "" };
        format!("{} points{heights}", HumanCount(count as u64))
    }

    /// What was made.
    pub fn made(&self) -> String {
        let hull = if self.triangles == 0 { 0 } else { self.hull.len() };
        let [triangles, hull, duplicates] =
            [self.triangles, hull, self.duplicates.len()].map(|n| HumanCount(n as u64));
        let left_out = match self.duplicates.first() {
            Some([point, same]) => {
                format!(
                    "; in no triangle because they equal others: {duplicates}, the first {point} as {same}"
                )
            }
            None => String::new(),
        };
        format!("{triangles} triangles, {hull} points on the hull{left_out}")
    }

    /// Why there is no triangle.
    pub fn note(&self) -> Option<String> {
        let why = match (self.triangles, self.hull.len()) {
            (1.., _) => return None,
            (_, ..3) => "there are fewer than three distinct points",
            _ => "all points are on one line",
        };
        Some(format!("no triangle: {why}"))
    }
}
