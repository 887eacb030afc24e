//! Makes the text of the shaders smaller: it is a part of what a browser downloads.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=shaders");
    let to = env::var("OUT_DIR")?;
    for entry in fs::read_dir("shaders")? {
        let path = entry?.path();
        let text = fs::read_to_string(&path)?;
        let lines = text.lines().map(|line| line.split("//").next().unwrap_or("").trim());
        let text: String = lines.filter(|line| !line.is_empty()).flat_map(|line| [line, "\n"]).collect();
        if let Some(name) = path.file_name() {
            fs::write(Path::new(&to).join(name), text)?;
        }
    }
    Ok(())
}
