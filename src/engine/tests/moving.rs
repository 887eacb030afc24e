//! Updates: the CPU and the GPU engine agree after each one.

use super::{any_deviation, assert_same, engines};
use crate::engine::{Cpu, Engine, Moved, WebGpu};
use crate::mesh::Mesh;
use crate::mesh::areas::Areas;
use crate::phases::Thresholds;
use crate::{Dimension, Positions, cos_degrees, families};
use pollster::block_on;
use proptest::prelude::*;
use std::sync::Arc;

/// Updates both engines, and compares all that they tell.
fn update(what: &str, (cpu, gpu): (&mut Cpu, &mut WebGpu), positions: &[f32], iterations: u32) -> Moved {
    let moved = || Some(Positions::F32(positions.to_vec()));
    cpu.update(moved(), iterations, true).unwrap();
    gpu.update(moved(), iterations, true).unwrap();
    let found = block_on(gpu.moved()).unwrap();
    assert_same(what, &block_on(cpu.changes()).unwrap(), &block_on(gpu.changes()).unwrap());
    assert_same(what, &cpu.triangles, &block_on(Engine::triangles(gpu)).unwrap());
    assert_same(what, &cpu.twins, &block_on(Engine::twins(gpu)).unwrap());
    assert_eq!(block_on(cpu.moved()).unwrap(), found, "{what}");
    found
}

/// Moves a mesh in frames with these positions.
fn compare(what: &str, mesh: Mesh, thresholds: Thresholds, frames: &[(Vec<f32>, u32)]) -> Vec<Moved> {
    let (mut cpu, mut gpu) = engines(&Arc::new(mesh), thresholds);
    block_on(cpu.track_changes()).unwrap();
    block_on(gpu.track_changes()).unwrap();
    let frames = frames.iter().enumerate();
    let compare = |(frame, (positions, iterations)): (usize, &(Vec<f32>, u32))| {
        update(&format!("{what}, frame {frame}"), (&mut cpu, &mut gpu), positions, *iterations)
    };
    frames.map(compare).collect()
}

/// The positions of a mesh, each point mapped.
fn mapped(mesh: &Mesh, map: impl Fn(&[f32]) -> Vec<f32>) -> Vec<f32> {
    mesh.positions().to_f32().chunks(mesh.dimension().stride()).flat_map(map).collect()
}

#[test]
fn a_twisted_sheet_folds_and_unfolds_alike() {
    let mesh = families::by_name("random 30").unwrap();
    let middle = 0.5;
    let twist = |degrees: f32| {
        mapped(&mesh, |p| {
            let (x, y) = (p[0] - middle, p[1] - middle);
            let angle = degrees.to_radians() * (1.0 - x.hypot(y) / 0.7).max(0.0);
            let (sin, cos) = angle.sin_cos();
            vec![x * cos - y * sin, x * sin + y * cos]
        })
    };
    let frames: Vec<_> = (0..40u8).map(|frame| (twist(f32::from(frame) * 40.0), 3)).collect();
    let counts = compare("twist", mesh.clone(), any_deviation(10.0), &frames);
    assert!(counts.iter().any(|moved| moved.areas.inverted > 0), "no triangle turned over");
    assert!(counts.last().unwrap().flips > 1000);
}

#[test]
fn clockwise_sheets_and_sheets_of_both_windings_move_alike() {
    let sheet = families::by_name("random 8").unwrap();
    let turned: Vec<u32> = sheet.triangles().chunks(3).flat_map(|t| [t[0], t[2], t[1]]).collect();
    let count = sheet.vertex_count() as u32;
    let both = sheet.triangles().iter().copied().chain(turned.iter().map(|v| v + count)).collect();
    let twice = sheet.positions().to_f32().repeat(2);
    for (what, positions, triangles) in
        [("clockwise", sheet.positions().to_f32(), turned), ("both", twice, both)]
    {
        let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
        // In the last frame, the sheets are upside down.
        let frames: Vec<_> = [0.0, 0.7, 1.1, 1.9, 2.0, 3.0]
            .map(|shear: f32| (mapped(&mesh, |p| vec![p[0] * (2.0 - shear) - shear, p[1] + shear * p[0]]), 5))
            .into();
        let counts = compare(what, mesh, any_deviation(10.0), &frames);
        assert_eq!(counts[0].areas, Areas::default(), "{what}");
        assert!(counts[5].areas.inverted > 0, "{what}");
    }
}

#[test]
fn waves_move_alike() {
    for (name, deviation) in [
        ("uvsphere 20", f32::INFINITY),
        ("uvsphere 12", 0.05),
        ("uvsphere 12", 1e18),
        ("pole 16", f32::INFINITY),
    ] {
        let mesh = families::by_name(name).unwrap();
        let wave = |time: f32| {
            mapped(&mesh, |p| {
                let factor = 1.0 + 0.2 * (5.0 * p[2] + time).sin();
                vec![p[0] * factor, p[1] / factor, p[2]]
            })
        };
        let thresholds = Thresholds { cos: cos_degrees(30.0), deviation };
        let frames: Vec<_> = (0..12u8).map(|frame| (wave(0.3 * f32::from(frame)), 2)).collect();
        let counts = compare(name, mesh.clone(), thresholds, &frames);
        assert!(counts.last().unwrap().flips > 0, "{name}");
    }
}

