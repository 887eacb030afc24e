//! Compares the WebGPU engine with the CPU engine, array by array after every phase, on any adapter.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod ahead;
mod areas;
mod exact;
mod moving;
mod untangle;

use super::webgpu::{Device, Kernel, WebGpu};
use super::{Census, Cpu, EdgeCounts, Engine, Upload};
use crate::mesh::Mesh;
use crate::phases::{Thresholds, label, select};
use crate::predicates::tiers::kinds::kinds;
use crate::system::threads::Threads;
use crate::{EngineKind, Reason, cos_degrees, families};
use pollster::block_on;
use std::sync::Arc;

fn engines(mesh: &Arc<Mesh>, thresholds: Thresholds) -> (Cpu, WebGpu) {
    let upload = Upload::new(EngineKind::Gpu, mesh.clone(), thresholds).unwrap();
    let gpu = block_on(async { WebGpu::new(Device::shared(true, None).await?, upload).await }).unwrap();
    (Cpu::new(mesh.clone(), thresholds, Threads::default()), gpu)
}

fn any_deviation(degrees: f64) -> Thresholds {
    Thresholds { cos: cos_degrees(degrees), deviation: f32::INFINITY }
}

#[track_caller]
fn assert_same(what: &str, cpu: &[u32], gpu: &[u32]) {
    if let Some(i) = (0..cpu.len().max(gpu.len())).find(|&i| cpu.get(i) != gpu.get(i)) {
        panic!("{what}[{i}]: cpu {:?}, gpu {:?}", cpu.get(i), gpu.get(i));
    }
}

/// Runs both engines phase by phase to the end.
fn compare(name: &str, degrees: f64) {
    compare_mesh(name, families::by_name(name).unwrap(), any_deviation(degrees));
}

fn compare_mesh(name: &str, mesh: Mesh, thresholds: Thresholds) -> Census {
    let mesh = Arc::new(mesh);
    let (mut cpu, mut gpu) = engines(&mesh, thresholds);
    assert_same("twins", &cpu.twins, &block_on(gpu.twins()).unwrap());
    assert_eq!(cpu.edge_counts(), gpu.edge_counts(), "{name}");
    for iteration in 0.. {
        let what = |array: &str| format!("{name}, {thresholds:?}, iteration {iteration}: {array}");
        let census = cpu.count();
        assert_eq!(census, block_on(gpu.census()).unwrap(), "{}", what("census"));
        let areas = [block_on(cpu.areas()), block_on(gpu.areas())].map(Result::unwrap);
        assert_eq!(areas[0], areas[1], "{}", what("areas"));
        let best = label(&cpu.geometry(), cpu.topology(), iteration);
        block_on(gpu.run_phase(Kernel::Label)).unwrap();
        block_on(gpu.run_phase(Kernel::Decide)).unwrap();
        assert_same(&what("best"), &best, &block_on(gpu.choices()).unwrap().0);
        let selected = select(cpu.topology(), iteration, &best);
        block_on(gpu.run_phase(Kernel::Select)).unwrap();
        assert_same(&what("selected"), &selected, &block_on(gpu.choices()).unwrap().1);
        let flips = block_on(cpu.iterate(1)).unwrap().first().copied().unwrap_or(0);
        assert_eq!(flips, block_on(gpu.run_phase(Kernel::Flip)).unwrap(), "{}", what("flips"));
        assert_same(&what("triangles"), &cpu.triangles, &block_on(gpu.triangles()).unwrap());
        assert_same(&what("twins"), &cpu.twins, &block_on(gpu.twins()).unwrap());
        assert_same(&what("anchors"), &cpu.fans.table, &block_on(gpu.fans()).unwrap());
        if flips == 0 {
            assert_eq!(census.labelled, 0, "{name}: labelled edges and no flip");
            return census;
        }
    }
    unreachable!()
}

/// Runs both engines to the end, in batches.
fn compare_runs(name: &str, degrees: f64) {
    let mesh = Arc::new(families::by_name(name).unwrap());
    let (mut cpu, mut gpu) = engines(&mesh, any_deviation(degrees));
    let flips = block_on(cpu.iterate(u32::MAX)).unwrap();
    assert_same(name, &flips, &block_on(gpu.iterate(u32::MAX)).unwrap());
    assert_same(name, &cpu.triangles, &block_on(gpu.triangles()).unwrap());
    assert_eq!(cpu.count(), block_on(gpu.census()).unwrap(), "{name}");
}

#[test]
fn plane_meshes_agree_phase_by_phase() {
    for name in [
        "grid 20",
        "random 20",
        "shear 20",
        "fan2 60",
        "strips 12",
        "sweep 400",
        "regular 20",
        "regular 20 100000",
    ] {
        compare(name, 10.0);
    }
}

