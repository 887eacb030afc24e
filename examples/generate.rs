//! Writes a generated mesh to a file: `cargo run --release --example generate -- "uvsphere 600" sphere.off`.

use edgeflip::{Error, families, io};

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [family, path] = arguments.as_slice() else {
        eprintln!("usage: generate FAMILY FILE\n{}", families::usage());
        std::process::exit(2);
    };
    for lost in io::write(path, &families::by_name(family)?)? {
        eprintln!("{lost}");
    }
    Ok(())
}
