//! Families in the plane. Every triangle is counter-clockwise, except some in a large [`fan2`].

use super::lattice::{at_least, fits, generator, signed, split, split_cells, turn};
use crate::{Dimension, Error, Mesh, NONE};
use oorandom::Rand64;

/// `n` x `n` points of a jittered lattice in the unit square, each cell split along a random diagonal.
///
/// # Errors
/// [`Error::Option`] for n < 2, [`Error::TooLarge`].
pub fn grid(n: usize, seed: u64) -> Result<Mesh, Error> {
    sheared(n, 0.0, &mut generator(seed), "grid")
}

/// [`grid`] after random flips: `k` tries per edge of the mesh. A try takes a random edge, and flips it if its quad is
/// strictly convex. The result is far from Delaunay everywhere.
///
/// # Errors
/// [`Error::Option`] for n < 2, [`Error::TooLarge`].
pub fn random(n: usize, k: f64, seed: u64) -> Result<Mesh, Error> {
    let mut random = generator(seed);
    let mesh = sheared(n, 0.0, &mut random, "random")?;
    let (positions, mut triangles) = (mesh.positions().to_f32(), mesh.triangles().to_vec());
    let mut twins = twins(&triangles, mesh.vertex_count());
    let tries = (k * triangles.len() as f64 / 2.0) as u64;
    for _ in 0..tries {
        let h = random.rand_range(0..triangles.len() as u64) as usize;
        flip_if_convex(&positions, &mut triangles, &mut twins, h);
    }
    mesh.with_triangles(triangles)
}

/// [`grid`] with x moved by `s`·y: every triangle is long and thin.
///
/// # Errors
/// [`Error::Option`] for n < 2, [`Error::TooLarge`].
pub fn shear(n: usize, s: f64, seed: u64) -> Result<Mesh, Error> {
    sheared(n, s, &mut generator(seed), "shear")
}

fn sheared(n: usize, s: f64, random: &mut Rand64, family: &str) -> Result<Mesh, Error> {
    at_least(2, n, family)?;
    fits(n.saturating_mul(n), (n - 1).saturating_mul(n - 1).saturating_mul(2))?;
    let mut positions = Vec::with_capacity(2 * n * n);
    for j in 0..n {
        for i in 0..n {
            let mut jittered = |line: usize| {
                let offset = 0.25 * signed(random);
                (line as f64 + if line == 0 || line == n - 1 { 0.0 } else { offset }) / n as f64
            };
            let (x, y) = (jittered(i), jittered(j));
            positions.extend([(x + s * y) as f32, y as f32]);
        }
    }
    let triangles = split_cells(&positions, 2, n, n, random);
    Mesh::new(Dimension::Two, positions, triangles)
}

/// `n` x `n` points of a lattice of spacing 0.1 that begins at (`offset`, `offset`), random diagonals:
/// every quad is cocircular, exactly.
///
/// # Errors
/// [`Error::Option`] for n < 2, [`Error::TooLarge`], [`Error::NonFinite`] for an offset beyond f32.
pub fn regular(n: usize, offset: f64, seed: u64) -> Result<Mesh, Error> {
    at_least(2, n, "regular")?;
    fits(n.saturating_mul(n), (n - 1).saturating_mul(n - 1).saturating_mul(2))?;
    let at = |line: usize| (0.1 * line as f64 + offset) as f32;
    let positions: Vec<f32> = (0..n).flat_map(|j| (0..n).flat_map(move |i| [at(i), at(j)])).collect();
    let mut random = generator(seed);
    let mut triangles = Vec::with_capacity(6 * (n - 1) * (n - 1));
    for j in 0..n - 1 {
        for i in 0..n - 1 {
            let p = (j * n + i) as u32;
            let n = n as u32;
            split(&mut triangles, [p, p + 1, p + n + 1, p + n], random.rand_float() < 0.5);
        }
    }
    Mesh::new(Dimension::Two, positions, triangles)
}

/// The worst case of the paper's figure 11: two rows of `n`/2 points, which need (n/2 - 1)² flips.
/// All coordinates are small integers.
///
/// ```text
///         p0--p1--p2--p3        triangles (q0, p_i+1, p_i) and (q_j, q_j+1, p_last):
///       .  . .  ' . '/          every edge between the rows ends in q0 or in the last p
///    .  .. '  .'  . /
///   q0--q1--q2--q3
/// ```
///
/// # Errors
/// [`Error::Option`] for an odd n or n < 4, [`Error::TooLarge`].
pub fn strips(n: usize) -> Result<Mesh, Error> {
    at_least(4, n, "strips")?;
    if n % 2 == 1 {
        return Err(Error::Option { option: "family", message: format!("strips {n}: n must be even") });
    }
    fits(n, n)?;
    let m = n / 2;
    let mut positions: Vec<f32> = (0..m).flat_map(|j| [j as f32, 0.0]).collect();
    positions.extend((0..m).flat_map(|i| [(m + i) as f32, m as f32]));
    let (m, last) = (m as u32, n as u32 - 1);
    let mut triangles: Vec<u32> = (0..m - 1).flat_map(|i| [0, m + i + 1, m + i]).collect();
    triangles.extend((0..m - 1).flat_map(|j| [j, j + 1, last]));
    Mesh::new(Dimension::Two, positions, triangles)
}

