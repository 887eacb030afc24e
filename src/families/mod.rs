//! Generated meshes: the families that the tests, the benchmarks and the page run on. The paper that their descriptions
//! name is the one that the README cites.
//!
//! The same parameters and seed give the same bits on every platform: the numbers come from a PCG
//! generator, the trigonometry from the crate `libm`, everything is computed in f64 and rounded to f32
//! once. Choices that must be right for the rounded coordinates are made with exact orientation tests.

mod lattice;
mod plane;
mod shuffled;
mod space;

pub use plane::{fan2, grid, random, regular, shear, strips, sweep};
pub use shuffled::shuffled;
pub use space::{pillow, pole, roof, uvsphere};

use crate::{Error, Mesh};

/// The names that [`by_name`] knows.
pub const NAMES: [&str; 11] =
    ["grid", "random", "shear", "regular", "strips", "fan2", "sweep", "uvsphere", "roof", "pillow", "pole"];

/// What [`by_name`] accepts, for messages and `--help`.
pub const USAGE: &str = "grid N, random N [K=2], shear N [S=3], regular N [OFFSET=0], strips N, fan2 N, \
    sweep N, uvsphere N [AMPLITUDE=0.05], roof N, pillow N [H=0.1] or pole N, each with an optional \
    seed=SEED at the end; with `shuffled` before it, vertices and triangles are in random order";

/// The seed that [`by_name`] takes when the specification names none.
pub const DEFAULT_SEED: u64 = 1;

/// The mesh that a specification such as `uvsphere 600`, `shear 300 30` or `random 100 seed=7` describes;
/// [`USAGE`] lists them all.
///
/// # Errors
/// [`Error::Option`] when the specification is not understood, [`Error::TooLarge`] when 32 bits cannot
/// index the mesh.
pub fn by_name(spec: &str) -> Result<Mesh, Error> {
    if let Some(spec) = spec.strip_prefix("shuffled ") {
        let seed = parse(spec).ok_or_else(|| wrong(spec))?.3;
        return Ok(shuffled(&by_name(spec)?, seed));
    }
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

/// The name, n, the parameter and the seed of a specification.
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
