//! The WebGPU engine as it runs in browsers: it does not wait before its first iterations, and reads the results of a
//! run with them.

use super::{Cpu, Device, Engine, Mesh, Upload, WebGpu, any_deviation, assert_same, families};
use crate::engine::EdgeCounts;
use crate::mesh::named_edges;
use crate::phases::Thresholds;
use crate::system::threads::Threads;
use crate::{Dimension, EngineKind, Error};
use pollster::block_on;
use std::sync::Arc;

fn engines(mesh: &Arc<Mesh>, thresholds: Thresholds) -> (Cpu, WebGpu) {
    let gpu = block_on(async {
        let upload = Upload::new(EngineKind::Gpu, mesh.clone(), thresholds)?;
        WebGpu::begun(Device::shared(true, None).await?, upload, false).await
    });
    (Cpu::new(mesh.clone(), thresholds, Threads::default()), gpu.unwrap())
}

/// Compares the results of both engines after a run: those that the GPU has read in advance, then without them.
#[track_caller]
fn assert_same_end(what: &str, cpu: &mut Cpu, gpu: &mut WebGpu) {
    let census = block_on(gpu.census()).unwrap();
    assert_eq!(census, cpu.count(), "{what}");
    assert_eq!(gpu.edge_counts(), cpu.edge_counts(), "{what}");
    for _ in 0..2 {
        assert_same(what, &cpu.triangles, &block_on(gpu.triangles()).unwrap());
    }
    gpu.forget();
    assert_eq!(census, block_on(gpu.census()).unwrap(), "{what}");
    assert_same(what, &cpu.twins, &block_on(gpu.twins()).unwrap());
}

#[track_caller]
fn iterate(what: &str, count: u32, cpu: &mut Cpu, gpu: &mut WebGpu) -> usize {
    let flips = block_on(cpu.iterate(count)).unwrap();
    assert_same(what, &flips, &block_on(gpu.iterate(count)).unwrap());
    flips.len()
}

/// A map of points.
type Map = fn([f32; 2]) -> [f32; 2];

/// Copies of a sheet in the plane, one per map. The maps keep vertex 0; if `are_joined`, the copies share it.
fn sheets(maps: &[Map], are_joined: bool) -> Mesh {
    let sheet = families::by_name("random 8").unwrap();
    let count = sheet.vertex_count() as u32;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (copy, map) in (0..).zip(maps) {
        positions.extend(sheet.positions().to_f32().chunks(2).flat_map(|p| map([p[0], p[1]])));
        let renumbered = |&v: &u32| if are_joined && v == 0 { 0 } else { v + copy * count };
        triangles.extend(sheet.triangles().iter().map(renumbered));
    }
    Mesh::new(Dimension::Two, positions, triangles).unwrap()
}

/// Meshes that need no help of the host, then meshes that do: with several fans, with both windings, with both.
fn meshes() -> Vec<(&'static str, Mesh)> {
    let turned = |p: [f32; 2]| [-p[0], -p[1]];
    let mirrored = |p: [f32; 2]| [-p[0], p[1]];
    let mut meshes: Vec<_> = ["random 20", "strips 40", "regular 12", "uvsphere 12", "roof 12", "pole 24"]
        .map(|name| (name, families::by_name(name).unwrap()))
        .into();
    let roofs = families::by_name("roof 8").unwrap();
    let count = roofs.vertex_count() as u32;
    let copy = |v: &u32| if *v == 0 { 0 } else { v + count };
    let triangles = roofs.triangles().iter().copied().chain(roofs.triangles().iter().map(copy)).collect();
    let points = roofs.positions().to_f32();
    let points = [points.clone(), points.iter().map(|x| -x).collect()].concat();
    meshes.extend([
        ("clockwise", sheets(&[mirrored], false)),
        ("several fans", sheets(&[|p| p, turned], true)),
        ("both windings", sheets(&[|p| p, mirrored], false)),
        ("several fans and both windings", sheets(&[|p| p, turned, mirrored], true)),
        ("several fans in space", Mesh::new(Dimension::Three, points, triangles).unwrap()),
    ]);
    meshes
}

#[test]
fn runs_end_alike() {
    for (name, mesh) in meshes() {
        let (mut cpu, mut gpu) = engines(&Arc::new(mesh), any_deviation(10.0));
        iterate(name, u32::MAX, &mut cpu, &mut gpu);
        assert_same_end(name, &mut cpu, &mut gpu);
    }
}

/// Stops after 0 to 20 iterations, more than one submission has on llvmpipe, and then runs to the end. As in browsers,
/// and natively.
#[test]
fn runs_stop_alike() {
    for (name, mesh) in meshes() {
        let mesh = Arc::new(mesh);
        for count in (0..6).chain([11, 12, 13, 15, 16, 17, 20]) {
            for engines in [engines, super::engines] {
                let (mut cpu, mut gpu) = engines(&mesh, any_deviation(10.0));
                iterate(name, count, &mut cpu, &mut gpu);
                assert_same_end(name, &mut cpu, &mut gpu);
                iterate(name, u32::MAX, &mut cpu, &mut gpu);
                assert_same_end(name, &mut cpu, &mut gpu);
            }
        }
    }
}

/// Runs one iteration at a time, with the questions of `Session::step`.
#[test]
fn steps_are_alike() {
    for (name, mesh) in meshes() {
        let (mut cpu, mut gpu) = engines(&Arc::new(mesh), any_deviation(10.0));
        loop {
            assert_eq!(cpu.count(), block_on(gpu.census()).unwrap(), "{name}");
            if iterate(name, 1, &mut cpu, &mut gpu) == 0 {
                break;
            }
            assert_same(name, &cpu.triangles, &block_on(gpu.triangles()).unwrap());
        }
        assert_same_end(name, &mut cpu, &mut gpu);
    }
}

