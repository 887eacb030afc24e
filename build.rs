//! Writes `shaders.rs` for `src/engine/webgpu/sources.rs`: the path and the text of each shader of the WebGPU engine.
//! Browsers download the shaders, so the wasm32 build shortens them.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

#[path = "shaders/shorten.rs"]
mod shorten;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=shaders");
    let is_for_browsers = env::var("CARGO_CFG_TARGET_ARCH")? == "wasm32";
    let (mut names, mut texts) = (Vec::new(), Vec::new());
    for folder in ["shared", "webgpu"] {
        for entry in fs::read_dir(Path::new("shaders").join(folder))? {
            let entry = entry?;
            texts.push(fs::read_to_string(entry.path())?);
            names.push(format!("{folder}/{}", entry.file_name().display()));
        }
    }
    if is_for_browsers {
        shorten::shorten(&mut texts);
    }
    let mut files: Vec<_> = names.into_iter().zip(texts).collect();
    files.sort();
    fs::write(Path::new(&env::var("OUT_DIR")?).join("shaders.rs"), format!("&{files:?}"))?;
    Ok(())
}
