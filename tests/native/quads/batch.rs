//! A mesh of many quads that share no vertex, and the exact verdict on each.

use super::kinds::{Kind, Quad, Source};
use crate::simulation::Predicates;
use edgeflip::{Dimension, Mesh, Reason};
use std::ops::Range;

/// Thresholds in degrees. All except 10° have an exact cosine.
const BETAS: [f64; 6] = [10.0, 0.0, 60.0, 90.0, 120.0, 180.0];

/// Exponents of the powers of two by which coordinates are multiplied. With the largest, coordinates are up to 2^125;
/// with the smallest, most are subnormal.
const SCALES: [i32; 5] = [0, 101, -64, -89, -126];

/// The limit for the deviation before scaling, in batches that have a limit.
pub const DEVIATION: f32 = 0.1;

/// The number of batches for `quads` quads. 12 batches have every threshold in both dimensions, and every scale. 60
/// batches have every combination of them. In a browser, every batch takes about a second, however small it is.
pub fn batch_count(quads: usize) -> usize {
    (quads / 8000).clamp(12, BETAS.len() * SCALES.len() * 2)
}

/// The exact verdict on the edge of a quad.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Delaunay,
    Labelled,
    Angle,
    Fold,
    Deviation,
}

/// The numbers of quads by verdict.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    pub quads: usize,
    /// Quads whose verdict depends on a sign that is zero.
    pub ties: usize,
    pub labelled: usize,
    pub angle: usize,
    pub fold: usize,
    pub deviation: usize,
}

