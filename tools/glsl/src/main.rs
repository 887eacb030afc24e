//! Writes the programs of the WebGL2 engine as a JavaScript module: `cargo run -p glsl -- FILE`. GLSL ES 3.00 from the
//! WGSL in `shaders/`, by naga, a program for each entry point of `passes.wgsl` and, where it decides anything, for
//! each form of meshes. Refuses what old drivers get wrong.

mod lint;

use naga::back::glsl::{Options, PipelineOptions, Version, Writer, WriterFlags};
use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, ShaderStage};
use std::collections::BTreeMap;
use std::error::Error;

macro_rules! shaders {
    ($($name:literal)*) => {
        concat!($(include_str!(concat!("../../../shaders/", $name, ".wgsl"))),*)
    };
}

/// The name of a program, and its entry point.
type Program = (&'static str, &'static str);

/// For meshes in the plane, with coordinates as floats; all but `verdict2` are for every mesh.
const PLANE: [Program; 12] = [
    ("cover", "cover"),
    ("verdict2", "verdict_pass"),
    ("label", "label_pass"),
    ("select", "select_pass"),
    ("flip", "flip_pass"),
    ("update", "update_pass"),
    ("anchor", "anchor_pass"),
    ("census", "census_pass"),
    ("more", "more_pass"),
    ("flips", "flips_pass"),
    ("sum", "sum_pass"),
    ("probe", "probe_pass"),
];

/// For surfaces; `flag` is for all of them.
const SPACE: [Program; 3] = [("verdict3", "verdict_pass"), ("crease", "crease_pass"), ("flag", "flag_pass")];

/// For coordinates as fixed-point numbers.
const FIXED_PLANE: [Program; 1] = [("verdict2_fixed", "verdict_pass")];
const FIXED_SPACE: [Program; 2] = [("verdict3_fixed", "verdict_pass"), ("crease_fixed", "crease_pass")];

/// For surfaces where what a flip moves has a limit.
const DEVIATION: [Program; 1] = [("verdict3_deviation", "verdict_pass")];
const FIXED_DEVIATION: [Program; 1] = [("verdict3_fixed_deviation", "verdict_pass")];

/// The program of an entry point, with the files that say what a point is and what the dimension is.
fn glsl(entry_point: &str, points: &str, geometry: &str) -> Result<String, Box<dyn Error>> {
    let source = [
        shaders!("shared/mesh" "webgl2/digits" "webgl2/state" "shared/points"),
        points,
        geometry,
        shaders!("webgl2/verdict" "shared/star" "shared/guard" "shared/label" "shared/select" "shared/slot" "shared/rounds" "webgl2/passes"),
    ]
    .concat();
    let mut module = naga::front::wgsl::parse_str(&source).map_err(|error| error.emit_to_string(&source))?;
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

/// Without the white space that stands for lines and for how deep they are. A directive keeps its line.
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
    let (floats, fixed) = (shaders!("shared/floats"), shaders!("shared/fixed"));
    let plane = shaders!("shared/plane" "webgl2/plane_digits");
    let space = shaders!("shared/space" "shared/any_deviation" "webgl2/space_digits" "shared/creases" "webgl2/crease_pass");
    let deviation = shaders!("shared/space" "shared/deviation" "webgl2/deviation_digits" "webgl2/space_digits" "shared/creases" "webgl2/crease_pass");
    for (points, geometry, list) in [
        (floats, plane, &PLANE[..]),
        (floats, space, &SPACE[..]),
        (fixed, plane, &FIXED_PLANE[..]),
        (fixed, space, &FIXED_SPACE[..]),
        (floats, deviation, &DEVIATION[..]),
        (fixed, deviation, &FIXED_DEVIATION[..]),
    ] {
        for &(name, entry_point) in list {
            programs.insert(name, glsl(entry_point, points, geometry)?);
        }
    }
    let text = serde_json::to_string_pretty(&programs)?;
    std::fs::write(path, format!("// Made from shaders/ by tools/glsl.\nexport default {text};\n"))?;
    Ok(())
}
