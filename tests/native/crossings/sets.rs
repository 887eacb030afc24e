//! Random sets of lines that cross, of several kinds.

use edgeflip::{Dimension, Mesh, Positions, triangulate};
use oorandom::Rand64;
use std::collections::BTreeMap;

/// A random set of lines that cross, and a mesh with their ends.
pub fn random_set(seed: u64) -> (Mesh, Vec<[u32; 2]>) {
    let mut random = Rand64::new(seed.into());
    let most = if seed % 10 == 9 { 500 } else { 60 };
    let count = 2 + random.rand_range(0..most) as usize;
    let kind = seed % 6;
    let is_single = seed / 6 % 2 == 1;
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut lines: Vec<[u32; 2]> = Vec::new();
    let round = |x: f64| if is_single { f64::from(x as f32) } else { x };
    let step = |x: f64, n: i64| {
        if is_single {
            f64::from(f32::from_bits((x as f32).to_bits().wrapping_add_signed(n as i32)))
        } else {
            f64::from_bits(x.to_bits().wrapping_add_signed(n))
        }
    };
    let ulps = |n: i64, random: &mut Rand64| random.rand_range(0..(2 * n + 1) as u64) as i64 - n;
    match kind {
        // Anywhere.
        0 => {
            points = (0..2 * count).map(|_| [random.rand_float(), random.rand_float()].map(round)).collect();
            lines = (0..count as u32).map(|i| [2 * i, 2 * i + 1]).collect();
        }
        // A lattice: lines overlap, and three meet in a point.
        1 | 2 => {
            let size = 4 + random.rand_range(0..12);
            let scale = if kind == 1 { 1.0 } else { 0.1 };
            let turn = if kind == 1 { 0.0 } else { random.rand_float() };
            let (sin, cos) = turn.sin_cos();
            for i in 0..size * size {
                let [x, y] = [i % size, i / size].map(|k| k as f64 * scale);
                points.push([cos * x - sin * y + 7.0, sin * x + cos * y + 7.0].map(round));
            }
            let mut vertex = || random.rand_range(0..size * size) as u32;
            lines = (0..count).map(|_| [vertex(), vertex()]).collect();
        }
        // Nearly parallel: ends differ by a few units in the last place.
        3 => {
            for _ in 0..count {
                let from = [round(1.0 + 0.1 * random.rand_float()), step(1.5, ulps(9, &mut random))];
                let to = [round(1.8 + 0.1 * random.rand_float()), step(1.5, ulps(9, &mut random))];
                lines.push([points.len() as u32, points.len() as u32 + 1]);
                points.extend([from, to]);
            }
        }
        // Vertices next to crossings.
        4 => {
            points = (0..2 * count)
                .map(|_| [random.rand_float() + 1.0, random.rand_float() + 1.0].map(round))
                .collect();
            lines = (0..count as u32).map(|i| [2 * i, 2 * i + 1]).collect();
            let at = |i: u32| points[i as usize];
            let mut more = Vec::new();
            for (i, &[a, b]) in lines.iter().enumerate().take(40) {
                for &[c, d] in &lines[..i] {
                    let [[px, py], [qx, qy]] =
                        [[a, b], [c, d]].map(|[u, v]| [at(v)[0] - at(u)[0], at(v)[1] - at(u)[1]]);
                    let w = [at(c)[0] - at(a)[0], at(c)[1] - at(a)[1]];
                    let t = (w[0] * qy - w[1] * qx) / (px * qy - py * qx);
                    let s = (w[0] * py - w[1] * px) / (px * qy - py * qx);
                    if (0.0..1.0).contains(&t) && (0.0..1.0).contains(&s) && random.rand_range(0..2) == 0 {
                        let near = [at(a)[0] + t * px, at(a)[1] + t * py].map(round);
                        more.push(near.map(|x| step(x, ulps(2, &mut random))));
                    }
                }
            }
            points.extend(more);
        }
        // Nearly through one point.
        _ => {
            for i in 0..count {
                let angle = i as f64 / count as f64 * 3.1 + 0.01;
                let (sin, cos) = angle.sin_cos();
                let from = [cos + 3.0, sin + 3.0].map(round);
                let to = [3.0 - cos, 3.0 - sin].map(round).map(|x| step(x, ulps(1, &mut random)));
                lines.push([points.len() as u32, points.len() as u32 + 1]);
                points.extend([from, to]);
            }
        }
    }
    // The corners of a box, and more vertices.
    points.extend([[-20.0, -20.0], [30.0, -20.0], [30.0, 30.0], [-20.0, 30.0]]);
    points.extend((0..count / 2).map(|_| [4.0 * random.rand_float(), 4.0 * random.rand_float()].map(round)));
    let made = triangulate(&Positions::from(points.concat())).unwrap();
    // Each point has one vertex.
    let first: BTreeMap<u32, u32> = made.duplicates.iter().map(|&[copy, first]| (copy, first)).collect();
    let lines = lines.into_iter().map(|ends| ends.map(|v| first.get(&v).copied().unwrap_or(v)));
    let lines: Vec<_> = lines.filter(|[u, v]| u != v).collect();
    (Mesh::new(Dimension::Two, points.concat(), made.triangles).unwrap(), lines)
}
