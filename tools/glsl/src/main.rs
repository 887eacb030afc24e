//! Writes the shaders of the WebGL2 engine as a JavaScript module: `cargo run -p glsl -- FILE`. naga translates the
//! WGSL in `shaders/` to GLSL ES 3.00. There is a program for each entry point of the files with passes; a pass that
//! decides has a program for each form of meshes. Refuses code that old drivers miscompile.

#[path = "../../../shaders/compose.rs"]
mod compose;
mod lint;

use naga::back::glsl::{Options, PipelineOptions, Version, Writer, WriterFlags};
use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, ShaderStage};
use std::collections::BTreeMap;
use std::error::Error;

/// A program: its name, the file of its entry point, and the entry point.
type Program = (&'static str, &'static str, &'static str);

/// Programs for meshes in the plane with coordinates as floats. All except `verdict2` and `areas2` serve every mesh.
const PLANE: [Program; 15] = [
    ("cover", "passes", "cover"),
    ("verdict2", "passes", "verdict_pass"),
    ("label", "passes", "label_pass"),
    ("select", "passes", "select_pass"),
    ("flip", "passes", "flip_pass"),
    ("update", "passes", "update_pass"),
    ("anchor", "passes", "anchor_pass"),
    ("census", "passes", "census_pass"),
    ("more", "passes", "more_pass"),
    ("flips", "passes", "flips_pass"),
    ("sum", "passes", "sum_pass"),
    ("probe", "passes", "probe_pass"),
    ("change", "moving_passes", "change_pass"),
    ("total", "moving_passes", "total_pass"),
    ("areas2", "moving_passes", "areas_pass"),
];

/// Programs for surfaces. `flag` serves all surfaces.
const SPACE: [Program; 4] = [
    ("verdict3", "passes", "verdict_pass"),
    ("crease", "crease_pass", "crease_pass"),
    ("flag", "crease_pass", "flag_pass"),
    ("areas3", "moving_passes", "areas_pass"),
];

/// Programs for coordinates as fixed-point numbers.
const FIXED_PLANE: [Program; 2] =
    [("verdict2_fixed", "passes", "verdict_pass"), ("areas2_fixed", "moving_passes", "areas_pass")];
const FIXED_SPACE: [Program; 3] = [
    ("verdict3_fixed", "passes", "verdict_pass"),
    ("crease_fixed", "crease_pass", "crease_pass"),
    ("areas3_fixed", "moving_passes", "areas_pass"),
];

/// Programs for surfaces with a limit on the deviation.
const DEVIATION: [Program; 1] = [("verdict3_deviation", "passes", "verdict_pass")];
const FIXED_DEVIATION: [Program; 1] = [("verdict3_fixed_deviation", "passes", "verdict_pass")];

/// The programs of each form of meshes, with its choices for `shaders/compose.rs`. Every pass is a sweep.
const FORMS: [([&str; 4], &[Program]); 6] = [
    (["plane", "floats", "any_deviation", "sweep"], &PLANE),
    (["space", "floats", "any_deviation", "sweep"], &SPACE),
    (["plane", "fixed", "any_deviation", "sweep"], &FIXED_PLANE),
    (["space", "fixed", "any_deviation", "sweep"], &FIXED_SPACE),
    (["space", "floats", "deviation", "sweep"], &DEVIATION),
    (["space", "fixed", "deviation", "sweep"], &FIXED_DEVIATION),
];

/// The texts of the shaders by their paths in `shaders/`.
type Texts = BTreeMap<String, String>;

fn texts() -> std::io::Result<Texts> {
    let mut texts = Texts::new();
    for folder in ["shared", "webgl2"] {
        for entry in std::fs::read_dir(format!("{}/../../shaders/{folder}", env!("CARGO_MANIFEST_DIR")))? {
            let entry = entry?;
            let path = format!("{folder}/{}", entry.file_name().display());
            texts.insert(path, std::fs::read_to_string(entry.path())?);
        }
    }
    Ok(texts)
}

fn composed(file: &str, choices: &[&str], texts: &Texts) -> String {
    compose::compose("webgl2", file, choices, &|path| texts.get(path).map(String::as_str))
}

fn parsed(source: &str) -> Result<Module, String> {
    naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))
}

/// Translates an entry point from WGSL to GLSL.
fn glsl(entry_point: &str, source: &str) -> Result<String, Box<dyn Error>> {
    let mut module = parsed(source)?;
    module.entry_points.retain(|entry| entry.name == entry_point);
    compact(&mut module, KeepUnused::No);
    lint::check(&module).map_err(|fault| format!("{entry_point}: {fault}"))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module)?;
    let options =
        Options { version: Version::new_gles(300), writer_flags: WriterFlags::empty(), ..Options::default() };
    let pipeline = PipelineOptions {
        shader_stage: stage(&module)?,
        entry_point: entry_point.to_owned(),
        multiview: None,
    };
    let mut text = String::new();
    Writer::new(&mut text, &module, &info, &options, &pipeline, Default::default())?.write()?;
    Ok(shortened(&text))
}

/// Removes line breaks and indentation. A directive keeps its line.
fn shortened(text: &str) -> String {
    let joined =
        |line: &str| if line.ends_with([';', '{', '}']) { line.to_owned() } else { format!("{line}\n") };
    text.lines().map(str::trim).filter(|line| !line.is_empty()).map(joined).collect()
}

fn stage(module: &Module) -> Result<ShaderStage, String> {
    module.entry_points.first().map(|entry| entry.stage).ok_or_else(|| "no such entry point".to_owned())
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("usage: glsl FILE")?;
    let mut programs = BTreeMap::new();
    let texts = texts()?;
    for (choices, list) in FORMS {
        for &(name, file, entry_point) in list {
            programs.insert(name, glsl(entry_point, &composed(file, &choices, &texts))?);
        }
    }
    let text = serde_json::to_string_pretty(&programs)?;
    std::fs::write(path, format!("// Made from shaders/ by tools/glsl.\nexport default {text};\n"))?;
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "what fails here is a failed test")]
mod tests {
    use super::*;

    #[test]
    fn each_file_imports_what_it_needs() {
        let texts = texts().unwrap();
        for path in texts.keys() {
            let name = path.split(['/', '.']).nth(1).unwrap();
            let faults = FORMS.map(|(choices, _)| parsed(&composed(name, &choices, &texts)).err());
            assert!(faults.iter().any(Option::is_none), "{path}: {}", faults[0].as_deref().unwrap_or(""));
        }
    }

    #[test]
    fn files_begin_with_what_they_do() {
        for (path, text) in texts().unwrap() {
            assert!(text.starts_with("// "), "{path}");
        }
    }
}