#[test]
fn surfaces_agree_phase_by_phase() {
    for degrees in [0.0, 10.0, 90.0, 180.0] {
        for name in ["uvsphere 16", "uvsphere 12 0.5", "pillow 12", "roof 12", "pole 24"] {
            compare(name, degrees);
        }
    }
}

/// With floats and fixed-point numbers, and limits from 0 to one that blocks nothing.
#[test]
fn surfaces_agree_on_the_deviation() {
    for name in ["uvsphere 8", "uvsphere 8 0.5", "roof 8"] {
        let mesh = families::by_name(name).unwrap();
        let doubles: Vec<f64> = mesh.positions().iter().map(|x| x * (1.0 + f64::EPSILON)).collect();
        let doubled = Mesh::new(mesh.dimension(), doubles, mesh.triangles().to_vec()).unwrap();
        for mesh in [mesh, doubled] {
            let blocked = [0.0, 0.01, 0.1, 1e30].map(|deviation| {
                let thresholds = Thresholds { cos: cos_degrees(180.0), deviation };
                compare_mesh(name, mesh.clone(), thresholds).blocked[Reason::Deviation]
            });
            assert!(blocked[0] > 0 && blocked[3] == 0, "{name}: {blocked:?}");
        }
    }
}

/// llvmpipe ends the loop of an invocation after too many rounds. If one workgroup decided all of these edges, it would
/// stop halfway.
#[test]
fn many_edges_wait_for_exact_arithmetic() {
    let mesh = families::by_name("uvsphere 48").unwrap();
    let doubles: Vec<f64> = mesh.positions().iter().map(|x| x * (1.0 + f64::EPSILON)).collect();
    let doubled = Mesh::new(mesh.dimension(), doubles, mesh.triangles().to_vec()).unwrap();
    compare_mesh("uvsphere 48", doubled, any_deviation(10.0));
}

#[test]
fn long_runs_agree_in_batches() {
    compare_runs("strips 400", 10.0);
    compare_runs("fan2 400", 10.0);
    compare_runs("random 100", 10.0);
    compare_runs("uvsphere 60", 10.0);
}

/// The engine uses lists while few edges flip and sweeps while many do. The flips of `strips` rise and fall.
#[test]
fn sweeps_and_lists_take_turns() {
    for (name, list_below) in [("strips 100", 20), ("random 30", 64), ("uvsphere 30", 64), ("fan2 200", 8)] {
        let mesh = Arc::new(families::by_name(name).unwrap());
        let (mut cpu, mut gpu) = engines(&mesh, any_deviation(10.0));
        gpu.set_list_below(list_below);
        for count in [1, 3, 20, u32::MAX, 5] {
            let flips = block_on(cpu.iterate(count)).unwrap();
            assert_same(name, &flips, &block_on(gpu.iterate(count)).unwrap());
            assert_same(name, &cpu.triangles, &block_on(gpu.triangles()).unwrap());
        }
    }
}

/// Four sheets that share one vertex, which has several fans with moving anchors.
#[test]
fn anchors_move_alike() {
    let sheet = families::by_name("random 8").unwrap();
    let count = sheet.vertex_count() as u32;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for copy in 0..4 {
        let turn = |p: &[f32]| match copy {
            0 => [p[0], p[1]],
            1 => [-p[1], p[0]],
            2 => [-p[0], -p[1]],
            _ => [p[1], -p[0]],
        };
        positions.extend(sheet.positions().to_f32().chunks(2).flat_map(turn));
        let shared = |v: u32| if v == 0 { 0 } else { v + copy * count };
        triangles.extend(sheet.triangles().iter().map(|&v| shared(v)));
    }
    assert_eq!(sheet.positions().to_f32()[..2], [0.0, 0.0]);
    compare_mesh(
        "four sheets",
        Mesh::new(crate::Dimension::Two, positions, triangles).unwrap(),
        any_deviation(10.0),
    );
}

/// A sheet, and beside it triangles around vertex 0, of an eighth of a round each: `count` from direction `first` on.
fn sheet_and_open_fan(first: usize, count: u32, is_clockwise: bool) -> Mesh {
    let directions = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
    let directions = (0..=count as usize).map(|i| directions[(first + i) % 8]);
    let fan: Vec<f32> = [[0, 0]].into_iter().chain(directions).flatten().map(|x| x as f32).collect();
    let sheet = families::by_name("random 20").unwrap();
    let mut positions = [fan, sheet.positions().to_f32().iter().map(|x| x + 9.0).collect()].concat();
    if is_clockwise {
        positions.iter_mut().skip(1).step_by(2).for_each(|y| *y = -*y);
    }
    let triangles = (0..count).flat_map(|i| [0, 1 + i, 2 + i]);
    let triangles = triangles.chain(sheet.triangles().iter().map(|&v| count + 2 + v)).collect();
    Mesh::new(crate::Dimension::Two, positions, triangles).unwrap()
}

fn has_selection(mesh: Mesh) -> bool {
    let (_, gpu) = engines(&Arc::new(mesh), any_deviation(10.0));
    block_on(gpu.has_selection()).unwrap()
}

