//! Updates that untangle: the CPU and the GPU engine agree after each one, whichever kernels do the rounds, and the mesh
//! keeps its edges and its boundary.

use super::{any_deviation, assert_same, engines};
use crate::engine::{Cpu, Engine, WebGpu};
use crate::mesh::Mesh;
use crate::mesh::adjacency::Adjacency;
use crate::mesh::half_edge::{next, unflagged};
use crate::phases::key;
use crate::system::threads::Threads;
use crate::{Dimension, NONE, families};
use pollster::block_on;
use proptest::prelude::*;
use std::num::NonZeroUsize;
use std::sync::Arc;

/// A number from -1 to 1.
fn random(seed: u32, i: u32) -> f32 {
    (f64::from(key(i, seed)) / f64::from(1u32 << 31) - 1.0) as f32
}

/// The positions of a mesh whose inner vertices have moved by up to `by`, on a lattice of `steps` to a unit if it is not 0.
fn moved(mesh: &Mesh, is_inner: &[bool], seed: u32, by: f32, steps: f32) -> Vec<f32> {
    let mut positions = mesh.positions().to_f32();
    for (i, x) in (0..).zip(&mut positions).filter(|&(i, _)| is_inner[i as usize / 2]) {
        *x += by * random(seed, i);
        if steps > 0.0 {
            *x = (*x * steps).round() / steps;
        }
    }
    positions
}

/// Whether vertices are not on the boundary.
fn inner(mesh: &Mesh, twins: &[u32]) -> Vec<bool> {
    let mut is_inner = vec![true; mesh.vertex_count()];
    for h in (0..twins.len() as u32).filter(|&h| twins[h as usize] == NONE) {
        for end in [h, next(h)] {
            is_inner[mesh.triangles()[end as usize] as usize] = false;
        }
    }
    is_inner
}

/// The edges of the boundary, sorted.
fn boundary(triangles: &[u32], twins: &[u32]) -> Vec<[u32; 2]> {
    let open = (0..twins.len() as u32).filter(|&h| twins[h as usize] == NONE);
    let mut boundary: Vec<_> = open.map(|h| [h, next(h)].map(|x| triangles[x as usize])).collect();
    boundary.sort_unstable();
    boundary
}

/// Whether the twins are those of the triangles, which have the boundary and the edges of the mesh.
fn check(what: &str, mesh: &Mesh, cpu: &Cpu) {
    let found = Adjacency::of_triangles(mesh.vertex_count(), &cpu.triangles, &Threads::default());
    let twins: Vec<u32> = cpu.twins.iter().map(|&entry| unflagged(entry)).collect();
    assert_same(&format!("{what}: twins of the triangles"), &found.twins, &twins);
    let before = Adjacency::new(mesh);
    let counts = |a: &Adjacency| [a.edges, a.boundary, a.non_manifold, a.inconsistent];
    assert_eq!(counts(&before), counts(&found), "{what}");
    let [from, to] = [boundary(mesh.triangles(), &before.twins), boundary(&cpu.triangles, &twins)];
    assert!(from == to, "{what}: the boundary has changed");
}

