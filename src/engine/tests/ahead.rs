//! The WebGPU engine as it is in browsers: it waits for nothing before its first iterations, and reads behind them what it
//! will be asked for.

use super::{Cpu, Device, Engine, Mesh, Upload, WebGpu, any_deviation, assert_same, families};
use crate::engine::EdgeCounts;
use crate::phases::Thresholds;
use crate::session::locks;
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

/// What both engines say of a mesh after a run, of which the GPU knows it already, and when it is asked once more.
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

/// Where a point goes.
type Map = fn([f32; 2]) -> [f32; 2];

/// Copies of a sheet in the plane, each by a map of its points and with its vertex 0, which stays, or the first copy's.
fn sheets(maps: &[Map], are_joined: bool) -> Mesh {
    let sheet = families::by_name("random 8").unwrap();
    let count = sheet.vertex_count() as u32;
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (copy, map) in (0..).zip(maps) {
        positions.extend(sheet.positions().to_f32().chunks(2).flat_map(|p| map([p[0], p[1]])));
        let place = |&v: &u32| if are_joined && v == 0 { 0 } else { v + copy * count };
        triangles.extend(sheet.triangles().iter().map(place));
    }
    Mesh::new(Dimension::Two, positions, triangles).unwrap()
}

/// Meshes that need no help of the host, and those that do: with several fans, both windings, and both of these.
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

/// After 0 to 20 iterations, which is more than a submission has on llvmpipe, and then to the end.
#[test]
fn runs_stop_alike() {
    for (name, mesh) in meshes() {
        let mesh = Arc::new(mesh);
        for count in (0..6).chain([11, 12, 13, 15, 16, 17, 20]) {
            let (mut cpu, mut gpu) = engines(&mesh, any_deviation(10.0));
            iterate(name, count, &mut cpu, &mut gpu);
            assert_same_end(name, &mut cpu, &mut gpu);
            iterate(name, u32::MAX, &mut cpu, &mut gpu);
            assert_same_end(name, &mut cpu, &mut gpu);
        }
    }
}

/// An iteration at a time, with the questions of a session that is watched.
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

/// Moves of the vertices, which turn sheets over or lay them together, and locks that stay.
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
                let half_edges = locks::half_edges(&mesh, &edges).unwrap();
                block_on(cpu.lock(half_edges.clone())).unwrap();
                block_on(gpu.lock(half_edges)).unwrap();
            }
            for (turn, place) in moves.into_iter().enumerate() {
                // Of some the run has not ended, of one it has not begun.
                iterate(name, [u32::MAX, 2, 0, 1][turn], &mut cpu, &mut gpu);
                let moved = mesh.positions().to_f32().into_iter().enumerate();
                let moved: Vec<f32> = moved.map(|(i, x)| place(i, x)).collect();
                let moved = Arc::new(Mesh::new(mesh.dimension(), moved, cpu.triangles.clone()).unwrap());
                block_on(cpu.set_positions(moved.clone())).unwrap();
                block_on(gpu.set_positions(moved)).unwrap();
            }
            iterate(name, u32::MAX, &mut cpu, &mut gpu);
            assert_same_end(name, &mut cpu, &mut gpu);
        }
    }
}

/// On a device of its own, which counts what it is asked for.
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
    // The preparation and the iterations, which are waited for.
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
