//! Compares results in the plane with Delaunay triangulations of the same points by another crate: equal up to ties.
#![cfg(feature = "gpu")]

use delaunator::{Point, triangulate};
use edgeflip::{Adjacency, Backend, Dimension, Mesh, NONE, Options, Order, families, make_delaunay};
use oorandom::Rand64;
use std::collections::HashSet;
use std::ops::ControlFlow;

fn coord(mesh: &Mesh, v: u32) -> robust::Coord<f64> {
    let mut numbers = mesh.positions().iter().skip(2 * v as usize);
    robust::Coord { x: numbers.next().unwrap(), y: numbers.next().unwrap() }
}

/// Counter-clockwise Delaunay triangles of the mesh's points.
fn delaunay(positions: &[f32]) -> Vec<u32> {
    let points: Vec<_> =
        positions.chunks(2).map(|p| Point { x: f64::from(p[0]), y: f64::from(p[1]) }).collect();
    let triangles = triangulate(&points).triangles;
    // The crate's y axis points down.
    triangles.chunks(3).flat_map(|t| [t[0], t[2], t[1]]).map(|v| v as u32).collect()
}

fn edges(triangles: &[u32]) -> HashSet<(u32, u32)> {
    let sides = |t: &[u32]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    triangles.chunks(3).flat_map(sides).map(|(u, v)| (u.min(v), u.max(v))).collect()
}

/// Flips random edges of convex quads: the same points, far from Delaunay.
fn scrambled(mesh: &Mesh, random: &mut Rand64) -> Mesh {
    let mut triangles = mesh.triangles().to_vec();
    for _ in 0..triangles.len() {
        let twins = Adjacency::new(&mesh.with_triangles(triangles.clone()).unwrap()).twins;
        let h = random.rand_range(0..triangles.len() as u64) as usize;
        let next = |h: usize| if h % 3 == 2 { h - 2 } else { h + 1 };
        let g = twins[h] as usize;
        if twins[h] == NONE {
            continue;
        }
        let [c, d] = [next(next(h)), next(next(g))].map(|x| triangles[x]);
        let turn = |a, b, c| robust::orient2d(coord(mesh, a), coord(mesh, b), coord(mesh, c));
        if turn(triangles[h], d, c) > 0.0 && turn(triangles[g], c, d) > 0.0 {
            triangles[next(h)] = d;
            triangles[next(g)] = c;
        }
    }
    mesh.with_triangles(triangles).unwrap()
}

/// Asserts that every edge that only one of the two triangulations has is a diagonal of four cocircular points.
fn assert_equal_up_to_ties(mesh: &Mesh, options: &Options) {
    let result = make_delaunay(mesh, options, |_, _| ControlFlow::Continue(())).unwrap().triangles;
    let expected = edges(&delaunay(&mesh.positions().to_f32()));
    assert_eq!(edges(&result).len(), expected.len());
    let twins = Adjacency::new(&mesh.with_triangles(result.clone()).unwrap()).twins;
    for (h, &g) in twins.iter().enumerate() {
        let corner = |h: usize, k: usize| result[h / 3 * 3 + (h + k) % 3];
        let (a, b) = (corner(h, 0), corner(h, 1));
        if !expected.contains(&(a.min(b), a.max(b))) {
            assert_ne!(g, NONE, "boundary edge {a}-{b}");
            let [a, b, c, d] = [a, b, corner(h, 2), corner(g as usize, 2)].map(|v| coord(mesh, v));
            assert_eq!(robust::incircle(a, b, c, d), 0.0);
        }
    }
}

fn all_ways(mesh: &Mesh) {
    let cpu = Options { backend: Backend::Cpu, ..Options::default() };
    assert_equal_up_to_ties(mesh, &cpu);
    assert_equal_up_to_ties(mesh, &Options { order: Order::Any, ..cpu });
    if mesh.triangle_count() < 3000 {
        assert_equal_up_to_ties(mesh, &Options { backend: Backend::Gpu, ..Options::default() });
    }
}

#[test]
fn random_points() {
    for spec in ["sweep 30", "sweep 1000", "sweep 50000"] {
        all_ways(&families::by_name(spec).unwrap());
    }
}

/// Some points of a lattice: many are cocircular or collinear.
#[test]
fn points_of_a_lattice() {
    for seed in 0..12 {
        let mut random = Rand64::new(seed);
        let n = 4 + seed as u32;
        let keep = (0..n * n).filter(|_| random.rand_float() < 0.8).collect::<Vec<_>>();
        // With a step of a power of two, the points are exactly cocircular. With a step of 0.1, they are cocircular up
        // to one ulp.
        let step = if seed % 2 == 0 { 0.125 } else { 0.1 };
        let positions: Vec<f32> =
            keep.iter().flat_map(|i| [(i % n) as f32 * step, (i / n) as f32 * step]).collect();
        let triangles = delaunay(&positions);
        let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
        all_ways(&scrambled(&mesh, &mut random));
    }
}
