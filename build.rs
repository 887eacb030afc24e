//! Writes `shaders.rs` for `src/engine/webgpu/sources.rs`: the path and the text of each shader of the WebGPU engine.
//! Browsers download the shaders, so the wasm32 build removes comments and indentation.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=shaders");
    let is_for_browsers = env::var("CARGO_CFG_TARGET_ARCH")? == "wasm32";
    let mut files = Vec::new();
    for folder in ["shared", "webgpu"] {
        for entry in fs::read_dir(Path::new("shaders").join(folder))? {
            let entry = entry?;
            let text = fs::read_to_string(entry.path())?;
            let text = if is_for_browsers { bare(&text) } else { text };
            files.push((format!("{folder}/{}", entry.file_name().display()), text));
        }
    }
    files.sort();
    fs::write(Path::new(&env::var("OUT_DIR")?).join("shaders.rs"), format!("&{files:?}"))?;
    Ok(())
}

fn bare(text: &str) -> String {
    let lines = text.lines().map(|line| line.split("//").next().unwrap_or("").trim());
    lines.filter(|line| !line.is_empty()).flat_map(|line| [line, "\n"]).collect()
}
