//! With `--quiet`, standard error has only the program's own lines, and none of a driver.
#![cfg(all(target_os = "linux", feature = "cli"))]

use crate::command::{Folder, command, grid, text};
use edgeflip::io;

#[test]
fn a_driver_says_nothing() {
    let folder = Folder::new();
    let (input, output) = (folder.path("in.off"), folder.path("out.off"));
    // Large enough for `auto` to look for a GPU.
    io::write(&input, &grid(80)).unwrap();
    for backend in ["auto", "gpu"] {
        for [name, value] in [
            // Here Mesa reports that there is no GPU, and the Vulkan loader logs everything.
            ["XDG_RUNTIME_DIR", "/nonexistent"],
            ["VK_LOADER_DEBUG", "all"],
            ["VK_DRIVER_FILES", "/nonexistent.json"],
            ["VK_DRIVER_FILES", input.to_str().unwrap()],
        ] {
            let arguments = ["--quiet", "--backend", backend, "--max-iterations", "1"];
            let ran = command(&input, &output, &arguments).env(name, value).output().unwrap();
            let said = text(&ran.stderr);
            let context = format!("{backend}, {name}={value}: {}, {said}", ran.status);
            match ran.status.code() {
                Some(0) => assert_eq!(said, "", "{context}"),
                Some(3) if backend == "gpu" => {
                    assert!(
                        said.starts_with("edgeflip: backend gpu ") && said.lines().count() == 1,
                        "{context}"
                    );
                }
                _ => panic!("{context}"),
            }
        }
    }
}
