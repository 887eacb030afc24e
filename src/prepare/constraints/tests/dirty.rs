//! Meshes that overlap, fold and have vertices with several fans.

use super::*;

/// The edges that cannot flip, with the number of triangles in either direction.
pub(super) fn fixed(mesh: &Mesh) -> BTreeMap<Pair, [u32; 2]> {
    let mut count = BTreeMap::<Pair, [u32; 2]>::new();
    for h in 0..mesh.triangles().len() as u32 {
        let ends = [h, next(h)].map(|x| mesh.triangles()[x as usize]);
        count.entry(ordered(ends)).or_default()[usize::from(ends[0] > ends[1])] += 1;
    }
    count.retain(|_, directions| *directions != [1, 1]);
    count
}

/// A mesh that may overlap, fold and have vertices with several fans, and constraints.
fn dirty(round: u64) -> (Mesh, Vec<Pair>) {
    let mut random = Rand64::new(u128::from(round).wrapping_mul(0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835));
    let mut below = |n: u32| random.rand_range(0..u64::from(n)) as u32;
    let mesh = families::by_name(&format!("random 9 seed={round}")).unwrap();
    let mut triangles = mesh.triangles().to_vec();
    // Some vertices are joined, some triangles dropped, and some vertices moved.
    for _ in 0..below(4) {
        let (from, to) = (below(81), below(81));
        triangles.iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
    }
    let (corners, _) = triangles.as_chunks::<3>();
    let is_whole = |&&[a, b, c]: &&[u32; 3]| a != b && b != c && c != a;
    let mut kept: Vec<_> = corners.iter().filter(is_whole).copied().collect();
    kept.retain(|_| below(20) > 0);
    kept.rotate_left(below(10) as usize);
    let mut points: Vec<f64> = (0..81).flat_map(|v| mesh.point2(v).to_array()).collect();
    if round.is_multiple_of(2) {
        points.iter_mut().for_each(|x| *x = (4.0 * *x).round() + f64::from(below(7)) - 3.0);
    }
    let constraints = (0..below(40)).map(|_| [below(81), below(81)]).collect();
    (Mesh::new(Dimension::Two, points, kept.concat()).unwrap(), constraints)
}

/// The number of threads does not matter in dirty meshes either, and no edge comes in twice.
#[test]
fn threads_bring_constraints_into_dirty_meshes_alike() {
    let (mut crossed, mut left_out) = (0, 0);
    for (mesh, constraints) in (0..300).map(dirty) {
        let result = brought_in(&mesh, &constraints, &[], true).unwrap();
        assert_eq!(fixed(&mesh), fixed(&result.mesh));
        crossed += result.crossed_edges;
        left_out += result.left_out.len();
    }
    assert!(crossed > 500 && left_out > 500, "{crossed}, {left_out}");
}

/// Every star has all corners at its vertex.
fn assert_stars(state: &State) {
    let mut corners = vec![Vec::new(); state.mesh.vertex_count()];
    (0..state.triangles.len() as u32).for_each(|h| corners[state.vertex(h) as usize].push(h));
    for (v, corners) in corners.into_iter().enumerate().filter(|(_, corners)| !corners.is_empty()) {
        let mut star: Vec<u32> = state.star(v as u32).collect();
        star.sort_unstable();
        assert_eq!(star, corners, "{v}");
    }
}

/// This includes those that would come in with an edge that the mesh has elsewhere.
#[test]
fn a_constraint_that_is_left_out_changes_nothing() {
    let mut doubled = 0;
    for (mesh, constraints) in (0..3000).map(dirty) {
        let mut state = State::new(&mesh, &[], &Threads::one());
        let now = |state: &State| {
            let twins = (0..state.triangles.len() as u32).map(|h| state.twin(h)).collect::<Vec<_>>();
            (state.triangles.clone(), twins)
        };
        for constraint in constraints {
            let before = now(&state);
            let mut rounds = Rounds::new(1, Threads::one());
            let Done { edges, .. } = rounds.next(&mut state, &[constraint]).unwrap().remove(0);
            if let Err(obstacle) = edges {
                assert_eq!(before, now(&state));
                assert_stars(&state);
                doubled += usize::from(matches!(obstacle, Obstacle::Doubled(_)));
            }
        }
    }
    assert!(doubled > 20, "{doubled}");
}

/// Two sheets over each other. The ears would make the edge between 1 and 3, which the other sheet has.
#[test]
fn no_edge_comes_in_twice() {
    let points = [[0, 4], [10, 0], [4, -4], [0, 2], [1, 5], [-1, 1]];
    let triangles = [[0, 1, 2], [3, 0, 2], [3, 4, 1], [5, 3, 2]];
    let positions: Vec<f64> = points.concat().into_iter().map(f64::from).collect();
    let mesh = Mesh::new(Dimension::Two, positions, triangles.concat()).unwrap();
    let what = "constraint 0 between 1 and 5 needs an edge between 3 and 1, which the mesh has elsewhere: it \
                overlaps there";
    assert_refused(&mesh, &[[1, 5]], &[], what);
}

/// Vertex 0 lies on two sheets. The first constraint changes which of them the second takes, and the third lies on the
/// sheet that it takes then.
#[test]
fn a_constraint_that_changes_sheets_comes_in_its_turn() {
    let mut points = vec![[0, 0], [2, -1], [2, 1], [0, 2], [10, 0], [3, -2], [3, 2], [6, -3], [6, 3]];
    let mut triangles = vec![[0, 2, 3], [0, 5, 6], [0, 1, 2], [1, 4, 2], [5, 7, 6], [7, 8, 6], [7, 4, 8]];
    // More triangles at vertex 4, so that the walk of the second starts at vertex 0.
    points.extend([[11, -1], [11, 0], [11, 1]]);
    triangles.extend([[4, 9, 10], [4, 10, 11]]);
    // Enough triangles for several threads.
    for i in 0..90 {
        let first = points.len() as u32;
        points.extend([[20 + i, 0], [21 + i, 0], [20 + i, 1]]);
        triangles.push([first, first + 1, first + 2]);
    }
    let positions: Vec<f64> = points.concat().into_iter().map(f64::from).collect();
    let mesh = Mesh::new(Dimension::Two, positions, triangles.concat()).unwrap();
    let constraints = [[1, 3], [0, 4], [7, 6]];
    let result = brought_in(&mesh, &constraints, &[], true).unwrap();
    assert_eq!(result.left_out.len(), 1);
    let error = brought_in(&mesh, &constraints, &[], false).unwrap_err().to_string();
    assert!(error.contains("constraint 2 between 7 and 6 crosses constraint 1"), "{error}");
}
