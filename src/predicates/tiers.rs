//! Counts the edges that each tier decides: `cargo test --lib tiers -- --nocapture`. `src/engine/tests/mod.rs` does the
//! same on a GPU, and `cargo bench -p benches --bench tiers` measures the times.

use super::exact::{COUNT, WIDEST};
use super::{Quad, in_circle_sign, plane, space};
use crate::mesh::half_edge::prev;
use crate::{Adjacency, Backend, Dimension, Error, Mesh, NONE, Options, families, make_delaunay};

#[path = "../../benches/src/kinds.rs"]
pub(crate) mod kinds;

/// How many decisions of `work` need integers.
pub(crate) fn exact_decisions(work: impl FnOnce()) -> usize {
    let before = COUNT.get();
    work();
    COUNT.get() - before
}

/// The numbers of interior edges by the tier that decides them: the filter or right angles, narrow, wide or unbounded
/// integers. In space there is no wide tier.
fn tiers(mesh: &Mesh) -> [usize; 4] {
    let mut counts = [0; 4];
    for (h, &g) in Adjacency::new(mesh).twins.iter().enumerate() {
        let h = h as u32;
        if g == NONE || g < h {
            continue;
        }
        let [a, b, c, d] = [h, g, prev(h), prev(g)].map(|corner| mesh.triangles()[corner as usize]);
        WIDEST.set(0);
        let [narrow, wide] = match mesh.dimension() {
            Dimension::Two => {
                let [a, b, c, d] = mesh.positions().points2([a, b, c, d]);
                in_circle_sign(a, b, c, d);
                [plane::NARROW_BITS, plane::WIDE_BITS]
            }
            Dimension::Three => {
                let [a, b, c, d] = mesh.positions().points3([a, b, c, d]);
                Quad::new(a, b, c, d).is_non_delaunay();
                [space::BITS, space::BITS]
            }
        };
        counts[[0, narrow, wide].iter().filter(|&&bits| WIDEST.get() > bits).count()] += 1;
    }
    counts
}

#[test]
fn every_tier_decides_some_edges() -> Result<(), Error> {
    const N: usize = 100;
    println!("| mesh | interior edges | filter | narrow | wide | any |\n|---|---:|---:|---:|---:|---:|");
    let mut sums = [0; 4];
    for (name, mesh) in kinds::kinds(N)? {
        let counts = tiers(&mesh);
        let [filter, narrow, wide, any] = counts;
        println!("| {name} | {} | {filter} | {narrow} | {wide} | {any} |", counts.iter().sum::<usize>());
        if name.starts_with("lattice of") || name.starts_with("lattice at") {
            assert_eq!(narrow + wide + any, 0, "{name}: its ties have right angles");
        }
        if name == "turned lattice" {
            assert!(narrow + wide + any >= (N - 1) * (N - 1), "{name}: its diagonals are ties");
        }
        sums = std::array::from_fn(|tier| sums[tier] + counts[tier]);
    }
    assert!(sums.iter().all(|&count| count > 0), "{sums:?}");
    Ok(())
}
