//! Generated meshes: the families that the tests, the benchmarks and the demo run on.
//!
//! The same parameters and seed give the same bits on every platform: the numbers come from a PCG
//! generator, the trigonometry from the crate `libm`, everything is computed in f64 and rounded to f32
//! once. Choices that must be right for the rounded coordinates are made with exact orientation tests.

mod plane;
mod space;

pub use plane::{fan2, grid, random, regular, shear, strips, sweep};
pub use space::{pillow, pole, roof, uvsphere};

use crate::mesh::MAX_TRIANGLES;
use crate::system::memory;
use crate::{Error, Mesh, NONE};
use oorandom::Rand64;

/// The names that [`by_name`] knows.
pub const NAMES: [&str; 11] =
    ["grid", "random", "shear", "regular", "strips", "fan2", "sweep", "uvsphere", "roof", "pillow", "pole"];

/// What [`by_name`] accepts, for messages and `--help`.
pub const USAGE: &str = "grid N, random N [K=2], shear N [S=3], regular N [OFFSET=0], strips N, fan2 N, \
    sweep N, uvsphere N [AMPLITUDE=0.05], roof N, pillow N [H=0.1] or pole N, each with an optional \
    seed=SEED at the end";

/// The seed that [`by_name`] takes when the specification names none.
pub const DEFAULT_SEED: u64 = 1;

/// The mesh that a specification such as `uvsphere 600`, `shear 300 30` or `random 100 seed=7` describes;
/// [`USAGE`] lists them all.
///
/// # Errors
/// [`Error::Option`] when the specification is not understood, [`Error::TooLarge`] when 32 bits cannot
/// index the mesh.
pub fn by_name(spec: &str) -> Result<Mesh, Error> {
    let (name, n, parameter, seed) = parse(spec).ok_or_else(|| wrong(spec))?;
    let number = |default: f64| parameter.unwrap_or(default);
    match name {
        "grid" | "strips" | "fan2" | "sweep" | "roof" | "pole" if parameter.is_some() => Err(wrong(spec)),
        "grid" => grid(n, seed),
        "random" => random(n, number(2.0), seed),
        "shear" => shear(n, number(3.0), seed),
        "regular" => regular(n, number(0.0), seed),
        "strips" => strips(n),
        "fan2" => fan2(n),
        "sweep" => sweep(n, seed),
        "uvsphere" => uvsphere(n, number(0.05), seed),
        "roof" => roof(n, seed),
        "pillow" => pillow(n, number(0.1)),
        "pole" => pole(n, seed),
        _ => Err(wrong(spec)),
    }
}

/// Name, n, the further number and the seed of a specification.
fn parse(spec: &str) -> Option<(&str, usize, Option<f64>, u64)> {
    let mut words: Vec<&str> = spec.split_whitespace().collect();
    let mut seed = DEFAULT_SEED;
    if let Some(value) = words.last().and_then(|word| word.strip_prefix("seed=")) {
        seed = value.parse().ok()?;
        words.pop();
    }
    let (name, n, parameter) = match words[..] {
        [name, n] => (name, n, None),
        [name, n, parameter] => (name, n, Some(parameter.parse().ok().filter(|x: &f64| x.is_finite())?)),
        _ => return None,
    };
    Some((name, n.parse().ok()?, parameter, seed))
}

fn wrong(spec: &str) -> Error {
    Error::Option { option: "family", message: format!("{spec:?} is not one of: {USAGE}") }
}

/// Refuses an n below the family's smallest.
fn at_least(smallest: usize, n: usize, family: &str) -> Result<(), Error> {
    if n >= smallest {
        return Ok(());
    }
    Err(Error::Option { option: "family", message: format!("{family} {n}: n must be at least {smallest}") })
}

/// Refuses what [`Mesh::new`] would refuse for its size, before any memory is taken for it, what no array can hold
/// where addresses have 32 bits, and what there is no memory for.
fn fits(vertices: usize, triangles: usize) -> Result<(), Error> {
    const LONGEST_ARRAY: usize = isize::MAX as usize / size_of::<[u32; 3]>();
    for (what, count, limit) in
        [("vertices", vertices, NONE as usize), ("triangles", triangles, MAX_TRIANGLES)]
    {
        let limit = limit.min(LONGEST_ARRAY);
        if count > limit {
            return Err(Error::TooLarge { what, count, limit });
        }
    }
    // Three numbers each, in arrays that double where their length is not known.
    memory::check(36 * (vertices as u64 + triangles as u64))
}

fn generator(seed: u64) -> Rand64 {
    Rand64::new(u128::from(seed))
}

/// A number in [-1, 1).
fn signed(random: &mut Rand64) -> f64 {
    2.0 * random.rand_float() - 1.0
}

/// Splits the quad p q r s (in this turn) along the diagonal p-r, or else q-s.
fn split(triangles: &mut Vec<u32>, [p, q, r, s]: [u32; 4], along_pr: bool) {
    triangles.extend(if along_pr { [p, q, r, p, r, s] } else { [p, q, s, q, r, s] });
}

/// Sign of the doubled signed area of p q r, exact for the f32 coordinates; x and y of points of
/// `stride` numbers.
fn turn(positions: &[f32], stride: usize, p: u32, q: u32, r: u32) -> f64 {
    let at = |v: u32| {
        let i = stride * v as usize;
        robust::Coord { x: positions[i], y: positions[i + 1] }
    };
    robust::orient2d(at(p), at(q), at(r))
}

/// Splits the cells of a `columns` x `rows` lattice of vertices (numbered row by row), each along a random
/// diagonal among those that give two triangles which are positive in x and y.
fn split_cells(
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
