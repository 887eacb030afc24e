//! Runs each fuzz target on its seeds.

#[path = "../../fuzz/src/lib.rs"]
mod fuzz;

use std::fs;
use std::path::Path;

#[test]
fn every_seed_is_read_or_refused_and_written_again() {
    for folder in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/seeds")).unwrap() {
        let folder = folder.unwrap();
        for seed in fs::read_dir(folder.path()).unwrap() {
            let seed = seed.unwrap().path();
            println!("{}", seed.display());
            fuzz::check(folder.file_name().to_str().unwrap(), &fs::read(seed).unwrap());
        }
    }
}
