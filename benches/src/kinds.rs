//! Delaunay meshes whose edges are decided by different tiers of the predicates, for `tiers.rs` and for the unit test
//! that counts these edges.

use super::{Backend, Dimension, Error, Mesh, Options, families, make_delaunay};
use oorandom::Rand64;
use std::ops::ControlFlow;

/// The meshes with their names; each has about `n` x `n` points.
pub fn kinds(n: usize) -> Result<Vec<(&'static str, Mesh)>, Error> {
    let lattice = families::regular(n, 0.0, 1)?;
    let far = families::regular(n, 1e5, 1)?;
    let mut random = Rand64::new(1);
    // 0 stays, because its neighbour is 2^-149.
    let noise = |x: f32| if x > 0.0 && random.rand_range(0..2) == 1 { x.next_up() } else { x };
    let noisy: Vec<f32> = lattice.positions().to_f32().into_iter().map(noise).collect();
    let noisy = Mesh::new(Dimension::Two, noisy, lattice.triangles().to_vec())?;
    let lines = |low: f64, high: f64| {
        let at = |line: usize| libm::exp2(low + (high - low) * line as f64 / n as f64);
        let positions: Vec<f64> = (0..n * n).flat_map(|v| [at(v % n), at(v / n)]).collect();
        Mesh::new(Dimension::Two, positions, lattice.triangles().to_vec())
    };
    // As 32-bit floats, the coordinates span 84 bits, which the GPU accepts.
    let mixed = lines(0.0, 60.0)?;
    let mixed = Mesh::new(Dimension::Two, mixed.positions().to_f32(), mixed.triangles().to_vec())?;
    let far_apart = lines(-200.0, 200.0)?;
    let noise = |x: f64| if random.rand_range(0..2) == 1 { x.next_up() } else { x };
    let noisy_far_apart: Vec<f64> = far_apart.positions().iter().map(noise).collect();
    let far_apart = Mesh::new(Dimension::Two, noisy_far_apart, lattice.triangles().to_vec())?;
    let [lattice_in_space, far_in_space, noisy_in_space] = [&lattice, &far, &noisy].map(lifted);
    let turned: Vec<f32> = (0..n * n).flat_map(|v| turned((v % n) as f32, (v / n) as f32)).collect();
    let turned = Mesh::new(Dimension::Two, turned, lattice.triangles().to_vec())?;
    let kinds = [
        ("random", families::random(n, 2.0, 1)?),
        ("jittered lattice", families::grid(n, 1)?),
        ("lattice of spacing 0.1", lattice),
        ("lattice at (100000, 100000)", far),
        ("turned lattice", turned),
        ("lattice with one-ulp noise", noisy),
        ("lattice, lines from 1 to 2^60", mixed),
        ("lattice with one-ulp noise, 64-bit lines from 2^-200 to 2^200", far_apart),
        ("uvsphere", families::uvsphere(n, 0.05, 1)?),
        ("lattice of spacing 0.1 in space", lattice_in_space?),
        ("lattice at (100000, 100000, 100000)", far_in_space?),
        ("lattice with one-ulp noise in space", noisy_in_space?),
    ];
    kinds.into_iter().map(|(name, mesh)| Ok((name, delaunay(&mesh)?))).collect()
}

/// A point of a lattice whose squares have no side along an axis.
fn turned(x: f32, y: f32) -> [f32; 2] {
    [3.0 * x - y, x + 3.0 * y]
}

/// Maps the points (x, y) to (x, y, y). The corners of the lattice's rectangles stay cocircular.
fn lifted(mesh: &Mesh) -> Result<Mesh, Error> {
    let positions = mesh.positions().to_f32();
    let lifted: Vec<f32> = positions.chunks_exact(2).flat_map(|p| [p[0], p[1], p[1]]).collect();
    Mesh::new(Dimension::Three, lifted, mesh.triangles().to_vec())
}

fn delaunay(mesh: &Mesh) -> Result<Mesh, Error> {
    let options = Options { backend: Backend::Cpu, ..Options::default() };
    let outcome = make_delaunay(mesh, &options, |_, _| ControlFlow::Continue(()))?;
    mesh.with_triangles(outcome.triangles)
}
