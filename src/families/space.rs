//! Surfaces in space. Triangles are counter-clockwise seen from outside or from above.

use super::lattice::{at_least, fits, generator, signed, split, split_cells};
use crate::{Dimension, Error, Mesh};
use std::f64::consts::{PI, TAU};

/// A latitude-longitude sphere: two poles and `n` rings of `n` points, jittered along the rings, with
/// radius 1 + `amplitude`·sin 5φ·sin 4θ; quads split at random. n = 600 has the counts of the paper's
/// mesh 5. Vertex 0 is the pole at z = 1, the last vertex the pole at z = -1.
///
/// # Errors
/// [`Error::Option`] for n < 3, [`Error::TooLarge`].
pub fn uvsphere(n: usize, amplitude: f64, seed: u64) -> Result<Mesh, Error> {
    at_least(3, n, "uvsphere")?;
    let vertices = n.saturating_mul(n).saturating_add(2);
    fits(vertices, n.saturating_mul(n).saturating_mul(2))?;
    let mut random = generator(seed);
    let mut positions = Vec::with_capacity(3 * vertices);
    positions.extend([0.0, 0.0, 1.0]);
    for j in 0..n {
        let theta = PI * (j + 1) as f64 / (n + 1) as f64;
        let (sin, cos) = libm::sincos(theta);
        let wave = amplitude * libm::sin(4.0 * theta);
        for i in 0..n {
            let phi = TAU * (i as f64 + 0.3 * signed(&mut random)) / n as f64;
            let radius = 1.0 + wave * libm::sin(5.0 * phi);
            let (y, x) = libm::sincos(phi);
            positions.extend([radius * sin * x, radius * sin * y, radius * cos].map(|w| w as f32));
        }
    }
    positions.extend([0.0, 0.0, -1.0]);

    let vertex = |j: usize, i: usize| (1 + j * n + i % n) as u32;
    let last = (vertices - 1) as u32;
    let mut triangles = Vec::with_capacity(6 * n * n);
    triangles.extend((0..n).flat_map(|i| [0, vertex(0, i), vertex(0, i + 1)]));
    for j in 0..n - 1 {
        for i in 0..n {
            let quad = [vertex(j, i), vertex(j + 1, i), vertex(j + 1, i + 1), vertex(j, i + 1)];
            split(&mut triangles, quad, random.rand_float() < 0.5);
        }
    }
    triangles.extend((0..n).flat_map(|i| [last, vertex(n - 1, i + 1), vertex(n - 1, i)]));
    Mesh::new(Dimension::Three, positions, triangles)
}

/// Two planes that meet at a ridge at 90°, `n` cells deep on each side and `n` cells long, every cell
/// three times as long as deep so that many ridge edges are not Delaunay. Each plane is exactly flat: with
/// a β below 90° both become Delaunay and the ridge stays.
///
/// # Errors
/// [`Error::Option`] for n < 1, [`Error::TooLarge`].
pub fn roof(n: usize, seed: u64) -> Result<Mesh, Error> {
    at_least(1, n, "roof")?;
    let (columns, rows) = (n.saturating_mul(2).saturating_add(1), n.saturating_add(1));
    fits(columns.saturating_mul(rows), n.saturating_mul(n).saturating_mul(4))?;
    let mut random = generator(seed);
    let mut positions = Vec::with_capacity(3 * columns * rows);
    for j in 0..rows {
        for i in 0..columns {
            let jitter = [signed(&mut random), signed(&mut random)].map(|u| 0.25 * u);
            let fixed_x = i == 0 || i == n || i == columns - 1;
            let x = i as f64 - n as f64 + if fixed_x { 0.0 } else { jitter[0] };
            let y = j as f64 + if j == 0 || j == n { 0.0 } else { jitter[1] };
            let (x, y) = ((x / n as f64) as f32, (3.0 * y / n as f64) as f32);
            positions.extend([x, y, -x.abs()]);
        }
    }
    let triangles = split_cells(&positions, 3, columns, rows, &mut random);
    Mesh::new(Dimension::Three, positions, triangles)
}

/// Two fans of `n` triangles, with apexes at z = ±`h`, glued at their rim, the unit circle. The apexes are the opposite
/// vertices of every rim edge, so flips of several rim edges would make the same new edge.
///
/// # Errors
/// [`Error::Option`] for n < 3, [`Error::TooLarge`], [`Error::NonFinite`] for an h beyond f32.
pub fn pillow(n: usize, h: f64) -> Result<Mesh, Error> {
    at_least(3, n, "pillow")?;
    fits(n.saturating_add(2), n.saturating_mul(2))?;
    let mut positions = Vec::with_capacity(3 * (n + 2));
    for i in 0..n {
        let (y, x) = libm::sincos(TAU * i as f64 / n as f64);
        positions.extend([x as f32, y as f32, 0.0]);
    }
    positions.extend([0.0, 0.0, h as f32, 0.0, 0.0, -h as f32]);
    let rim = |i: usize| (i % n) as u32;
    let (top, bottom) = (n as u32, n as u32 + 1);
    let triangles = (0..n)
        .flat_map(|i| [rim(i), rim(i + 1), top])
        .chain((0..n).flat_map(|i| [rim(i + 1), rim(i), bottom]));
    Mesh::new(Dimension::Three, positions, triangles.collect())
}

/// One vertex with `n` triangles around it: a shallow cone whose rim is so ragged that most of the edges
/// at the apex (vertex 0) are not Delaunay.
///
/// # Errors
/// [`Error::Option`] for n < 3, [`Error::TooLarge`].
pub fn pole(n: usize, seed: u64) -> Result<Mesh, Error> {
    at_least(3, n, "pole")?;
    fits(n.saturating_add(1), n)?;
    let mut random = generator(seed);
    let mut positions = Vec::with_capacity(3 * (n + 1));
    positions.extend([0.0, 0.0, 0.1]);
    for i in 0..n {
        let radius = 1.0 + 0.3 * signed(&mut random);
        let (y, x) = libm::sincos(TAU * i as f64 / n as f64);
        positions.extend([radius * x, radius * y, 0.1 * (1.0 - radius)].map(|w| w as f32));
    }
    let triangles = (0..n).flat_map(|i| [0, 1 + i as u32, 1 + ((i + 1) % n) as u32]);
    Mesh::new(Dimension::Three, positions, triangles.collect())
}