/// Quad i has the vertices a = 4i, b = 4i + 1, c = 4i + 2, d = 4i + 3 and the triangles (a, b, c), (b, a, d).
pub struct Batch {
    pub index: usize,
    /// β in degrees.
    pub beta: f64,
    /// The limit for the deviation.
    pub deviation: f64,
    pub mesh: Mesh,
    /// The verdict on each quad, and whether it depends on a sign that is zero.
    pub verdicts: Vec<(Verdict, bool)>,
    /// The quads of each kind, one kind after the other.
    pub kinds: Vec<(&'static str, Range<usize>)>,
}

/// Makes batch `index` with at least `quads` quads, the same number of each kind. `beyond`: also of the kinds beyond
/// the span of the GPU engines.
pub fn batch(index: usize, quads: usize, beyond: bool) -> Batch {
    let dimension = [Dimension::Two, Dimension::Three][index % 2];
    let beta = BETAS[index / 2 % BETAS.len()];
    let is_wide = is_wide(index);
    // Half of the batches whose β allows large angles have a limit. With a limit, doubles are not scaled, because the
    // limit is a 32-bit float.
    let is_limited = dimension == Dimension::Three && beta >= 120.0 && (index / 12).is_multiple_of(2);
    let scale = if is_limited && is_wide { 0 } else { SCALES[index % SCALES.len()] };
    let deviation = if is_limited { f64::from(DEVIATION) * 2f64.powi(scale) } else { f64::INFINITY };
    let each = quads.div_ceil(Kind::all(dimension, beyond).count());
    let mut source = Source::new((index as u128) << 1 | u128::from(beyond), dimension, beta, scale, is_wide);
    let (mut positions, mut verdicts, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
    for kind in Kind::all(dimension, beyond) {
        let made: Vec<Quad> = (0..each).map(|_| kind.quad(&mut source)).collect();
        let points = made.as_flattened().iter();
        let chunk = mesh(dimension, points.flat_map(|point| &point[..dimension.stride()]).copied().collect());
        kinds.push((kind.name, verdicts.len()..verdicts.len() + each));
        verdicts.extend(judge(&chunk, beta, deviation));
        positions.extend(chunk.positions().iter());
    }
    Batch { index, beta, deviation, mesh: mesh(dimension, positions), verdicts, kinds }
}

/// Whether the coordinates of the batch are doubles. Half of the batches of each dimension and each β have doubles.
pub fn is_wide(index: usize) -> bool {
    (index / 2 + index / 12) % 2 == 1
}

fn mesh(dimension: Dimension, positions: Vec<f64>) -> Mesh {
    let vertices = (positions.len() / dimension.stride()) as u32;
    let triangles = (0..vertices).step_by(4).flat_map(|a| [a, a + 1, a + 2, a + 1, a, a + 3]).collect();
    Mesh::new(dimension, positions, triangles).unwrap()
}

/// The exact verdict on each quad, and whether it depends on a sign that is zero.
fn judge(mesh: &Mesh, beta: f64, deviation: f64) -> impl Iterator<Item = (Verdict, bool)> {
    let predicates = Predicates::new(mesh, beta, deviation);
    let is_plane = mesh.dimension() == Dimension::Two;
    (0..mesh.vertex_count() as u32).step_by(4).map(move |a| {
        let [b, c, d] = [a + 1, a + 2, a + 3];
        let clockwise = is_plane && predicates.area([a, b, c]) + predicates.area([b, a, d]) < 0.into();
        let (verdict, is_tie) = predicates.decide([a, b, c, d], clockwise);
        let verdict = match verdict {
            None => Verdict::Delaunay,
            Some(Ok(())) => Verdict::Labelled,
            Some(Err(Reason::Angle)) => Verdict::Angle,
            Some(Err(Reason::Deviation)) => Verdict::Deviation,
            Some(Err(_)) => Verdict::Fold,
        };
        (verdict, is_tie)
    })
}

impl Batch {
    /// The dimension and the width of the coordinates.
    pub fn form(&self) -> String {
        let width = if is_wide(self.index) { "f64" } else { "f32" };
        format!("{}D {width}", self.mesh.dimension().stride())
    }

    /// What an iteration does to the triangles.
    pub fn triangles_after(&self) -> Vec<u32> {
        let quads = (0u32..).step_by(4).zip(&self.verdicts);
        quads
            .flat_map(|(a, (verdict, _))| match verdict {
                Verdict::Labelled => [a, a + 3, a + 2, a + 1, a + 2, a + 3],
                _ => [a, a + 1, a + 2, a + 1, a, a + 3],
            })
            .collect()
    }

    /// The tally of some quads.
    pub fn tally(&self, quads: Range<usize>) -> Tally {
        let verdicts = &self.verdicts[quads];
        let count = |wanted| verdicts.iter().filter(|(verdict, _)| *verdict == wanted).count();
        Tally {
            quads: verdicts.len(),
            ties: verdicts.iter().filter(|(_, is_tie)| *is_tie).count(),
            labelled: count(Verdict::Labelled),
            angle: count(Verdict::Angle),
            fold: count(Verdict::Fold),
            deviation: count(Verdict::Deviation),
        }
    }

    /// A batch of some of its quads.
    pub fn part(&self, quads: Range<usize>) -> Self {
        let stride = 4 * self.mesh.dimension().stride();
        let positions = self.mesh.positions().iter().take(stride * quads.end).skip(stride * quads.start);
        let mesh = mesh(self.mesh.dimension(), positions.collect());
        Self { mesh, verdicts: self.verdicts[quads].to_vec(), kinds: Vec::new(), ..*self }
    }

    /// The coordinates and the verdict of a quad, in a form that can be copied into a test.
    pub fn describe(&self, quad: usize) -> String {
        let part = self.part(quad..quad + 1);
        let numbers: Vec<_> = part.mesh.positions().iter().map(|x| format!("{x:?}")).collect();
        let kind = self.kinds.iter().find(|(_, quads)| quads.contains(&quad)).map_or("", |(name, _)| name);
        let (index, beta, (verdict, _)) = (self.index, self.beta, self.verdicts[quad]);
        format!("quad {quad} of batch {index}, {kind}, β = {beta}: [{}] is {verdict:?}", numbers.join(", "))
    }
}
