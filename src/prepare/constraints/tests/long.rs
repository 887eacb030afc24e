//! Constraints across hundreds of edges, in meshes with one sheet and with several.

use super::*;

/// Numbers for a test, always the same.
fn below(random: &mut Rand64, n: u32) -> u32 {
    random.rand_range(0..u64::from(n)) as u32
}

/// Tracks from left to right, `count` points each, one above the other: noise around a line that some points are on. In
/// their Delaunay triangulation, the line of a track crosses most of its edges.
fn tracks(random: &mut Rand64, tracks: u32, count: u32) -> (Vec<[f64; 2]>, Vec<u32>) {
    let slope = below(random, 3);
    let heights = 1 + below(random, 6);
    let point = |i: u32, random: &mut Rand64| {
        let (track, x) = (i / count, i % count);
        let noise = if x == 0 || x + 1 == count { heights } else { below(random, 2 * heights + 1) };
        [x, slope * x + noise + 40 * track * heights].map(f64::from)
    };
    let points: Vec<_> = (0..tracks * count).map(|i| point(i, random)).collect();
    let triangles = crate::triangulate(&points.concat().into()).unwrap().triangles;
    (points, triangles)
}

fn mesh(points: &[[f64; 2]], triangles: Vec<u32>) -> Mesh {
    Mesh::new(Dimension::Two, points.concat(), triangles).unwrap()
}

/// The same mesh as in a mirror, with clockwise triangles.
fn mirrored(mesh: &Mesh) -> Mesh {
    let numbers = mesh.positions().iter().enumerate();
    let positions: Vec<f64> = numbers.map(|(i, x)| if i % 2 == 0 { x } else { -x }).collect();
    Mesh::new(Dimension::Two, positions, mesh.triangles().to_vec()).unwrap()
}

/// The result is that of `spade`, in the mirror too, and for any number of threads.
#[test]
fn tracks_become_edges() {
    let mut random = Rand64::new(1);
    let (mut crossed, mut split) = (0, 0);
    for _ in 0..30 {
        let (count, length) = (1 + below(&mut random, 5), 20 + below(&mut random, 300));
        let (points, triangles) = tracks(&mut random, count, length);
        let mesh = mesh(&points, triangles);
        // The longest ones first, and shorter ones across their parts or along them.
        let mut constraints: Vec<Pair> = (0..count).map(|i| [i * length, (i + 1) * length - 1]).collect();
        let all = points.len() as u32;
        constraints.extend((0..9).map(|_| [below(&mut random, all), below(&mut random, all)]));
        constraints.iter_mut().filter(|_| below(&mut random, 2) == 0).for_each(|ends| ends.reverse());
        constraints.retain(|[u, v]| u != v);
        let result = check(&mesh, &constraints);
        crossed += result.crossed_edges;
        split += usize::from(result.constraint_edges().len() > constraints.len());
        let after = flipped(&result.mesh, &result.locked_edges);
        let locked: Vec<Pair> = border(&mesh).into_iter().chain(result.locked_edges.clone()).collect();
        let (ours, theirs) = (edges(&after), by_spade(&mesh, &locked));
        assert!(ours.difference(&theirs).all(|&edge| is_tie(&after, edge)));
        let other = brought_in(&mirrored(&mesh), &constraints, &[], true).unwrap();
        assert_eq!(
            (&result.mesh.triangles(), &result.locked_edges, result.crossed_edges),
            (&other.mesh.triangles(), &other.locked_edges, other.crossed_edges)
        );
    }
    assert!(crossed > 3000 && split > 10, "{crossed}, {split}");
}

/// How many triangles have each sign.
fn signs(mesh: &Mesh) -> BTreeMap<i32, usize> {
    let mut count = BTreeMap::new();
    for &corners in mesh.triangles().as_chunks::<3>().0 {
        *count.entry(turn(mesh, corners)).or_default() += 1;
    }
    count
}

fn embedded(mesh: &Mesh) -> Vec<bool> {
    let state = State::new(mesh, &[], &Threads::one());
    (0..mesh.vertex_count() as u32).map(|v| state.embedded.at(v)).collect()
}

