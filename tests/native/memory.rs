//! The command line with too little memory: status 0 or 1, at most one line, and no files left behind, in each format.
//! `EDGEFLIP_MEMORY=20000000` tests 20 million triangles with limits up to 6 GB, which takes half an hour.
#![cfg(all(target_os = "linux", feature = "cli"))]

use crate::command::{Folder, SQUARE, command, failed, grid, shell, silent, text};
use edgeflip::io;
use rustix::process::{Pid, Resource, Rlimit, prlimit};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};

const STEPS: u32 = 16;

/// Runs the program with `arguments` and at most `kib` KiB of addresses.
fn limited(kib: u64, arguments: &str, [input, output]: [&Path; 2]) -> Output {
    let script = format!(r#"ulimit -c 0; ulimit -v {kib}; exec "$0" "$1" -o "$2" {arguments}"#);
    shell(&script, &[input, output]).output().unwrap()
}

/// The limits in KiB. The smallest holds little more than the program itself.
fn limits(is_full: bool) -> Vec<u64> {
    let part = |step: u32| f64::from(step) / f64::from(STEPS - 1);
    let bytes =
        |step: u32| if is_full { 0.25e9 + 5.75e9 * part(step) } else { 24e6 * 20f64.powf(part(step)) };
    (0..STEPS).map(|step| bytes(step) as u64 / 1024).collect()
}

#[test]
fn a_mesh_that_does_not_fit_in_memory_gives_one_line() {
    let triangles = std::env::var("EDGEFLIP_MEMORY").ok().map(|count| count.parse::<f64>().unwrap());
    let mesh = grid((triangles.unwrap_or(160_000.0) / 2.0).sqrt() as usize + 1);
    let limits = limits(triangles.is_some());
    let heads: Vec<String> = limits.iter().map(|kib| format!("{}", kib * 1024 / 1_000_000)).collect();
    println!("| {} triangles, MB | {} |", mesh.triangle_count(), heads.join(" | "));
    println!("|---|{}", "---:|".repeat(limits.len()));
    for name in ["in.off", "in.obj", "in.ply", "in.stl", "in.gltf", "in.glb", "in.ply.gz"] {
        let folder = Folder::new();
        let (input, output) = (folder.path(name), folder.path(&name.replace("in", "out")));
        io::write(&input, &mesh).unwrap();
        silent(&shell(r#"exec "$0" "$1" -o "$2" -q --threads 2"#, &[&input, &output]).output().unwrap());
        let whole = folder.path("whole");
        fs::rename(&output, &whole).unwrap();
        let mut cells = Vec::new();
        for &kib in &limits {
            let ran = limited(kib, "-q --threads 2", [&input, &output]);
            let said = text(&ran.stderr);
            let context = format!("{name} in {kib} KiB: {}, {said}", ran.status);
            match ran.status.code() {
                Some(0) => {
                    assert_eq!(said, "", "{context}");
                    assert!(fs::read(&output).unwrap() == fs::read(&whole).unwrap(), "{context}");
                    fs::remove_file(&output).unwrap();
                }
                Some(1) => {
                    assert!(said.starts_with("edgeflip: ") && said.lines().count() == 1, "{context}");
                }
                _ => panic!("{context}"),
            }
            assert_eq!(folder.names(), [name, "whole"], "{context}");
            cells.push(ran.status.code().unwrap_or(-1).to_string());
        }
        println!("| {name} | {} |", cells.join(" | "));
        if triangles.is_none() {
            assert_eq!((&*cells[0], &*cells[cells.len() - 1]), ("1", "0"), "{name}: {cells:?}");
        }
    }
}

#[test]
fn the_line_names_the_file_and_what_it_wanted() {
    let folder = Folder::new();
    let (input, output) = (folder.path("in.ply"), folder.file("out.off", "old"));
    io::write(&input, &grid(400)).unwrap();
    let ran = limited(24_000, "--backend cpu", [&input, &output]);
    let said = text(&ran.stderr);
    let start = format!("edgeflip: {}: memory ran out: ", input.display());
    assert!(said.starts_with(&start) && said.ends_with(" more bytes are not available\n"), "{said}");
    assert_eq!((ran.status.code(), said.lines().count()), (Some(1), 1));
    assert_eq!(fs::read_to_string(output).unwrap(), "old");
    assert_eq!(folder.names(), ["in.ply", "out.off"]);
}

/// The limit is set when a temporary file exists, before all output is in memory.
#[test]
fn no_temporary_file_stays() {
    let folder = Folder::new();
    let (input, output) = (folder.path("in.ply"), folder.file("out.glb", "old"));
    io::write(&input, &grid(400)).unwrap();
    // The limit may take effect too late, so there are many tries.
    let has_run_out = (0..200).any(|_| {
        let mut command = command(&input, &output, &["--backend", "cpu", "--quiet", "--max-iterations", "0"]);
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        while !folder.names().iter().any(|name| name.starts_with(".edgeflip-")) {
            if child.try_wait().unwrap().is_some() {
                return false;
            }
        }
        // The program may have ended already.
        let none = Rlimit { current: Some(1), maximum: Some(1) };
        let _ = prlimit(Some(Pid::from_child(&child)), Resource::As, none);
        let Output { status, stderr, .. } = child.wait_with_output().unwrap();
        assert!(matches!(status.code(), Some(0 | 1)), "{status}: {}", text(&stderr));
        assert_eq!(folder.names(), ["in.ply", "out.glb"]);
        status.code() == Some(1)
    });
    assert!(has_run_out);
}

/// The stacks of 256 threads would not fit.
#[test]
fn threads_without_work_are_not_started() {
    let folder = Folder::new();
    let (input, output) = (folder.file("in.off", SQUARE), folder.path("out.off"));
    silent(&limited(60_000, "--backend cpu --threads 256 -q", [&input, &output]));
}

/// If no threads can be started, one thread does the work, unless an option requests more. Stacks of 1 TB do not fit.
#[test]
fn without_further_threads_one_thread_does_the_work() {
    let folder = Folder::new();
    let (input, output) = (folder.path("in.off"), folder.path("out.off"));
    // Enough for two threads, also in release builds.
    io::write(&input, &grid(200)).unwrap();
    let ran = |arguments: &str| {
        let script =
            r#"ulimit -v 500000; RUST_MIN_STACK=1000000000000 exec "$0" "$1" -o "$2" --backend cpu "#;
        shell(&(script.to_owned() + arguments), &[&input, &output]).output().unwrap()
    };
    silent(&ran("--quiet"));
    let line = "option --threads: cannot start 2 threads: Resource temporarily unavailable (os error 11)";
    failed(&ran("--threads 2"), 1, line);
}

/// Drivers end the process if they get no memory.
#[test]
fn no_gpu_is_used_in_little_memory() {
    let folder = Folder::new();
    let (input, output) = (folder.path("in.off"), folder.path("out.off"));
    io::write(&input, &grid(101)).unwrap();
    let why = "a GPU driver may need 1076301824 bytes, and the limit of memory (ulimit -v) leaves ";
    let ran = limited(500_000, "--backend gpu", [&input, &output]);
    let said = text(&ran.stderr);
    assert!(said.starts_with(&format!("edgeflip: backend gpu is not available: {why}")), "{said}");
    assert_eq!((ran.status.code(), said.lines().count()), (Some(3), 1));
    let ran = limited(500_000, "--json --max-iterations 0", [&input, &output]);
    let found: Value = serde_json::from_slice(&ran.stdout).unwrap();
    assert_eq!((ran.status.code(), &found["backend"]), (Some(0), &"cpu".into()));
    assert!(found["fallback"].as_str().unwrap().starts_with(why), "{found}");
}
