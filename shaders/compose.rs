//! Composes a shader from its file and the files that it imports. The WebGPU engine, `tools/glsl` and the tests use it.
//!
//! The first lines of a file list its imports. `#import NAME` takes `NAME.wgsl` from the folder of the engine, or else
//! from `shared/`. `#import NAME if CHOICE` takes it only if the caller makes that choice:
//!
//! | choices | meaning |
//! |---|---|
//! | `plane`, `space` | meshes in the plane, or in space |
//! | `floats`, `fixed` | coordinates as 32-bit floats, or as fixed-point numbers |
//! | `any_deviation`, `deviation` | without or with a limit for the deviation |
//! | `sweep`, `tail` | the guard and Select test many edges at a time, or few |
//! | `reads`, `writes` | WebGPU only: the kernel only reads the history, or writes it |

/// The text of the file `entry` after the texts of all files that it imports, each once. `text_of` returns the text of
/// a file by its path, such as `shared/mesh.wgsl`. An import without a file stays in the text, so that the compiler
/// reports it.
pub fn compose<'a>(
    engine: &str,
    entry: &str,
    choices: &[&str],
    text_of: &dyn Fn(&str) -> Option<&'a str>,
) -> String {
    let mut composer = Composer { engine, choices, text_of, taken: Vec::new(), text: String::new() };
    composer.take(entry);
    composer.text
}

struct Composer<'a, 'b> {
    engine: &'b str,
    choices: &'b [&'b str],
    text_of: &'b dyn Fn(&str) -> Option<&'a str>,
    taken: Vec<String>,
    text: String,
}

impl Composer<'_, '_> {
    /// Appends the imports of a file, then the file. Returns false if the file does not exist.
    fn take(&mut self, name: &str) -> bool {
        let paths = [self.engine, "shared"].map(|folder| format!("{folder}/{name}.wgsl"));
        let Some((path, text)) = paths.iter().find_map(|path| Some((path, (self.text_of)(path)?))) else {
            return false;
        };
        if !self.taken.contains(path) {
            self.taken.push(path.clone());
            let mut own = format!("// {path}\n");
            for line in text.lines().filter(|line| !self.is_answered(line)) {
                own.extend([line, "\n"]);
            }
            self.text += &own;
        }
        true
    }

    /// Takes the import in a line, unless the caller did not make its choice. Returns false for a line that stays in
    /// the text: one without an import, or with an import that has no file.
    fn is_answered(&mut self, line: &str) -> bool {
        let Some(import) = line.strip_prefix("#import ") else { return false };
        let (name, choice) = import.split_once(" if ").unzip();
        choice.is_some_and(|choice| !self.choices.contains(&choice)) || self.take(name.unwrap_or(import))
    }
}
