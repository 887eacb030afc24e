//! An arranged mesh and the same mesh in the caller's order give the same answers.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

use super::Cpu;
use crate::engine::Engine;
use crate::mesh::arrangement::Arrangement;
use crate::mesh::half_edge::unflagged;
use crate::phases::Thresholds;
use crate::system::threads::Threads;
use crate::{Dimension, Mesh, NONE, Positions, cos_degrees, families};
use oorandom::Rand64;
use pollster::block_on;
use proptest::prelude::*;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// The engine in the caller's order, and the engine on an arranged mesh.
fn pair(mesh: &Arc<Mesh>, thresholds: Thresholds, threads: &Threads) -> [Cpu; 2] {
    let (arrangement, arranged) = Arrangement::along_a_curve(mesh, threads);
    [
        Cpu::new(mesh.clone(), thresholds, threads.clone()),
        Cpu::with(arrangement, Arc::new(arranged), thresholds, threads.clone()),
    ]
}

fn both<T: PartialEq + std::fmt::Debug>(pair: &mut [Cpu; 2], ask: impl Fn(&mut Cpu) -> T) -> T {
    let [plain, arranged] = pair.each_mut().map(ask);
    assert_eq!(plain, arranged);
    arranged
}

/// Runs both to the end, and compares them after each iteration.
fn run(pair: &mut [Cpu; 2]) {
    loop {
        both(pair, |cpu| block_on(cpu.census()).unwrap());
        let flips = both(pair, |cpu| block_on(cpu.iterate(1)).unwrap());
        both(pair, |cpu| block_on(Engine::triangles(cpu)).unwrap());
        both(pair, |cpu| block_on(Engine::twins(cpu)).unwrap());
        if flips.is_empty() {
            break;
        }
    }
}

fn shaken(mesh: &Mesh, random: &mut Rand64) -> Positions {
    let shake = |x: f64| (x + 0.2 * (random.rand_float() - 0.5)) as f32;
    Positions::F32(mesh.positions().iter().map(shake).collect())
}

/// Triangles between random vertices.
fn soup(dimension: Dimension, vertices: u64, triangles: usize, random: &mut Rand64) -> Mesh {
    let positions: Vec<f32> =
        (0..vertices * dimension.stride() as u64).map(|_| random.rand_range(0..5) as f32).collect();
    let corners = (0..3 * triangles).map(|_| random.rand_range(0..vertices) as u32).collect();
    Mesh::new(dimension, positions, corners).unwrap()
}

proptest! {
    #[test]
    fn an_arranged_mesh_gives_the_same_answers(seed in any::<u64>(), kind in 0usize..8, degrees in 0.0..180.0f64, threads in 1usize..4) {
        let mut random = Rand64::new(seed.into());
        let mesh = match kind {
            0 => soup(Dimension::Two, 8, 30, &mut random),
            1 => soup(Dimension::Three, 8, 30, &mut random),
            family => {
                let name = ["random 9", "shear 9", "fan2 40", "uvsphere 8", "pole 20", "roof 5"][family - 2];
                families::shuffled(&families::by_name(name).unwrap(), seed)
            }
        };
        let threads = Threads::new(NonZeroUsize::new(threads), usize::MAX).unwrap();
        let thresholds = Thresholds { cos: cos_degrees(degrees), ..Thresholds::default() };
        let mesh = Arc::new(mesh);
        let mut pair = pair(&mesh, thresholds, &threads);
        both(&mut pair, |cpu| cpu.edge_counts());
        let twins = both(&mut pair, |cpu| block_on(Engine::twins(cpu)).unwrap());
        let some = (0..).zip(twins).filter(|&(h, twin)| h % 11 == 0 && twin != NONE);
        let locked: Vec<u32> = some.flat_map(|(h, twin)| [h, unflagged(twin)]).collect();
        both(&mut pair, |cpu| block_on(cpu.lock(locked.clone())).unwrap());
        both(&mut pair, |cpu| block_on(cpu.track_changes()).unwrap());
        run(&mut pair);
        for _ in 0..2 {
            let moved = shaken(&mesh, &mut random);
            both(&mut pair, |cpu| cpu.update(Some(moved.clone()), 3, true).unwrap());
            both(&mut pair, |cpu| block_on(cpu.positions()).unwrap());
            both(&mut pair, |cpu| block_on(cpu.changes()).unwrap());
            both(&mut pair, |cpu| block_on(cpu.moved()).unwrap());
            both(&mut pair, |cpu| block_on(Engine::triangles(cpu)).unwrap());
        }
        let triangles = both(&mut pair, |cpu| block_on(Engine::triangles(cpu)).unwrap());
        let moved = Arc::new(Mesh::new(mesh.dimension(), shaken(&mesh, &mut random), triangles).unwrap());
        both(&mut pair, |cpu| block_on(cpu.set_positions(moved.clone(), None)).unwrap());
        run(&mut pair);
    }
}
