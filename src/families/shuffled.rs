//! Meshes in random order, as from scattered points.

use super::lattice::generator;
use crate::{Mesh, Positions};
use oorandom::Rand64;

/// The same mesh with its vertices and triangles in random order. Each triangle keeps its first corner.
pub fn shuffled(mesh: &Mesh, seed: u64) -> Mesh {
    let mut random = generator(seed);
    let vertices = order(mesh.vertex_count(), &mut random);
    let stride = mesh.dimension().stride();
    let numbers = || vertices.iter().flat_map(|&v| stride * v as usize..stride * (v as usize + 1));
    let positions = match mesh.positions() {
        Positions::F32(all) => Positions::F32(numbers().map(|i| all[i]).collect()),
        Positions::F64(all) => Positions::F64(numbers().map(|i| all[i]).collect()),
    };
    let mut places = vec![0; vertices.len()];
    (0..).zip(&vertices).for_each(|(place, &v)| places[v as usize] = place);
    let corner = |h: usize| places[mesh.triangles()[h] as usize];
    let triangles = order(mesh.triangle_count(), &mut random);
    let triangles =
        triangles.iter().flat_map(|&t| 3 * t as usize..3 * (t as usize + 1)).map(corner).collect();
    mesh.reordered(positions, triangles)
}

/// The numbers below `count` in random order.
fn order(count: usize, random: &mut Rand64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    for i in (1..count).rev() {
        order.swap(i, random.rand_range(0..i as u64 + 1) as usize);
    }
    order
}