/// `n` points on a parabola, all joined to the last: nearly collinear slivers, hundreds of iterations.
/// Beyond n = 1000 the rounding to f32 makes some triangles negative.
///
/// # Errors
/// [`Error::Option`] for n < 3, [`Error::TooLarge`].
pub fn fan2(n: usize) -> Result<Mesh, Error> {
    at_least(3, n, "fan2")?;
    fits(n, n)?;
    let positions = (0..n).flat_map(|i| {
        let x = i as f64 / n as f64;
        [x as f32, (x * x) as f32]
    });
    let triangles = (0..n as u32 - 2).flat_map(|i| [i, i + 1, n as u32 - 1]);
    Mesh::new(Dimension::Two, positions.collect::<Vec<f32>>(), triangles.collect())
}

/// `n` distinct random points in the unit square, triangulated from left to right: each point is joined to the edges
/// that it sees of the hull of the earlier points. There are slivers as long as the mesh is wide.
///
/// # Errors
/// [`Error::Option`] for n < 3, [`Error::TooLarge`].
pub fn sweep(n: usize, seed: u64) -> Result<Mesh, Error> {
    at_least(3, n, "sweep")?;
    fits(n, n.saturating_mul(2))?;
    let mut random = generator(seed);
    let mut points: Vec<[f32; 2]> = Vec::with_capacity(n);
    while points.len() < n {
        points.resize_with(n, || [random.rand_float() as f32, random.rand_float() as f32]);
        points.sort_unstable_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
        points.dedup();
    }
    let positions = points.concat();
    let triangles = sweep_triangles(&positions);
    Mesh::new(Dimension::Two, positions, triangles)
}

/// The triangles of [`sweep`] for distinct points in the order of x, then y. `upper` and `lower` run along the hull
/// from the first point to the latest. While all points so far are collinear, both are the whole row of points. The
/// first point off this line sees the row from one side.
fn sweep_triangles(positions: &[f32]) -> Vec<u32> {
    let mut triangles = Vec::with_capacity(3 * positions.len());
    let mut upper: Vec<u32> = Vec::new();
    let mut lower: Vec<u32> = Vec::new();
    for p in 0..(positions.len() / 2) as u32 {
        while let [.., a, b] = upper[..] {
            if turn(positions, 2, a, b, p) <= 0.0 {
                break;
            }
            triangles.extend([a, b, p]);
            upper.pop();
        }
        while let [.., a, b] = lower[..] {
            if turn(positions, 2, a, b, p) >= 0.0 {
                break;
            }
            triangles.extend([b, a, p]);
            lower.pop();
        }
        upper.push(p);
        lower.push(p);
    }
    triangles
}

/// The half-edges before and after `h` in its triangle.
fn prev_next(h: usize) -> (usize, usize) {
    let t = h - h % 3;
    (t + (h + 2) % 3, t + (h + 1) % 3)
}

/// The twin of every half-edge of a manifold mesh of low valence.
fn twins(triangles: &[u32], vertices: usize) -> Vec<u32> {
    let ends = |h: usize| (triangles[h], triangles[if h % 3 == 2 { h - 2 } else { h + 1 }]);
    let lower = |h: usize| ends(h).0.min(ends(h).1) as usize;
    let mut end_of = vec![0u32; vertices + 1];
    for h in 0..triangles.len() {
        end_of[lower(h) + 1] += 1;
    }
    for v in 0..vertices {
        end_of[v + 1] += end_of[v];
    }
    let first_of = end_of.clone();
    let mut around = vec![0u32; triangles.len()];
    for h in 0..triangles.len() {
        let end = &mut end_of[lower(h)];
        around[*end as usize] = h as u32;
        *end += 1;
    }
    (0..triangles.len())
        .map(|h| {
            let (from, to) = ends(h);
            let v = lower(h);
            let bucket = &around[first_of[v] as usize..first_of[v + 1] as usize];
            bucket.iter().copied().find(|&g| ends(g as usize) == (to, from)).unwrap_or(NONE)
        })
        .collect()
}

/// Flips the edge of `h` when both new triangles are strictly positive.
fn flip_if_convex(positions: &[f32], triangles: &mut [u32], twins: &mut [u32], h: usize) {
    if twins[h] == NONE {
        return;
    }
    let g = twins[h] as usize;
    let ((h_prev, h_next), (g_prev, g_next)) = (prev_next(h), prev_next(g));
    let [a, b, c, d] = [h, g, h_prev, g_prev].map(|x| triangles[x]);
    if turn(positions, 2, a, d, c) <= 0.0 || turn(positions, 2, b, c, d) <= 0.0 {
        return;
    }
    let (across_bc, across_ad) = (twins[h_next], twins[g_next]);
    triangles[h_next] = d;
    triangles[g_next] = c;
    let mut join = |x: usize, y: u32| {
        twins[x] = y;
        if y != NONE {
            twins[y as usize] = x as u32;
        }
    };
    join(h_next, g_next as u32);
    join(h, across_ad);
    join(g, across_bc);
}
