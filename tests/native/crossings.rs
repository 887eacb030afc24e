//! Lines that cross: a new vertex at each crossing, and chains that pass no vertex on the wrong side.
#![cfg(feature = "files")]

#[path = "crossings/checker.rs"]
mod checker;
#[path = "crossings/sets.rs"]
mod sets;

use checker::check;
use edgeflip::families::by_name;
use edgeflip::{
    Backend, Dimension, Error, Mesh, Options, Order, Plane, Positions, SplitCrossings, constrained, io,
    make_delaunay, quality, split_crossings, triangulate,
};
use std::ops::ControlFlow;

fn split(mesh: &Mesh, lines: &[[u32; 2]]) -> SplitCrossings {
    split_crossings(mesh, lines, &[], false).unwrap()
}

/// Runs the result with its chains locked, and audits that.
fn assert_delaunay(mesh: &Mesh, lines: &[[u32; 2]]) {
    let mut options = Options {
        backend: Backend::Cpu,
        order: Order::Any,
        constraints: lines.to_vec(),
        ..Options::default()
    };
    let split = options.split_crossings(mesh).unwrap();
    let outcome = make_delaunay(&split.mesh, &options, |_, _| ControlFlow::Continue(())).unwrap();
    let audit = quality::audit_outcome(&split.mesh, &outcome, &options);
    assert!(audit.is_clean(), "{:?}", audit.violations);
    assert_eq!(outcome.remaining.total(), outcome.remaining[edgeflip::Reason::Locked]);
}

#[test]
fn random_lines_become_chains() {
    let count = if std::env::var_os("EDGEFLIP_FULL").is_some() { 2000 } else { 120 };
    let (mut added, mut over) = (0, 0);
    // In the last ones, lines have to turn back, meet before the last triangle, or not go around a vertex.
    for seed in (0..count).chain([1289, 1709, 1799, 2050, 2931, 3488, 4610]) {
        let (mesh, lines) = sets::random_set(seed);
        let split =
            split_crossings(&mesh, &lines, &[], false).unwrap_or_else(|error| panic!("set {seed}: {error}"));
        let places = check(&mesh, &lines, &split);
        assert!(places <= 3.0, "set {seed}: a chain is {places} units in the last place from its line");
        over += u64::from(places > 2.0);
        added += split.crossings.len();
        if seed % 12 < 6 {
            assert_delaunay(&mesh, &lines);
        }
    }
    // Where hundreds of lines meet in a few units in the last place, there may be no nearer way.
    assert!(1000 * over <= count, "{over} of {count}");
    assert!(added > 10 * count as usize, "{added} crossings");
}