/// Where all stars are embedded, the engine does not run Select.
#[test]
fn open_fans_are_embedded_if_they_go_less_than_round() {
    for (first, is_clockwise) in (0..8).flat_map(|first| [(first, false), (first, true)]) {
        for count in 1..20 {
            let found = has_selection(sheet_and_open_fan(first, count, is_clockwise));
            assert_eq!(found, count >= 8, "{first}, {count}, {is_clockwise}");
        }
    }
    for name in ["random 20", "shear 20", "regular 20", "grid 20"] {
        assert!(!has_selection(families::by_name(name).unwrap()), "{name}");
    }
    // Holes: without one of their triangles, meshes have reflex corners.
    let mesh = families::by_name("random 20").unwrap();
    let holed =
        mesh.triangles().chunks(3).enumerate().filter(|(t, _)| t % 250 != 120).flat_map(|(_, t)| t.to_vec());
    let holed = Mesh::new(mesh.dimension(), mesh.positions().to_f32(), holed.collect()).unwrap();
    assert!(!has_selection(holed));
    // One more open fan at vertex 0 of a fan that is closed: the crossing is not that of the open one.
    let closed = sheet_and_open_fan(0, 8, false);
    let last = |&v: &u32| if v == 9 { 1 } else { v };
    let mut triangles: Vec<u32> = closed.triangles().iter().map(last).collect();
    let two_fans = |triangles| Mesh::new(closed.dimension(), closed.positions().to_f32(), triangles).unwrap();
    assert!(!has_selection(two_fans(triangles.clone())));
    triangles.extend([0, 10, 11]);
    assert!(has_selection(two_fans(triangles)));
}

/// A thread of the pool that waits for a GPU does no other work of the pool.
#[cfg(feature = "threads")]
#[test]
fn all_threads_of_the_pool_wait_for_the_gpu_at_once() {
    use rayon::iter::{IntoParallelIterator, ParallelIterator};
    let mesh = Arc::new(families::by_name("random 30").unwrap());
    let run = |_| {
        let (_, mut gpu) = engines(&mesh, any_deviation(10.0));
        block_on(gpu.iterate(u32::MAX)).unwrap();
        block_on(gpu.triangles()).unwrap()
    };
    let results: Vec<_> = (0..4 * rayon::current_num_threads()).into_par_iter().map(run).collect();
    assert!(results.iter().all(|result| *result == results[0]));
}

#[test]
fn an_empty_mesh_is_done() {
    let mesh = Arc::new(Mesh::new(crate::Dimension::Two, Vec::<f32>::new(), Vec::new()).unwrap());
    let (_, mut gpu) = engines(&mesh, any_deviation(10.0));
    assert_eq!(block_on(gpu.iterate(10)).unwrap(), Vec::<u32>::new());
    assert_eq!(block_on(gpu.triangles()).unwrap(), Vec::<u32>::new());
}

/// `cargo test --lib tiers -- --nocapture` prints this table and that of the CPU.
#[test]
fn tiers_of_the_gpu() {
    const N: u32 = 100;
    println!("| mesh | interior edges | f32 filter | exact |\n|---|---:|---:|---:|");
    for (name, mesh) in kinds(N as usize).unwrap() {
        let Ok(upload) = Upload::new(EngineKind::Gpu, Arc::new(mesh), any_deviation(0.0)) else { continue };
        let gpu = block_on(async { WebGpu::new(Device::shared(true, None).await?, upload).await }).unwrap();
        let [filter, exact] = block_on(gpu.tiers()).unwrap();
        println!("| {name} | {} | {filter} | {exact} |", filter + exact);
        let EdgeCounts { edges, boundary, .. } = gpu.edge_counts();
        assert_eq!(filter + exact, edges - boundary, "{name}");
        if name.starts_with("lattice of") || name.starts_with("lattice at") {
            assert_eq!(exact, 0, "{name}: its ties have right angles");
        }
        if name == "turned lattice" {
            assert!(exact >= (N - 1) * (N - 1), "{name}: its diagonals are ties");
        }
        if ["random", "uvsphere"].contains(&name) {
            assert!(100 * exact < edges, "{name}");
        }
    }
}

/// No two triangles share a vertex, so the table of edges is as full as it can be.
#[test]
fn a_soup_has_the_edges_of_its_triangles() {
    let positions: Vec<f32> = (0..900_000).map(|i| (i % 1009) as f32).collect();
    let soup = Mesh::new(crate::Dimension::Three, positions, (0..300_000).collect()).unwrap();
    let mesh = Arc::new(families::shuffled(&soup, 1));
    let (cpu, mut gpu) = engines(&mesh, any_deviation(10.0));
    assert_eq!(cpu.edge_counts(), gpu.edge_counts());
    assert_same("twins", &cpu.twins, &block_on(gpu.twins()).unwrap());
}
