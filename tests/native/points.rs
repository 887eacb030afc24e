//! Points are triangulated as an oracle of integers of any size defines it, and as another crate does up to ties.

mod oracle;

use crate::points_of::{KINDS, points, shuffled};
use edgeflip::{Error, Positions, Triangulation, triangulate};
use oorandom::Rand64;
use oracle::check;
use std::collections::{BTreeMap, BTreeSet};

fn wide(points: &[[f64; 2]]) -> Positions {
    Positions::from(points.as_flattened().to_vec())
}

fn checked(positions: &Positions) -> (Triangulation, usize) {
    let result = triangulate(positions).unwrap();
    let ties = check(positions, &result);
    (result, ties)
}

#[test]
fn every_kind_is_as_the_oracle_defines_it() {
    let seeds = 10;
    for (name, kind) in KINDS {
        let [mut triangles, mut flat, mut ties] = [0; 3];
        for seed in 1..=seeds {
            let n = libm::pow(300.0, Rand64::new(seed.into()).rand_float()) as usize;
            let wide = wide(&points(kind, n, seed));
            for positions in [Positions::from(wide.to_f32()), wide] {
                let (result, tied) = checked(&positions);
                triangles += result.triangles.len() / 3;
                flat += usize::from(result.is_flat());
                ties += tied;
            }
        }
        println!("{name}: {triangles} triangles, {flat} flat, {ties} ties");
    }
}
#[test]
fn zz_small() {
    for n in 3..12 {
        for seed in 0..20 {
            let p = points(KINDS[0].1, n, seed);
            let w = wide(&p);
            let r = triangulate(&w).unwrap();
            let ok = std::panic::catch_unwind(|| check(&w, &r)).is_ok();
            if !ok {
                println!("{n} {seed} {p:?} {r:?}");
                return;
            }
        }
    }
}
