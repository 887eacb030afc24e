//! Surfaces with the counts of meshes 1, 2 and 4 of the paper. The paper does not give its meshes; those with the same
//! counts are others.

use edgeflip::{Dimension, Error, Mesh};
use oorandom::Rand64;
use std::f64::consts::TAU;

/// Angle of each cell's jitter, as a part of the cell.
const JITTER: f64 = 0.3;
/// Radius of the tube; the radius of the ring is 1.
const TUBE: f64 = 0.4;

/// Positions and triangles.
type Parts = (Vec<f32>, Vec<u32>);

/// Vertices, edges and triangles as mesh 1 of the paper, without its swapped columns: 32, 102 and 68.
pub fn mesh_1() -> Result<Mesh, Error> {
    double_torus([3, 5], [4, 5])
}

/// As mesh 2: 1,222, 3,672 and 2,448.
pub fn mesh_2() -> Result<Mesh, Error> {
    double_torus([25, 25], [24, 25])
}

/// As mesh 4: 23,490, 70,290 and 40,648. A torus of 145 x 162 vertices has 180 edges more. It loses 180 cells, each with
/// its diagonal, and one triangle of 5,972 other cells: 18,636 boundary edges.
pub fn mesh_4() -> Result<Mesh, Error> {
    const ROWS: usize = 145;
    const COLUMNS: usize = 162;
    const CELLS: usize = 180;
    const TRIANGLES: usize = 5972;
    let (positions, triangles) = torus(ROWS, COLUMNS, 0.0);
    // Holes share no edge: they are in cells of one colour of a chessboard, and in its even part.
    let is_black = |cell: usize| {
        let (row, column) = (cell / COLUMNS, cell % COLUMNS);
        (row + column) % 2 == 0 && row < ROWS - 1
    };
    let mut holes = 0;
    let mut kept = Vec::new();
    for (cell, pair) in triangles.chunks_exact(6).enumerate() {
        let hole = is_black(cell).then_some(holes).filter(|&hole| hole < CELLS + TRIANGLES);
        holes += usize::from(is_black(cell));
        match hole {
            Some(hole) if hole < CELLS => {}
            Some(_) => kept.extend(&pair[..3]),
            None => kept.extend(pair),
        }
    }
    Mesh::new(Dimension::Three, positions, kept)
}

/// Two tori of `[rows, columns]` vertices, glued along a triangle that both lose.
fn double_torus(first: [usize; 2], second: [usize; 2]) -> Result<Mesh, Error> {
    let (mut positions, mut triangles) = torus(first[0], first[1], 0.0);
    let (other_positions, other_triangles) = torus(second[0], second[1], 2.0 * (1.0 + TUBE) + 0.1);
    // The triangle of the first torus that is farthest to the right, and of the second, farthest to the left.
    let (at, of_first) = outermost(&positions, &triangles, 1.0);
    let (other_at, of_second) = outermost(&other_positions, &other_triangles, -1.0);
    triangles.drain(at..at + 3);
    // The corners of the second run the other way round.
    let glued = [of_first[0], of_first[2], of_first[1]];
    let mut vertex_of = Vec::new();
    for (v, position) in (0u32..).zip(other_positions.chunks_exact(3)) {
        vertex_of.push(match of_second.iter().position(|&corner| corner == v) {
            Some(k) => glued[k],
            None => {
                positions.extend(position);
                (positions.len() / 3 - 1) as u32
            }
        });
    }
    for (t, triangle) in other_triangles.chunks_exact(3).enumerate() {
        if 3 * t != other_at {
            triangles.extend(triangle.iter().map(|&v| vertex_of[v as usize]));
        }
    }
    Mesh::new(Dimension::Three, positions, triangles)
}

/// The triangle whose centre has the largest x times `side`: its first index and its vertices.
fn outermost(positions: &[f32], triangles: &[u32], side: f32) -> (usize, [u32; 3]) {
    let x = |t: &[u32]| side * t.iter().map(|&v| positions[3 * v as usize]).sum::<f32>();
    let best = triangles.chunks_exact(3).enumerate().max_by(|(_, s), (_, t)| x(s).total_cmp(&x(t)));
    best.map_or((0, [0; 3]), |(i, t)| (3 * i, [t[0], t[1], t[2]]))
}

/// A torus with its centre at x = `shift`: `rows` rings around the tube of `columns` jittered vertices. Six indices for
/// each cell, split at random.
fn torus(rows: usize, columns: usize, shift: f64) -> Parts {
    let mut random = Rand64::new(1);
    let mut positions = Vec::new();
    for j in 0..rows {
        let (sin, cos) = libm::sincos(TAU * j as f64 / rows as f64);
        for i in 0..columns {
            let phi = TAU * (i as f64 + JITTER * (2.0 * random.rand_float() - 1.0)) / columns as f64;
            let (y, x) = libm::sincos(phi);
            let radius = 1.0 + TUBE * cos;
            positions.extend([radius * x + shift, radius * y, TUBE * sin].map(|w| w as f32));
        }
    }
    let vertex = |j: usize, i: usize| (j % rows * columns + i % columns) as u32;
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let [p, q, r, s] = [vertex(j, i), vertex(j, i + 1), vertex(j + 1, i + 1), vertex(j + 1, i)];
            let is_along_pr = random.rand_float() < 0.5;
            triangles.extend(if is_along_pr { [p, q, r, p, r, s] } else { [p, q, s, q, r, s] });
        }
    }
    (positions, triangles)
}
