//! Composes a shader from its file and the files that it imports: for the WebGPU engine, for `tools/glsl`, and for the tests.
//!
//! A file names what it needs in lines at its top. `#import NAME` takes `NAME.wgsl` from the folder of the engine, else from
//! `shared/`. `#import NAME if CHOICE` takes it only where the caller makes that choice:
//!
//! | choices | between |
//! |---|---|
//! | `plane`, `space` | meshes in the plane, and surfaces |
//! | `floats`, `fixed` | coordinates as they are, and as fixed-point numbers |
//! | `any_deviation`, `deviation` | no limit for what a flip moves the surface, and one |
//! | `sweep`, `tail` | many edges at a time in the guard, and few |
//! | `reads`, `writes` | WebGPU only: kernels that only read the history, and those that write it |

/// The text of the file `entry`, behind the texts of all files that it imports, each once. `text_of` gives the text of a file
/// by its path, such as `shared/mesh.wgsl`. An import that no file answers stays in the text, where the compiler names it.
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
    /// Appends a file and, before it, what it imports. False where there is no such file.
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

    /// Whether a line is an import, and has been taken or is not wanted.
    fn is_answered(&mut self, line: &str) -> bool {
        let Some(import) = line.strip_prefix("#import ") else { return false };
        let (name, choice) = import.split_once(" if ").unzip();
        choice.is_some_and(|choice| !self.choices.contains(&choice)) || self.take(name.unwrap_or(import))
    }
}