#[test]
fn an_engine_is_asked_before_it_runs() {
    for (name, mesh) in meshes() {
        let (mut cpu, mut gpu) = engines(&Arc::new(mesh), any_deviation(10.0));
        assert_same_end(name, &mut cpu, &mut gpu);
        iterate(name, u32::MAX, &mut cpu, &mut gpu);
        assert_same_end(name, &mut cpu, &mut gpu);
    }
    let (mut cpu, mut gpu) = engines(
        &Arc::new(Mesh::new(Dimension::Two, Vec::<f32>::new(), vec![]).unwrap()),
        any_deviation(10.0),
    );
    assert_eq!(iterate("empty", u32::MAX, &mut cpu, &mut gpu), 0);
    assert_eq!(gpu.edge_counts(), EdgeCounts::default());
    assert_same_end("empty", &mut cpu, &mut gpu);
}

/// Moves vertices, so that sheets turn over or overlap, with locks that stay.
#[test]
fn vertices_move_alike() {
    let moves: [fn(usize, f32) -> f32; 4] =
        [|i, x| x * (1.0 + (i % 2) as f32), |_, x| -x, |i, x| if i < 60 { x } else { -x * x }, |_, x| x];
    for has_locks in [false, true] {
        for (name, mesh) in meshes() {
            let mesh = Arc::new(mesh);
            let (mut cpu, mut gpu) = engines(&mesh, any_deviation(10.0));
            if has_locks {
                let edges: Vec<[u32; 2]> = mesh.triangles().chunks(15).map(|t| [t[0], t[1]]).collect();
                let half_edges = named_edges::half_edges(&mesh, &edges).unwrap();
                block_on(cpu.lock(half_edges.clone())).unwrap();
                block_on(gpu.lock(half_edges)).unwrap();
            }
            for (turn, map) in moves.into_iter().enumerate() {
                // Some runs have not ended when the vertices move; one has not begun.
                iterate(name, [u32::MAX, 2, 0, 1][turn], &mut cpu, &mut gpu);
                let moved = mesh.positions().to_f32().into_iter().enumerate();
                let moved: Vec<f32> = moved.map(|(i, x)| map(i, x)).collect();
                let moved = Arc::new(Mesh::new(mesh.dimension(), moved, cpu.triangles.clone()).unwrap());
                block_on(cpu.set_positions(moved.clone(), None)).unwrap();
                block_on(gpu.set_positions(moved, None)).unwrap();
            }
            iterate(name, u32::MAX, &mut cpu, &mut gpu);
            assert_same_end(name, &mut cpu, &mut gpu);
        }
    }
}

/// On a device of its own, since the device counts its calls.
#[test]
fn a_run_waits_once() {
    let asked = |mesh: Mesh| {
        block_on(async {
            let gpu = Device::own().await?;
            let upload = Upload::new(EngineKind::Gpu, Arc::new(mesh), any_deviation(10.0))?;
            let before = gpu.asked();
            let mut engine = WebGpu::begun(gpu.clone(), upload, false).await?;
            assert!(engine.iterate(u32::MAX).await?.len() > 1);
            engine.triangles().await?;
            engine.census().await?;
            let after = gpu.asked();
            Ok::<_, Error>([after[0] - before[0], after[1] - before[1]])
        })
        .unwrap()
    };
    // Two submissions: the preparation and the iterations. The host waits for the second.
    assert_eq!(asked(families::by_name("random 12").unwrap()), [2, 1]);
    assert_eq!(asked(families::by_name("uvsphere 12").unwrap()), [2, 1]);
    assert_eq!(asked(sheets(&[|p| [-p[0], p[1]]], false)), [2, 1]);
    // The host has to help.
    for (name, mesh) in
        meshes().into_iter().filter(|(name, _)| name.contains("fans") || name.starts_with("both"))
    {
        assert!(asked(mesh)[1] > 1, "{name}");
    }
}

/// A native engine after a run, on a device of its own, since the device counts its calls.
fn run(mesh: &Arc<Mesh>) -> (Arc<Device>, WebGpu) {
    block_on(async {
        let gpu = Device::own().await?;
        let upload = Upload::new(EngineKind::Gpu, mesh.clone(), any_deviation(10.0))?;
        let mut engine = WebGpu::new(gpu.clone(), upload).await?;
        engine.iterate(u32::MAX).await?;
        Ok::<_, Error>((gpu, engine))
    })
    .unwrap()
}

#[test]
fn a_run_without_flips_reads_no_triangles() {
    let mesh = Arc::new(families::by_name("regular 12").unwrap());
    let (gpu, mut engine) = run(&mesh);
    let before = gpu.asked();
    assert_same("triangles", mesh.triangles(), &block_on(engine.triangles()).unwrap());
    assert_eq!(gpu.asked(), before);
}

#[test]
fn counts_follow_a_run() {
    let (gpu, mut engine) = run(&Arc::new(families::by_name("uvsphere 12").unwrap()));
    let before = gpu.asked();
    let census = block_on(engine.census()).unwrap();
    assert_eq!(gpu.asked(), before);
    engine.forget();
    assert_eq!(block_on(engine.census()).unwrap(), census);
    assert!(census.labelled == 0 && gpu.asked() > before);
}
