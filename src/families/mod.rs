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

/// A family, as specifications name it.
pub struct Family {
    /// Its name.
    pub name: &'static str,
    /// The name and the default of its parameter, if it has one.
    pub parameter: Option<(&'static str, f64)>,
    /// Takes n, the parameter and the seed.
    make: fn(usize, f64, u64) -> Result<Mesh, Error>,
}

/// All families.
pub static FAMILIES: [Family; 11] = [
    Family { name: "grid", parameter: None, make: |n, _, seed| grid(n, seed) },
    Family { name: "random", parameter: Some(("K", 2.0)), make: random },
    Family { name: "shear", parameter: Some(("S", 3.0)), make: shear },
    Family { name: "regular", parameter: Some(("OFFSET", 0.0)), make: regular },
    Family { name: "strips", parameter: None, make: |n, _, _| strips(n) },
    Family { name: "fan2", parameter: None, make: |n, _, _| fan2(n) },
    Family { name: "sweep", parameter: None, make: |n, _, seed| sweep(n, seed) },
    Family { name: "uvsphere", parameter: Some(("AMPLITUDE", 0.05)), make: uvsphere },
    Family { name: "roof", parameter: None, make: |n, _, seed| roof(n, seed) },
    Family { name: "pillow", parameter: Some(("H", 0.1)), make: |n, h, _| pillow(n, h) },
    Family { name: "pole", parameter: None, make: |n, _, seed| pole(n, seed) },
];

/// What [`by_name`] accepts, for messages and `--help`.
pub fn usage() -> String {
    let of_family = |Family { name, parameter, .. }: &Family| match parameter {
        Some((letter, default)) => format!("{name} N [{letter}={default}]"),
        None => format!("{name} N"),
    };
    FAMILIES.each_ref().map(of_family).join(", ")
        + "; each with an optional seed=SEED at the end; with `shuffled` before it, vertices and triangles are in \
           random order"
}

/// The seed that [`by_name`] takes when the specification names none.
pub const DEFAULT_SEED: u64 = 1;

/// The mesh that a specification such as `uvsphere 600`, `shear 300 30` or `random 100 seed=7` describes;
/// [`usage`] lists them all.
///
/// # Errors
/// [`Error::Option`] when the specification is not understood, [`Error::TooLarge`] when 32 bits cannot
/// index the mesh.
pub fn by_name(spec: &str) -> Result<Mesh, Error> {
    if let Some(spec) = spec.strip_prefix("shuffled ") {
        let seed = parse(spec).ok_or_else(|| wrong(spec))?.3;
        return Ok(shuffled(&by_name(spec)?, seed));
    }
    let (name, n, given, seed) = parse(spec).ok_or_else(|| wrong(spec))?;
    let Some(family) = FAMILIES.iter().find(|family| family.name == name) else { return Err(wrong(spec)) };
    let parameter = match (family.parameter, given) {
        (Some((_, default)), given) => given.unwrap_or(default),
        (None, None) => 0.0,
        (None, Some(_)) => return Err(wrong(spec)),
    };
    (family.make)(n, parameter, seed)
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
    Error::Option { option: "family", message: format!("{spec:?} is not one of: {}", usage()) }
}