/// Numbers that are not finite freeze triangles for one frame.
#[test]
fn infinite_numbers_freeze_their_triangles() {
    for name in ["random 12", "uvsphere 10"] {
        let mesh = families::by_name(name).unwrap();
        let stride = mesh.dimension().stride();
        let still = mesh.positions().to_f32();
        let mut broken = mapped(&mesh, |p| p.iter().rev().copied().collect());
        for (vertex, number) in [(17, f32::NAN), (40, f32::INFINITY), (41, f32::NEG_INFINITY)] {
            broken[stride * vertex + 1] = number;
        }
        let counts =
            compare(name, mesh, any_deviation(60.0), &[(still.clone(), 1), (broken, 4), (still, 64)]);
        let infinite: Vec<_> = counts.iter().map(|moved| moved.infinite).collect();
        assert!(infinite[0] == 0 && infinite[1] > 10 && infinite[2] == 0, "{infinite:?}");
        assert_eq!(counts[2].census.labelled, 0);
    }
}

/// The GPU leaves edges alone whose points span too many bits, and counts them.
#[test]
fn points_that_span_too_many_bits_are_left_alone() {
    let mesh = Arc::new(families::by_name("random 12").unwrap());
    let (_, mut gpu) = engines(&mesh, any_deviation(10.0));
    let mut positions = mesh.positions().to_f32();
    positions[80] = 1e-30;
    gpu.update(Some(positions.clone().into()), 64, true).unwrap();
    let moved = block_on(gpu.moved()).unwrap();
    assert!(
        moved.wide > 2 && moved.wide < 40 && moved.infinite == 0 && moved.census.labelled == 0,
        "{moved:?}"
    );
    positions[80] = 1e-3;
    gpu.update(Some(positions.into()), 64, true).unwrap();
    let moved = block_on(gpu.moved()).unwrap();
    assert!(moved.wide == 0 && moved.census.labelled == 0, "{moved:?}");
}

/// A triangle has changed in an update if its vertices have.
#[test]
fn changes_are_those_of_the_triangles() {
    let mesh = Arc::new(families::by_name("random 15").unwrap());
    let (mut cpu, _) = engines(&mesh, any_deviation(10.0));
    block_on(cpu.track_changes()).unwrap();
    block_on(cpu.iterate(1)).unwrap();
    for number in 1..5 {
        let before = cpu.triangles.clone();
        cpu.update(Some(mapped(&mesh, |p| vec![p[0] + number as f32 * p[1], p[1]]).into()), 1, true).unwrap();
        let changes = block_on(cpu.changes()).unwrap();
        let has_changed = |t: usize| before[3 * t..3 * t + 3] != cpu.triangles[3 * t..3 * t + 3];
        let expected: Vec<bool> = (0..changes.len()).map(has_changed).collect();
        let found: Vec<bool> = changes.iter().map(|&update| update == number).collect();
        assert_eq!(found, expected);
        assert!(expected.contains(&true) && expected.contains(&false));
    }
    let again = Mesh::new(Dimension::Two, mesh.positions().clone(), cpu.triangles.clone()).unwrap();
    block_on(cpu.set_positions(Arc::new(again), None)).unwrap();
    assert!(block_on(cpu.changes()).unwrap().iter().all(|&update| update == 0));
}

/// Counts that nobody has waited for do not stop later updates, and are those of their own update.
#[test]
fn counts_are_of_the_update_before_them() {
    let mesh = Arc::new(families::by_name("shear 20").unwrap());
    let (mut cpu, mut gpu) = engines(&mesh, any_deviation(10.0));
    let mut waiting = Vec::new();
    // After a run, updates count their iterations from 0.
    assert_eq!(block_on(cpu.iterate(3)).unwrap(), block_on(gpu.iterate(3)).unwrap());
    // A count disturbs no run.
    assert_eq!(block_on(cpu.moved()).unwrap(), block_on(gpu.moved()).unwrap());
    assert_eq!(block_on(cpu.iterate(2)).unwrap(), block_on(gpu.iterate(2)).unwrap());
    for iterations in [1, 0, 2, 3, 64] {
        cpu.update(None, iterations, true).unwrap();
        gpu.update(None, iterations, true).unwrap();
        waiting.push((block_on(cpu.moved()).unwrap(), gpu.moved()));
    }
    for (expected, found) in waiting {
        assert_eq!(expected, block_on(found).unwrap());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Dirty meshes: triangles of random vertices, on a small grid with many ties, that jump about.
    #[test]
    fn random_motions_of_dirty_meshes_agree(
        dimension in prop_oneof![Just(Dimension::Two), Just(Dimension::Three)],
        corners in prop::collection::vec(0u32..14, 30..150),
        frames in prop::collection::vec((prop::collection::vec(-3i8..4, 42), 0u32..4), 1..5),
    ) {
        let stride = dimension.stride();
        let positions = |numbers: &[i8]| numbers[..14 * stride].iter().map(|&x| f32::from(x)).collect::<Vec<_>>();
        let triangles: Vec<u32> = corners
            .chunks_exact(3)
            .filter(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            .flatten()
            .copied()
            .collect();
        let mesh = Mesh::new(dimension, positions(&frames[0].0), triangles).unwrap();
        let frames: Vec<_> = frames.iter().map(|(numbers, count)| (positions(numbers), *count)).collect();
        compare("dirty", mesh, any_deviation(120.0), &frames);
    }
}
