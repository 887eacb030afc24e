//! The Rust programs in `examples/` and the command lines in README do what they say.
#![cfg(feature = "cli")]

#[path = "../../examples/file.rs"]
#[allow(dead_code, reason = "its main reads the arguments of a command")]
mod file;
#[cfg(feature = "gpu")]
#[path = "../../examples/moving.rs"]
#[allow(dead_code, reason = "its main reads the arguments of a command")]
mod moving;
#[cfg(feature = "gpu")]
#[path = "../../examples/neighbours.rs"]
#[allow(dead_code, reason = "its main reads the arguments of a command")]
mod neighbours;
#[path = "../../examples/one_call.rs"]
mod one_call;
#[path = "../../examples/step_by_step.rs"]
mod step_by_step;
#[path = "../../examples/untangle.rs"]
#[allow(dead_code, reason = "its main prints what its other function returns")]
mod untangle;

use edgeflip::Error;
use std::fs;

/// A thin diamond, split along its long diagonal, with a material.
const THIN: &str = "v -3 0 0\nv 0 -1 0\nv 3 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\nf 1 3 4\n";

#[test]
fn one_call() -> Result<(), Error> {
    one_call::main()
}

#[test]
fn step_by_step() -> Result<(), Error> {
    step_by_step::main()
}

#[test]
fn untangle() -> Result<(), Error> {
    let lines = pollster::block_on(untangle::run())?;
    assert_eq!(lines.len(), 4);
    assert_eq!(lines[0], "at 3, 2: 0 turned over, 0 flat; outside: [], at one point: []");
    assert!(lines[1].ends_with("outside: [4], at one point: []") && !lines[1].contains(" 0 turned"));
    assert!(lines[2].ends_with("outside: [4], at one point: [[2, 4]]") && !lines[2].contains(" 0 flat"));
    assert_eq!(lines[3], "at 2, 3: 0 turned over, 0 flat; outside: [], at one point: []");
    Ok(())
}

#[test]
#[cfg(feature = "gpu")]
fn moving() {
    let line = moving::run(20, 10, 0).unwrap();
    assert!(line.contains("722 triangles") && line.contains(", 0 edges left"), "{line}");
    let line = moving::run(20, 10, 20).unwrap();
    assert!(line.ends_with(", 0 triangles turned over") && !line.contains(" 0 flips"), "{line}");
}

#[test]
#[cfg(feature = "gpu")]
fn neighbours() {
    let line = neighbours::run(30, 40).unwrap();
    assert!(line.starts_with("900 points, ") && line.contains(", 0 counts wrong; "), "{line}");
    assert!(line.ends_with(", 0 edges left to flip") && !line.contains(" 0 flips"), "{line}");
}

#[test]
fn a_file_keeps_its_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let [input, output] = ["thin.obj", "delaunay.obj"].map(|name| folder.path().join(name));
    fs::write(&input, THIN).unwrap();
    assert_eq!(file::flip_file(&input, &output).unwrap().flips, 1);
    assert!(fs::read_to_string(&output).unwrap().contains("usemtl red"));
}

#[test]
#[cfg(unix)]
fn the_command_lines_in_readme() {
    let readme = include_str!("../../README.md");
    let (_, block) = readme.split_once("```sh\ncargo install --path .").unwrap();
    let lines: Vec<&str> = block.lines().skip(1).take_while(|line| *line != "```").collect();
    let [printf, flip] = lines.as_slice() else { unreachable!("{lines:?}") };
    let script = format!("{printf}\n{}", flip.replacen("edgeflip", "\"$0\"", 1));

    let folder = tempfile::tempdir().unwrap();
    let mut bash = std::process::Command::new("bash");
    bash.args(["-euc", &script, env!("CARGO_BIN_EXE_edgeflip")]).current_dir(folder.path());
    assert!(bash.output().unwrap().status.success());
    let written = fs::read_to_string(folder.path().join("delaunay.off")).unwrap();
    assert!(written.ends_with("3 3 1 2\n3 0 1 3\n"), "{written}");
}
