//! The WebGPU engine against the CPU engine, array by array after every phase, on whatever adapter there is.

use super::webgpu::{Device, Kernel, WebGpu};
use super::{Cpu, Engine};
use crate::mesh::Mesh;
use crate::{cos_degrees, families};
use pollster::block_on;
use std::sync::Arc;

fn engines(mesh: &Arc<Mesh>, degrees: f64) -> (Cpu, WebGpu) {
    let cos = cos_degrees(degrees);
    let gpu = block_on(async { WebGpu::new(Device::shared().await?, mesh, cos).await }).unwrap();
    (Cpu::new(mesh.clone(), cos), gpu)
}

#[track_caller]
fn assert_same(what: &str, cpu: &[u32], gpu: &[u32]) {
    if let Some(i) = (0..cpu.len().max(gpu.len())).find(|&i| cpu.get(i) != gpu.get(i)) {
        panic!("{what}[{i}]: cpu {:?}, gpu {:?}", cpu.get(i), gpu.get(i));
    }
}

/// Runs both engines phase by phase to the end.
fn compare(name: &str, degrees: f64) {
    let mesh = Arc::new(families::by_name(name).unwrap());
    let (mut cpu, mut gpu) = engines(&mesh, degrees);
    assert_same("twins", &cpu.twins, &block_on(gpu.twins()).unwrap());
    assert_eq!(cpu.edge_counts(), gpu.edge_counts(), "{name}");
    for iteration in 0.. {
        let what = |array: &str| format!("{name}, β = {degrees}, iteration {iteration}: {array}");
        let census = cpu.count();
        assert_eq!(census, block_on(gpu.census()).unwrap(), "{}", what("census"));
        cpu.label();
        block_on(gpu.run_phase(Kernel::Label)).unwrap();
        let (best, _) = block_on(gpu.choices()).unwrap();
        assert_same(&what("best"), &cpu.best, &best);
        cpu.select();
        block_on(gpu.run_phase(Kernel::Select)).unwrap();
        let (_, selected) = block_on(gpu.choices()).unwrap();
        assert_same(&what("selected"), &cpu.selected, &selected);
        let flips = cpu.flip();
        assert_eq!(flips, block_on(gpu.run_phase(Kernel::Flip)).unwrap(), "{}", what("flips"));
        assert_same(&what("triangles"), &cpu.triangles, &block_on(gpu.triangles()).unwrap());
        assert_same(&what("twins"), &cpu.twins, &block_on(gpu.twins()).unwrap());
        assert_same(&what("anchors"), &cpu.fans.table, &block_on(gpu.fans()).unwrap());
        if flips == 0 {
            assert_eq!(census.labelled, 0, "{name}: labelled edges and no flip");
            break;
        }
    }
}

/// Runs both engines in batches.
fn compare_runs(name: &str, degrees: f64) {
    let mesh = Arc::new(families::by_name(name).unwrap());
    let (mut cpu, mut gpu) = engines(&mesh, degrees);
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

#[test]
fn long_runs_agree_in_batches() {
    compare_runs("strips 400", 10.0);
    compare_runs("fan2 1000", 10.0);
    compare_runs("random 100", 10.0);
    compare_runs("uvsphere 60", 10.0);
}

#[test]
fn an_empty_mesh_is_done() {
    let mesh = Arc::new(Mesh::new(crate::Dimension::Two, Vec::new(), Vec::new()).unwrap());
    let (_, mut gpu) = engines(&mesh, 10.0);
    assert_eq!(block_on(gpu.iterate(10)).unwrap(), Vec::<u32>::new());
    assert_eq!(block_on(gpu.triangles()).unwrap(), Vec::<u32>::new());
}
