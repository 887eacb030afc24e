//! Constraints with a tolerance.

use super::*;
use crate::triangulate;

/// Points with whole coordinates, and what should become of constraints between them, by integers.
struct Expected {
    points: Vec<[i64; 2]>,
    tolerance: i64,
}

fn minus(p: [i64; 2], q: [i64; 2]) -> [i64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

fn dot(p: [i64; 2], q: [i64; 2]) -> i64 {
    p[0] * q[0] + p[1] * q[1]
}

fn cross_product(p: [i64; 2], q: [i64; 2]) -> i64 {
    p[0] * q[1] - p[1] * q[0]
}

impl Expected {
    fn at(&self, v: u32) -> [i64; 2] {
        self.points[v as usize]
    }

    /// The vertices that a constraint goes through.
    fn chain(&self, [from, to]: Pair) -> Vec<u32> {
        let along = minus(self.at(to), self.at(from));
        let square = dot(along, along);
        let place = |v: u32| {
            let offset = minus(self.at(v), self.at(from));
            (dot(along, offset), cross_product(along, offset))
        };
        let is_near = |(at, across): (i64, i64)| {
            0 < at && at < square && across.pow(2) <= self.tolerance.pow(2) * square
        };
        let mut inside: Vec<u32> = (0..self.points.len() as u32).filter(|&v| is_near(place(v))).collect();
        inside.sort_by_key(|&v| place(v));
        [&[from], inside.as_slice(), &[to]].concat()
    }

    fn cross(&self, [a, b]: Pair, [c, d]: Pair) -> bool {
        let side = |[u, v]: Pair, w: u32| {
            cross_product(minus(self.at(v), self.at(u)), minus(self.at(w), self.at(u))).signum()
        };
        side([a, b], c) * side([a, b], d) < 0 && side([c, d], a) * side([c, d], b) < 0
    }
}

#[test]
fn near_vertices_are_on_the_way() {
    let mut random = Rand64::new(3);
    let (mut through, mut skipped) = (0, 0);
    for round in 0..400 {
        let mut below = |n: u64| random.rand_range(0..n);
        let (size, tolerance) = (10 + below(60), below(5) as i64);
        let mut points: Vec<[i64; 2]> =
            (0..4 + below(60)).map(|_| [below(size) as i64, below(size / 3) as i64]).collect();
        points.sort_unstable();
        points.dedup();
        let count = points.len() as u64;
        let positions: Vec<f64> = points.concat().into_iter().map(|x| x as f64).collect();
        let expected = Expected { points, tolerance };
        let triangles = triangulate(&positions.clone().into()).unwrap().triangles;
        let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
        let mut pairs = || {
            let pairs = (0..8).map(|_| [below(count) as u32, below(count) as u32]);
            pairs.filter(|[u, v]| u != v).collect::<Vec<_>>()
        };
        // The triangles in between must not matter.
        let mesh = constrained(&mesh, &pairs(), &[], true, 0.0, None).unwrap().mesh;
        let constraints = pairs();
        let result = constrained(&mesh, &constraints, &[], true, tolerance as f64, None).unwrap();
        assert_valid(&mesh, &result.mesh);
        let (mut edges, mut left_out, mut farthest) = (Vec::<Pair>::new(), Vec::new(), 0.0f64);
        for (i, &ends) in constraints.iter().enumerate() {
            let chain = expected.chain(ends);
            let parts: Vec<Pair> = chain.windows(2).map(|pair| [pair[0], pair[1]]).collect();
            if parts.iter().any(|&part| edges.iter().any(|&edge| expected.cross(part, edge))) {
                left_out.push(i);
                continue;
            }
            through += chain.len() - 2;
            edges.extend(parts);
            let along = minus(expected.at(ends[1]), expected.at(ends[0]));
            for v in chain {
                let across = cross_product(along, minus(expected.at(v), expected.at(ends[0])));
                farthest = farthest.max(across.abs() as f64 / (dot(along, along) as f64).sqrt());
            }
        }
        skipped += left_out.len();
        assert_eq!(result.locked_edges, edges, "round {round}");
        assert_eq!(result.left_out.iter().map(|left| left.index).collect::<Vec<_>>(), left_out);
        assert!((result.deviation - farthest).abs() < 1e-12, "{} instead of {farthest}", result.deviation);
    }
    assert!(through > 3000 && skipped > 300, "{through} vertices on the way, {skipped} left out");
}

#[test]
fn a_tolerance_is_a_length() {
    let mesh = families::by_name("random 4").unwrap();
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        let message = constrained(&mesh, &[[0, 5]], &[], false, tolerance, None).unwrap_err().to_string();
        assert!(message.contains("is not a length"), "{message}");
    }
}
