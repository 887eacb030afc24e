//! Makes the mesh in a file Delaunay and keeps its attributes: `cargo run --release --example file -- IN OUT`.

use edgeflip::io::{self, Format, ReadOptions};
use edgeflip::{Error, Options, Outcome, make_delaunay};
use std::ops::ControlFlow;
use std::path::Path;

/// Reads the two names and prints what happened.
fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, output] = arguments.as_slice() else {
        eprintln!("usage: file IN OUT");
        std::process::exit(2);
    };
    let outcome = flip_file(input.as_ref(), output.as_ref())?;
    println!("{} flips, {} edges are still not Delaunay", outcome.flips, outcome.remaining.total());
    Ok(())
}

/// The extension of each name gives the format of the file.
pub fn flip_file(input: &Path, output: &Path) -> Result<Outcome, Error> {
    let loaded = io::load(input, &ReadOptions::default())?;
    let mut options = Options::default();
    if loaded.keeps(Format::of(output)?) {
        // Locks the edges whose flips would mix attributes of faces or corners.
        loaded.constrain(&mut options)?;
    }
    let outcome = make_delaunay(&loaded.mesh, &options, |_, _| ControlFlow::Continue(()))?;
    for note in io::rewrite(output, &loaded, outcome.triangles.clone())? {
        eprintln!("{note}");
    }
    Ok(outcome)
}
