//! What the families share: checks of sizes, random numbers, and lattices whose cells are cut into triangles.

use crate::mesh::MAX_TRIANGLES;
use crate::system::memory;
use crate::{Error, NONE};
use oorandom::Rand64;

/// Refuses an n below the family's smallest.
pub(super) fn at_least(smallest: usize, n: usize, family: &str) -> Result<(), Error> {
    if n >= smallest {
        return Ok(());
    }
    Err(Error::Option { option: "family", message: format!("{family} {n}: n must be at least {smallest}") })
}

/// Refuses a mesh before any memory is taken for it: if [`Mesh::new`](crate::Mesh::new) would refuse its size, if no
/// array can hold it where addresses have 32 bits, or if there is no memory for it.
pub(super) fn fits(vertices: usize, triangles: usize) -> Result<(), Error> {
    const LONGEST_ARRAY: usize = isize::MAX as usize / size_of::<[u32; 3]>();
    for (what, count, limit) in
        [("vertices", vertices, NONE as usize), ("triangles", triangles, MAX_TRIANGLES)]
    {
        let limit = limit.min(LONGEST_ARRAY);
        if count > limit {
            return Err(Error::TooLarge { what, count, limit });
        }
    }
    // Each vertex and triangle has three numbers of 4 bytes. While an array doubles, it takes up to three times as
    // much.
    memory::check(36 * (vertices as u64 + triangles as u64))
}

pub(super) fn generator(seed: u64) -> Rand64 {
    Rand64::new(u128::from(seed))
}

/// A number in [-1, 1).
pub(super) fn signed(random: &mut Rand64) -> f64 {
    2.0 * random.rand_float() - 1.0
}

/// Splits the quad with the corners p, q, r and s, in this order around it, along the diagonal p-r, or else q-s.
pub(super) fn split(triangles: &mut Vec<u32>, [p, q, r, s]: [u32; 4], along_pr: bool) {
    triangles.extend(if along_pr { [p, q, r, p, r, s] } else { [p, q, s, q, r, s] });
}

/// Sign of the doubled signed area of p q r, exact for the f32 coordinates; x and y of points of
/// `stride` numbers.
pub(super) fn turn(positions: &[f32], stride: usize, p: u32, q: u32, r: u32) -> f64 {
    let at = |v: u32| {
        let i = stride * v as usize;
        robust::Coord { x: positions[i], y: positions[i + 1] }
    };
    robust::orient2d(at(p), at(q), at(r))
}

/// Splits the cells of a `columns` x `rows` lattice of vertices (numbered row by row), each along a random
/// diagonal among those that give two triangles which are positive in x and y.
pub(super) fn split_cells(
    positions: &[f32],
    stride: usize,
    columns: usize,
    rows: usize,
    random: &mut Rand64,
) -> Vec<u32> {
    let mut triangles = Vec::with_capacity(6 * (columns - 1) * (rows - 1));
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let p = (row * columns + column) as u32;
            let (q, r, s) = (p + 1, p + columns as u32 + 1, p + columns as u32);
            let positive = |x, y, z| turn(positions, stride, x, y, z) > 0.0;
            let mut along_pr = random.rand_float() < 0.5;
            let kept = if along_pr {
                positive(p, q, r) && positive(p, r, s)
            } else {
                positive(p, q, s) && positive(q, r, s)
            };
            along_pr ^= !kept;
            split(&mut triangles, [p, q, r, s], along_pr);
        }
    }
    triangles
}
