//! The sources of the kernels: the files of `shaders/`, composed when they are needed.

#[path = "../../../shaders/compose.rs"]
mod compose;
#[cfg(test)]
#[path = "../../../shaders/shorten.rs"]
mod shorten;

use crate::Dimension;
use crate::engine::gpu::upload::Form;

/// The path in `shaders/` of each file, and its text.
const FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The shaders of the phases for meshes of one form: the kernels that only read lists and history, the kernels that
/// write them, and exact arithmetic.
pub(super) fn phases(form: Form) -> [String; 3] {
    [phase("sweeps", form, READS), writes(form), phase("decide", form, READS)]
}

/// The second of these shaders: the tail needs no other.
pub(super) fn writes(form: Form) -> String {
    phase("writes", form, WRITES)
}

/// The shader that untangles a mesh in the plane.
pub(super) fn untangle(form: Form) -> String {
    phase("untangle", form, UNTANGLES)
}

/// The shader that builds the adjacency.
pub(super) fn adjacency() -> String {
    compose::compose("webgpu", "adjacency", &[], &text_of)
}

/// The shader that writes the adjacency for the caller.
pub(super) fn walks() -> String {
    compose::compose("webgpu", "walks", &[], &text_of)
}

/// The shader that finds drivers whose loops end too early.
pub(super) fn probe() -> String {
    compose::compose("webgpu", "probe", &[], &text_of)
}

/// The shader that counts how often the filter decides.
#[cfg(test)]
pub(super) fn tiers(form: Form) -> String {
    phase("tiers", form, WRITES)
}

/// The shader of the baseline.
#[cfg(feature = "baseline")]
pub(super) fn baseline(form: Form) -> String {
    phase("baseline", form, WRITES)
}

const READS: [&str; 2] = ["reads", "sweep"];
const WRITES: [&str; 2] = ["writes", "tail"];
const UNTANGLES: [&str; 2] = ["untangles", "tail"];

fn phase(file: &str, form: Form, [history, guard]: [&str; 2]) -> String {
    compose::compose("webgpu", file, &choices(form, history, guard), &text_of)
}

fn choices<'a>(form: Form, history: &'a str, guard: &'a str) -> [&'a str; 5] {
    let dimension = match form.dimension {
        Dimension::Two => "plane",
        Dimension::Three => "space",
    };
    let coordinates = if form.is_fixed { "fixed" } else { "floats" };
    let deviation = if form.has_deviation { "deviation" } else { "any_deviation" };
    [dimension, coordinates, deviation, history, guard]
}

fn text_of(path: &str) -> Option<&'static str> {
    // Only in test builds.
    #[cfg(test)]
    if path == "webgpu/tiers.wgsl" {
        return Some(include_str!("tiers.wgsl"));
    }
    #[cfg(feature = "baseline")]
    if path == "webgpu/baseline.wgsl" {
        return Some(include_str!("baseline.wgsl"));
    }
    FILES.iter().find(|(name, _)| *name == path).map(|&(_, text)| text)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

    use super::*;

    /// The error of a file, composed with its imports; `None` if it compiles for at least one form.
    fn fault(file: &str) -> Option<String> {
        let kinds =
            Form::ALL.into_iter().flat_map(|form| [READS, WRITES, UNTANGLES].map(|kind| (form, kind)));
        let mut faults = kinds.map(|(form, kind)| {
            let source = phase(file, form, kind);
            wgpu::naga::front::wgsl::parse_str(&source).err().map(|error| error.emit_to_string(&source))
        });
        let first = faults.next().unwrap();
        if faults.any(|fault| fault.is_none()) { None } else { first }
    }

    #[test]
    fn each_file_imports_what_it_needs() {
        for (path, _) in FILES {
            let name = path.split(['/', '.']).nth(1).unwrap();
            if let Some(fault) = fault(name) {
                panic!("{path}: {fault}");
            }
        }
    }

    #[test]
    fn files_begin_with_a_description() {
        for (path, text) in FILES {
            let mut lines = text.lines().skip_while(|line| line.starts_with("// "));
            assert!(text.starts_with("// "), "{path}");
            assert!(
                lines.by_ref().find(|line| !line.starts_with("#import ")).is_none_or(str::is_empty),
                "{path}"
            );
            assert!(lines.all(|line| !line.starts_with("#import ")), "{path}: an import below");
        }
    }

    #[test]
    fn an_import_without_a_file_stays_in_the_text() {
        let text_of = |path: &str| (path == "shared/a.wgsl").then_some("// A.\n#import b\n#import c if d\n");
        assert_eq!(compose::compose("webgpu", "a", &[], &text_of), "// shared/a.wgsl\n// A.\n#import b\n");
        let text = compose::compose("webgpu", "a", &["d"], &text_of);
        assert_eq!(text, "// shared/a.wgsl\n// A.\n#import b\n#import c if d\n");
    }

    /// What browsers download: the same kernels.
    #[test]
    fn shortened_files_have_the_same_kernels() {
        let mut texts: Vec<String> = FILES.iter().map(|&(_, text)| text.to_owned()).collect();
        shorten::shorten(&mut texts);
        let short: Vec<(&str, &'static str)> =
            FILES.iter().zip(texts).map(|(&(path, _), text)| (path, &*text.leak())).collect();
        let entries = |file: &str, choices: &[&str], files: &[(&str, &'static str)]| {
            let text_of = |path: &str| files.iter().find(|(name, _)| *name == path).map(|&(_, text)| text);
            let source = compose::compose("webgpu", file, choices, &text_of);
            let module = wgpu::naga::front::wgsl::parse_str(&source)
                .unwrap_or_else(|error| panic!("{file}: {}", error.emit_to_string(&source)));
            let overrides = module.overrides.iter().map(|(_, named)| named.name.clone().unwrap());
            module.entry_points.iter().map(|entry| entry.name.clone()).chain(overrides).collect::<Vec<_>>()
        };
        for form in Form::ALL {
            for (file, [history, guard]) in
                [("sweeps", READS), ("decide", READS), ("writes", WRITES), ("untangle", UNTANGLES)]
                    .into_iter()
                    .filter(|(file, _)| {
                        *file != "untangle" || (form.dimension == Dimension::Two && !form.is_fixed)
                    })
            {
                let choices = choices(form, history, guard);
                assert_eq!(entries(file, &choices, &short), entries(file, &choices, FILES), "{file}");
            }
        }
        for file in ["adjacency", "probe", "walks"] {
            assert_eq!(entries(file, &[], &short), entries(file, &[], FILES), "{file}");
        }
    }
}