/// Moves a mesh on the CPU, and on GPUs that do so many rounds in dispatches of their own.
fn compare(what: &str, mesh: &Mesh, locked: &[u32], wide: &[u32], frames: &[Vec<f32>]) {
    let mesh = Arc::new(mesh.clone());
    let mut cpu = engines(&mesh, any_deviation(180.0)).0;
    let mut gpus: Vec<(u32, WebGpu)> =
        wide.iter().map(|&rounds| (rounds, engines(&mesh, any_deviation(180.0)).1)).collect();
    let eight = Threads::new(NonZeroUsize::new(8), 1 << 20).unwrap();
    let mut several = Cpu::arranged(mesh.clone(), any_deviation(180.0), eight);
    block_on(cpu.track_changes()).unwrap();
    block_on(several.track_changes()).unwrap();
    block_on(Engine::lock(&mut cpu, locked.to_vec())).unwrap();
    block_on(several.lock(locked.to_vec())).unwrap();
    for (rounds, gpu) in &mut gpus {
        block_on(gpu.track_changes()).unwrap();
        block_on(gpu.lock(locked.to_vec())).unwrap();
        gpu.set_wide_rounds(*rounds);
    }
    let (mut flips, mut turned_back) = (engines(&mesh, any_deviation(180.0)).0, 0);
    for (frame, positions) in frames.iter().enumerate() {
        let what = format!("{what}, frame {frame}");
        let iterations = [3, 0, 64][frame % 3];
        let positions = || Some(positions.clone().into());
        cpu.update(positions(), iterations, true).unwrap();
        check(&what, &mesh, &cpu);
        let (expected, changes) = (block_on(cpu.moved()).unwrap(), block_on(cpu.changes()).unwrap());
        several.update(positions(), iterations, true).unwrap();
        assert_same(&what, &cpu.triangles, &block_on(Engine::triangles(&mut several)).unwrap());
        assert_same(&what, &changes, &block_on(several.changes()).unwrap());
        for (rounds, gpu) in &mut gpus {
            let what = format!("{what}, {rounds} rounds");
            gpu.update(positions(), iterations, true).unwrap();
            assert_same(&what, &cpu.triangles, &block_on(Engine::triangles(gpu)).unwrap());
            assert_same(&what, &cpu.twins, &block_on(Engine::twins(gpu)).unwrap());
            assert_same(&what, &changes, &block_on(gpu.changes()).unwrap());
            assert_same(&what, &cpu.fans.table, &block_on(gpu.fans()).unwrap());
            assert_eq!(expected, block_on(gpu.moved()).unwrap(), "{what}");
        }
        // What flips do alone, from the same triangles.
        flips.update(positions(), iterations, false).unwrap();
        let more = block_on(flips.areas()).unwrap().inverted.saturating_sub(expected.areas.inverted);
        turned_back += more as usize;
        let now = Mesh::new(Dimension::Two, mesh.positions().clone(), cpu.triangles.clone()).unwrap();
        flips = Cpu::new(Arc::new(now), any_deviation(180.0), Threads::default());
    }
    assert!(turned_back > 0, "{what}: nothing was turned over");
}

/// Frames whose vertices move by a little, by much, and beyond the boundary.
fn frames(mesh: &Mesh, count: u32, length: f32, steps: f32) -> Vec<Vec<f32>> {
    let is_inner = inner(mesh, &Adjacency::new(mesh).twins);
    let by = [0.3, 0.0, 1.0, 0.5, 3.0, 0.1, 0.0, 30.0];
    (0..count)
        .map(|seed| moved(mesh, &is_inner, seed, length * by[seed as usize % by.len()], steps))
        .collect()
}

#[test]
fn rounds_are_the_same_in_every_kernel() {
    let mesh = families::by_name("random 16").unwrap();
    compare("random", &mesh, &[], &[0, 1, 15, 16, 22, 30], &frames(&mesh, 24, 0.06, 0.0));
    compare("lattice", &mesh, &[], &[0, 30], &frames(&mesh, 24, 0.06, 64.0));
}

#[test]
fn two_windings_and_locked_edges_untangle_alike() {
    let sheet = families::by_name("random 14").unwrap();
    let turned = sheet.triangles().chunks(3).flat_map(|t| [t[0], t[2], t[1]]);
    let count = sheet.vertex_count() as u32;
    let triangles = sheet.triangles().iter().copied().chain(turned.map(|v| v + count)).collect();
    let positions = sheet.positions().to_f32().repeat(2);
    let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
    let twins = Adjacency::new(&mesh).twins;
    let locked: Vec<u32> = (0..twins.len() as u32)
        .step_by(41)
        .filter(|&h| twins[h as usize] != NONE)
        .flat_map(|h| [h, twins[h as usize]])
        .collect();
    compare("two windings", &mesh, &locked, &[0, 2, 30], &frames(&mesh, 16, 0.06, 0.0));
}

/// Numbers that are not finite, for some frames.
#[test]
fn infinite_numbers_are_left_alone() {
    let mesh = families::by_name("random 16").unwrap();
    let mut frames = frames(&mesh, 20, 0.06, 0.0);
    for (frame, positions) in frames.iter_mut().enumerate().skip(3).step_by(2) {
        for i in 0..4 {
            positions[(97 * frame + 61 * i) % 400] = [f32::NAN, f32::INFINITY][i % 2];
        }
    }
    compare("infinite", &mesh, &[], &[0, 30], &frames);
}