/// Sheets of tracks over each other, with common vertices: the constraint comes in, or nothing changes. Signs, borders and
/// embedded stars stay, and no edge comes in twice.
#[test]
fn tracks_on_several_sheets_come_in_or_change_nothing() {
    let (mut crossed, mut doubled) = (0, 0);
    for round in 0..400 {
        let mut random = Rand64::new(round);
        let length = 10 + below(&mut random, 100);
        let (mut points, mut triangles) = tracks(&mut random, 1, length);
        for _ in 0..1 + below(&mut random, 2) {
            let (more, others) = tracks(&mut random, 1, length);
            let first = points.len() as u32;
            triangles.extend(others.into_iter().map(|v| first + v));
            points.extend(more);
        }
        // Some vertices become one, which is on both sheets.
        for _ in 0..below(&mut random, 40) {
            let [from, to] = [(); 2].map(|()| below(&mut random, points.len() as u32));
            if points[from as usize][0] == points[to as usize][0] {
                triangles.iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
            }
        }
        for _ in 0..length / 4 {
            let to = below(&mut random, length);
            let from = length + to;
            triangles.iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
        }
        let whole = triangles.as_chunks::<3>().0.iter().filter(|[a, b, c]| a != b && b != c && c != a);
        let kept: Vec<u32> = whole.copied().filter(|_| below(&mut random, 200) > 0).flatten().collect();
        let mesh = mesh(&points, kept);
        let mut vertex = || below(&mut random, 2 * length);
        let others: Vec<Pair> = (0..4).map(|_| [vertex(), vertex()]).collect();
        let constraints = others.into_iter().chain([[0, length - 1]]);
        let mut now = mesh;
        for constraint in constraints {
            let result = brought_in(&now, &[constraint], &[], true).unwrap();
            let fixed = super::dirty::fixed;
            assert_eq!(fixed(&now), fixed(&result.mesh), "{round}");
            assert_eq!(signs(&now), signs(&result.mesh), "{round}");
            assert!(
                embedded(&now).iter().zip(embedded(&result.mesh)).all(|(before, after)| !before || after)
            );
            if let [LeftOut { reason, .. }] = &result.left_out[..] {
                assert_eq!(now, result.mesh);
                doubled += usize::from(reason.contains("elsewhere"));
            } else {
                let all = edges(&result.mesh);
                assert!(result.locked_edges.iter().all(|&edge| all.contains(&ordered(edge))));
            }
            crossed += result.crossed_edges;
            now = result.mesh;
        }
    }
    assert!(crossed > 3000 && doubled > 15, "{crossed}, {doubled}");
}

/// The triangles of vertex 2 turn by 378° above the line: it looks like a convex corner, and is not. Which corner comes off
/// first depends on the number of vertices.
#[test]
fn a_corner_of_more_than_a_round_is_no_ear() {
    for right in 2..12i32 {
        let points = [[-5, 0], [20, 0], [10, 1], [0, 100], [-79, 199]].map(|point| point.map(f64::from));
        let below = (0..right).map(|i| [0.5 + 10.5 * f64::from(i) / f64::from(right - 1), -1.0]);
        let points: Vec<[f64; 2]> = points.into_iter().chain(below).collect();
        let last = 4 + right as u32;
        let mut triangles = vec![[0, 5, 3], [5, 2, 3], [last, 4, 2], [last, 1, 4]];
        triangles.extend((5..last).map(|v| [v, v + 1, 2]));
        let mesh = mesh(&points, triangles.concat());
        for mesh in [&mesh, &mirrored(&mesh)] {
            for ends in [[0, 1], [1, 0]] {
                let result = brought_in(mesh, &[ends], &[], false).unwrap();
                let crossed = u64::from(right.unsigned_abs()) + 2;
                assert_eq!((result.crossed_edges, &result.locked_edges[..]), (crossed, &[ends][..]));
                assert_eq!(signs(mesh), signs(&result.mesh));
            }
        }
    }
}
