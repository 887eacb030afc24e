//! Several threads read and write the same as one thread.

use super::*;
use crate::families::by_name;
use std::fmt::Debug;

/// Compares the result on several numbers of threads.
#[track_caller]
fn same<T: Debug + PartialEq + Send>(work: impl Fn() -> T + Sync) -> T {
    let on = |count| rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap().install(&work);
    let one = on(1);
    for count in 2..5 {
        assert_eq!(on(count), one, "{count} threads");
    }
    one
}

/// A strip with polygons, colours, comments, empty lines, and line ends of each kind.
fn strip() -> Vec<String> {
    let mut lines = vec!["OFF".to_owned(), "80 41 0".to_owned()];
    for v in 0..80 {
        lines.push(format!("{} {} 0{}", v / 2, v % 2, if v % 9 == 0 { " # a vertex" } else { "" }));
        lines.extend((v % 7 == 0).then(String::new));
    }
    for q in (0..78).step_by(2) {
        let colour = if q % 5 == 0 { " 255 0 0" } else { "" };
        lines.push(match q % 3 {
            0 => format!("4 {q} {} {} {}{colour}", q + 2, q + 3, q + 1),
            _ => format!("3 {q} {} {}{colour}", q + 2, q + 3),
        });
        lines.extend((q % 8 == 0).then(|| " # a face".to_owned()));
    }
    lines.extend(["3 0 1 2".to_owned(), "3 0 1 3 7".to_owned()]);
    lines
}

fn ended(lines: &[String], ends: &[&str]) -> Vec<u8> {
    let lines = lines.iter().zip(ends.iter().cycle());
    lines.flat_map(|(line, end)| [line.as_bytes(), end.as_bytes()]).flatten().copied().collect()
}

#[test]
fn off_is_the_same_in_pieces() {
    for ends in [["\n"].as_slice(), &["\r\n"], &["\r"], &["\n", "\r\n", "\r"]] {
        let text = ended(&strip(), ends);
        let loaded = same(|| off(&text).map_err(|error| error.to_string())).unwrap();
        assert_eq!((loaded.mesh.vertex_count(), loaded.polygons), (80, 13));
        let groups = same(|| {
            let mut options = Options::default();
            (loaded.constrain(&mut options).unwrap().count, options.groups)
        });
        assert!(groups.1.contains(&1));
        let turned: Vec<u32> = loaded.mesh.triangles().iter().rev().copied().collect();
        let written = same(|| loaded.file_bytes("out.off", turned.clone()).unwrap());
        assert_eq!(off(written).unwrap().mesh.triangles(), turned);
    }
}

#[test]
fn what_is_wrong_is_the_same_in_pieces() {
    let lines = strip();
    for line in (1..lines.len()).step_by(5) {
        for wrong in ["1 x 2", "3 0 1 80", "2 0 1", ""] {
            let mut lines = lines.clone();
            lines[line] = wrong.to_owned();
            let text = ended(&lines, &["\n"]);
            let _ = same(|| off(&text).map_err(|error| error.to_string()));
        }
        let text = ended(&lines[..line], &["\n"]);
        let _ = same(|| off(&text).map_err(|error| error.to_string()));
    }
}

#[test]
fn new_files_are_the_same_in_pieces() {
    let mesh = by_name("random 20").unwrap();
    for format in ALL {
        same(|| to_bytes(format, &mesh).unwrap());
    }
}