/// Sheets that share a vertex, which has several fans, and meshes of few triangles.
#[test]
fn fans_and_small_meshes_untangle_alike() {
    let sheet = families::by_name("random 6").unwrap();
    let count = sheet.vertex_count() as u32;
    let corner = sheet.triangles()[0];
    let at = |v: u32, k: usize| sheet.positions().to_f32()[2 * v as usize + k];
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    for (n, [x, y]) in [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].into_iter().enumerate() {
        for v in 0..count {
            let [p, q] = [at(v, 0) - at(corner, 0), at(v, 1) - at(corner, 1)];
            positions.extend([p * x - q * y, p * y + q * x]);
        }
        triangles.extend(
            sheet.triangles().iter().map(|&v| if v == corner { corner } else { v + n as u32 * count }),
        );
    }
    let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
    compare("fans", &mesh, &[], &[0, 30], &frames(&mesh, 24, 0.2, 0.0));
    let square = [0.0f32, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0, 1.0, 1.0, 3.0, 2.0];
    let triangles = vec![0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 5, 0, 4, 5, 4, 3, 5];
    let mesh = Mesh::new(Dimension::Two, square.to_vec(), triangles).unwrap();
    compare("square", &mesh, &[], &[0, 30], &frames(&mesh, 24, 2.0, 0.0));
}

/// A chain of vertices between two that have thousands of triangles each: to find out whether an edge joins these takes
/// long, and a driver that ends loops early must not end this one.
#[test]
fn a_chain_between_two_large_stars_untangles_alike() {
    let count = 19_000;
    let place = |i: u32| [i as f32, 0.0];
    let positions = (0..count).flat_map(place).chain([9500.0, 4000.0, 9500.0, -4000.0]).collect::<Vec<_>>();
    let triangles = (1..count).flat_map(|i| [i - 1, i, count, i, i - 1, count + 1]).collect();
    let mesh = Mesh::new(Dimension::Two, positions.clone(), triangles).unwrap();
    let frames: Vec<_> = (0..2)
        .map(|frame| {
            let mut moved = positions.clone();
            for i in 1..count - 1 {
                moved[2 * i as usize] += 1.5 * random(frame, i);
            }
            moved
        })
        .collect();
    compare("chain", &mesh, &[], &[30], &frames);
}

/// The rounds end also if all vertices go far out to one side, where all of them wait for the same triangles.
#[test]
fn vertices_far_outside_come_back() {
    let mesh = families::by_name("random 40").unwrap();
    let is_inner = inner(&mesh, &Adjacency::new(&mesh).twins);
    let mut cpu = Cpu::new(Arc::new(mesh.clone()), any_deviation(180.0), Threads::default());
    for frame in 0..6 {
        let mut positions = mesh.positions().to_f32();
        for (v, point) in positions.chunks_mut(2).enumerate().filter(|(v, _)| is_inner[*v]) {
            if frame % 2 == 0 && !key(v as u32, frame).is_multiple_of(3) {
                point[0] += 1000.0 + random(frame, v as u32);
                point[1] += 100.0 * random(frame + 1, v as u32);
            }
        }
        cpu.update(Some(positions.into()), 8, true).unwrap();
        check(&format!("frame {frame}"), &mesh, &cpu);
    }
    cpu.update(Some(mesh.positions().clone()), 64, true).unwrap();
}

proptest! {
    /// Few vertices make nearly all edges non-manifold, many make nearly all boundary. Triangles may repeat a corner.
    #[test]
    fn any_triangles_keep_their_edges(
        corners in (3u32..40).prop_flat_map(|vertices| prop::collection::vec(0..vertices, 0..150)),
        frames in prop::collection::vec((prop::collection::vec(-9i8..10, 80), 0u32..4), 1..6),
    ) {
        let positions = |numbers: &[i8]| numbers.iter().map(|&x| f32::from(x)).collect::<Vec<_>>();
        let triangles = corners[..corners.len() / 3 * 3].to_vec();
        let mesh = Mesh::new(Dimension::Two, positions(&frames[0].0), triangles).unwrap();
        let mut cpu = Cpu::new(Arc::new(mesh.clone()), any_deviation(180.0), Threads::default());
        for (numbers, iterations) in &frames {
            cpu.update(Some(positions(numbers).into()), *iterations, true).unwrap();
            check("any triangles", &mesh, &cpu);
        }
    }
}