/// Without crossings, the result is that of bringing the lines in.
#[test]
fn lines_that_do_not_cross_come_in_as_constraints() {
    let mesh = by_name("random 12").unwrap();
    let lines = [[0, 143], [11, 3], [13, 130]];
    let plain = constrained(&mesh, &lines, &[], true, 0.0, None).unwrap();
    let kept: Vec<[u32; 2]> = (0..lines.len())
        .filter(|&i| plain.left_out.iter().all(|left| left.index != i))
        .map(|i| lines[i])
        .collect();
    let plain = constrained(&mesh, &kept, &[], false, 0.0, None).unwrap();
    let split = split(&mesh, &kept);
    assert_eq!((split.mesh.positions(), split.deviation), (plain.mesh.positions(), 0.0));
    let pairs: Vec<[u32; 2]> = split
        .chains
        .iter()
        .flat_map(|chain| chain.windows(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>())
        .collect();
    assert_eq!(pairs, plain.locked_edges);
}

/// Lines may repeat, overlap, and meet at vertices; 4 is the crossing of the diagonals of a square.
#[test]
fn lines_may_overlap() {
    let corners = vec![0.0, 0.0, 4.0, 0.0, 4.0, 4.0, 0.0, 4.0];
    let mesh = Mesh::new(Dimension::Two, corners, vec![0, 1, 2, 0, 2, 3]).unwrap();
    let split = split(&mesh, &[[0, 2], [2, 0], [1, 3], [0, 1], [3, 1], [1, 0]]);
    let chains: [&[u32]; 6] = [&[0, 4, 2], &[2, 4, 0], &[1, 4, 3], &[0, 1], &[3, 4, 1], &[1, 0]];
    assert_eq!(split.chains, chains);
    assert_eq!(split.mesh.positions().iter().skip(8).collect::<Vec<_>>(), [2.0, 2.0]);
    assert_eq!(split.crossings.len(), 1);
    assert_eq!(split.crossings[0].constraints, [0, 2]);
    assert_eq!((split.crossings[0].between, split.crossings[0].at), ([0, 2], 0.5));
    assert_eq!(split.constraint_edges(), [[0, 1], [0, 4], [1, 4], [2, 4], [3, 4]]);
}

/// Two lines across two others.
#[test]
fn lines_cross_in_a_lattice() {
    let points: Vec<f64> =
        vec![0.0, 1.0, 3.0, 1.0, 0.0, 2.0, 3.0, 2.0, 1.0, 0.0, 1.0, 3.0, 2.0, 0.0, 2.0, 3.0];
    let triangles = triangulate(&Positions::from(points.clone())).unwrap().triangles;
    let mesh = Mesh::new(Dimension::Two, points, triangles).unwrap();
    let lines = [[0, 1], [2, 3], [4, 5], [6, 7]];
    let split = split(&mesh, &lines);
    assert_eq!(check(&mesh, &lines, &split), 0.0);
    let positions: Vec<f64> = split.mesh.positions().iter().skip(16).collect();
    assert_eq!(positions, [1.0, 1.0, 1.0, 2.0, 2.0, 1.0, 2.0, 2.0]);
    assert_eq!(split.chains, [[0, 8, 10, 1], [2, 9, 11, 3], [4, 8, 9, 5], [6, 10, 11, 7]]);
    let pairs: Vec<[usize; 2]> = split.crossings.iter().map(|crossing| crossing.constraints).collect();
    assert_eq!(pairs, [[0, 2], [1, 2], [0, 3], [1, 3]]);
}

/// The crossing has the numbers of the mesh: 32-bit floats if it stores such.
#[test]
fn a_crossing_is_rounded_to_the_numbers_of_the_mesh() {
    let corners = |last: f64| vec![0.0, 0.0, 3.0, 0.0, 3.0, 1.0, 0.0, last];
    for (last, is_double) in [(1.0, false), (1.1, true)] {
        let mesh = Mesh::new(Dimension::Two, corners(last), vec![0, 1, 2, 0, 2, 3]).unwrap();
        let lines = [[0, 2], [1, 3]];
        let split = split(&mesh, &lines);
        assert_eq!(matches!(split.mesh.positions(), Positions::F64(_)), is_double);
        assert!(check(&mesh, &lines, &split) < 1.0);
        assert_eq!(split.deviation > 0.0, is_double);
    }
}

#[test]
fn constraints_that_cannot_come_in_are_errors() {
    let mesh = by_name("random 12").unwrap();
    let lines = [[13, 130], [22, 120], [7, 7], [25, 100]];
    let locked = constrained(&mesh, &[[22, 120]], &[], false, 0.0, None).unwrap();
    let refused = split_crossings(&locked.mesh, &lines, &locked.locked_edges, false);
    let Err(Error::Option { option: "constraints", message }) = refused else { panic!("{refused:?}") };
    assert!(
        message.starts_with("constraint 0 between 13 and 130 crosses the locked edge between "),
        "{message}"
    );
    let split = split_crossings(&locked.mesh, &lines, &locked.locked_edges, true).unwrap();
    let left_out: Vec<usize> = split.left_out.iter().map(|left| left.index).collect();
    assert_eq!(left_out, [0, 2, 3]);
    assert_eq!((split.chains[0].len(), split.chains[1][0], split.crossings.len()), (0, 22, 0));
    let edges = split.constraint_edges();
    assert!(locked.locked_edges.iter().all(|&[u, v]| edges.contains(&[u.min(v), u.max(v)])));
    for wrong in [[0, 144], [200, 3]] {
        assert!(matches!(split_crossings(&mesh, &[wrong], &[], true), Err(Error::Option { .. })));
    }
    let surface = by_name("uvsphere 6").unwrap();
    assert!(matches!(split_crossings(&surface, &[[0, 9]], &[], true), Err(Error::Option { .. })));
}

/// Two triangles that touch in a vertex, and a line from one to the other through it, across another line.
#[test]
fn a_line_goes_through_a_vertex_of_two_fans() {
    let positions = vec![0.0, 0.0, 4.0, -2.0, 4.0, 2.0, -4.0, 2.0, -4.0, -2.0, 4.0, 0.0, -4.0, 0.0];
    let triangles = vec![0, 1, 5, 0, 5, 2, 0, 3, 6, 0, 6, 4];
    let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
    let lines = [[1, 2], [6, 5], [3, 4]];
    assert_eq!(split(&mesh, &lines).chains, [vec![1, 5, 2], vec![6, 0, 5], vec![3, 6, 4]]);
    let clockwise = mesh.triangles().iter().rev().copied().collect();
    let mesh = mesh.with_triangles(clockwise).unwrap();
    assert_eq!(split(&mesh, &lines).chains, [vec![1, 5, 2], vec![6, 0, 5], vec![3, 6, 4]]);
}

/// Clockwise triangles are as good as counter-clockwise ones.
#[test]
fn a_clockwise_mesh_is_split_alike() {
    let (mesh, lines) = sets::random_set(12);
    let turned =
        mesh.triangles().chunks(3).flat_map(|corners| [corners[0], corners[2], corners[1]]).collect();
    let turned = mesh.with_triangles(turned).unwrap();
    let [one, other] = [&mesh, &turned].map(|mesh| split(mesh, &lines));
    assert_eq!(one.chains.len(), other.chains.len());
    assert_eq!((one.crossings.len(), one.deviation), (other.crossings.len(), other.deviation));
}

#[test]
fn a_terrain_has_heights_along_the_first_line() {
    for plane in Plane::ALL {
        let plan = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        let heights = [10.0, 0.0, 30.0, 5.0];
        let mut positions = vec![0.0; 12];
        for (i, (point, height)) in plan.iter().zip(heights).enumerate() {
            let [u, v] = plane.axes();
            (positions[3 * i + u], positions[3 * i + v]) = (point[0], point[1]);
            positions[3 * i + 3 - u - v] = height;
        }
        let terrain = Mesh::new(Dimension::Three, positions, vec![0, 1, 2, 0, 2, 3]).unwrap();
        let plan = terrain.plan(plane).unwrap();
        for (lines, height) in [([[0, 2], [1, 3]], 20.0), ([[1, 3], [0, 2]], 2.5)] {
            let split = split_crossings(&plan, &lines, &[], false).unwrap();
            let lifted = split.lifted(&terrain, plane).unwrap();
            let [u, v] = plane.axes();
            let new: Vec<f64> = lifted.positions().iter().skip(12).collect();
            assert_eq!([new[u], new[v], new[3 - u - v]], [1.0, 1.0, height]);
            assert_eq!(lifted.plan(plane).unwrap(), split.mesh);
        }
    }
}

/// A mesh from a report of the crate spade: two constraints that cross near a vertex.
#[test]
fn a_report() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/native/crossings/spade116.ply");
    let mesh = io::read(file, &io::ReadOptions::default()).unwrap();
    let lines = [[0, 1], [2, 3], [4, 3], [5, 3]];
    let message = constrained(&mesh, &lines, &[], false, 0.0, None).unwrap_err().to_string();
    assert!(message.contains("crosses constraint"), "{message}");
    let split = split(&mesh, &lines);
    assert!(check(&mesh, &lines, &split) <= 2.0);
    // The third line and the fourth cross the first.
    assert_eq!(split.crossings.len(), 2);
    assert_delaunay(&mesh, &lines);
}
