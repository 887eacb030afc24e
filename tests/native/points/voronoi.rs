//! Voronoi diagrams: the cells are those of their definition, bit by bit, they fill the box, and what is no
//! triangulation of the points is refused.

use super::cells::{cells, circumcentre, turned};
use super::{seeds, set, wide};
use crate::points_of::{KINDS, points};
use edgeflip::{Error, NONE, Positions, Triangulation, Voronoi, triangulate};
use oorandom::Rand64;
use std::collections::{BTreeMap, BTreeSet};

/// The smallest box of points, or one around a point, a line or nothing.
fn around(points: &[[f64; 2]]) -> [f64; 4] {
    let range = |axis: usize| {
        let numbers = || points.iter().map(|point| point[axis]);
        let [low, high] =
            [numbers().fold(f64::INFINITY, f64::min), numbers().fold(f64::NEG_INFINITY, f64::max)];
        if low < high { [low, high] } else { [0.25, 1.5] }
    };
    let [[left, right], [bottom, top]] = [range(0), range(1)];
    [left, bottom, right, top]
}

/// Boxes around points, through them, among them, inside a cell and far away.
fn boxes(points: &[[f64; 2]], random: &mut Rand64) -> Vec<[f64; 4]> {
    let all = around(points);
    let [left, bottom, right, top] = all;
    let (width, height) = (right - left, top - bottom);
    let larger = [left - width, bottom - 0.5 * height, right + 0.3 * width, top + 7.0 * height];
    let mut corner = || points[random.rand_range(0..points.len() as u64) as usize];
    let [[ax, ay], [bx, by], [cx, cy]] = [corner(), corner(), corner()];
    let through = [ax.min(bx), ay.min(by), ax.max(bx), ay.max(by)];
    let halves = [ax.midpoint(bx), ay.midpoint(by), right.max(ax) + 1.0, top.max(ay) + 1.0];
    let small = 1e-3 * width.max(height);
    let around_point = [cx - small, cy - small, cx + small, cy + 2.0 * small];
    let beside = [left - 9.0 * width, bottom, left - 8.0 * width, bottom + 1e-3 * height];
    let at_corner = [ax, ay, right + width, top + height];
    let boxes = [all, larger, through, halves, around_point, beside, at_corner];
    boxes.into_iter().filter(|[left, bottom, right, top]| left < right && bottom < top).collect()
}

fn list(voronoi: &Voronoi) -> Vec<Vec<[f64; 2]>> {
    (0..voronoi.starts.len() - 1).map(|i| turned(voronoi.cell(i).to_vec())).collect()
}

/// Compares a diagram with the definition.
fn check(positions: &Positions, bounds: [f64; 4], name: &str) -> usize {
    let triangulation = triangulate(positions).unwrap();
    let voronoi = triangulation.voronoi(positions, bounds).unwrap();
    let expected: Vec<_> = cells(positions, bounds).into_iter().map(turned).collect();
    for (i, (found, expected)) in list(&voronoi).iter().zip(&expected).enumerate() {
        assert_eq!(found, expected, "{name}: cell {i} in {bounds:?} of {positions:?}");
    }
    assert_eq!(voronoi.starts.len(), expected.len() + 1);
    let numbers: Vec<f64> = positions.iter().collect();
    let at = |&v: &u32| numbers.as_chunks().0[v as usize];
    for (row, &centre) in
        triangulation.triangles.as_chunks::<3>().0.iter().zip(voronoi.circumcentres.as_chunks().0)
    {
        assert_eq!(circumcentre(row.each_ref().map(at)), centre, "{name}: {row:?} of {positions:?}");
    }
    expected.iter().filter(|cell| !cell.is_empty()).count()
}

#[test]
fn every_cell_is_the_one_of_its_definition() {
    for (name, kind) in KINDS {
        let [mut filled, mut all] = [0; 2];
        for seed in 1..=seeds() {
            let points = set(kind, 60.0, seed);
            for bounds in boxes(&points, &mut Rand64::new(seed.into())) {
                filled += check(&wide(&points), bounds, name);
                all += points.len();
            }
        }
        println!("{name}: {filled} of {all} cells reach into their box");
    }
}

#[test]
fn floats_of_both_widths_have_the_same_cells() {
    for (name, kind) in KINDS {
        let points = points(kind, 500, 3);
        let narrow = Positions::from(wide(&points).to_f32());
        let same = Positions::from(narrow.iter().collect::<Vec<f64>>());
        let bounds = around(&points);
        let [one, other] =
            [narrow, same].map(|points| triangulate(&points).unwrap().voronoi(&points, bounds).unwrap());
        assert!(one == other, "{name}");
    }
}

/// Lattices, whose circumcentres are on the sides of the boxes and on the bisectors.
#[test]
fn boxes_through_circumcentres_are_decided() {
    let mut random = Rand64::new(7);
    let mut whole = |most: u64| random.rand_range(0..most) as f64;
    for round in 0..20 * seeds() {
        let points: Vec<[f64; 2]> = (0..2 + round % 17).map(|_| [whole(4), whole(4)]).collect();
        let [x, y] = [0.5 * whole(7) - 0.5, 0.5 * whole(7) - 0.5];
        let bounds = [x, y, x + 0.5 + 0.5 * whole(4), y + 0.5 + 0.5 * whole(4)];
        check(&wide(&points), bounds, "lattice");
    }
}

/// Coordinates far apart, subnormal, and near the ends of the range; circumcentres beyond it.
#[test]
fn numbers_of_any_size_are_rounded_once() {
    let mut random = Rand64::new(2);
    let mut whole = |most: u64| random.rand_range(0..most) as f64 - (most / 2) as f64;
    for round in 0..seeds() {
        for scale in [5e-324, 1e-310, 1e-300, 1e-160, 1e-20, 1.0, 1e100, 1e160, 1e300, f64::MAX / 5.0] {
            let n = 1 + round % 12;
            let points: Vec<[f64; 2]> = (0..n).map(|_| [0; 2].map(|_| scale * whole(9))).collect();
            check(&wide(&points), [-scale, -3.0 * scale, 2.0 * scale, 4.5 * scale], "scaled");
        }
        for range in [30, 300, 1000] {
            let mut far = || libm::scalbn(whole(17), whole(2 * range) as i32);
            let points: Vec<[f64; 2]> = (0..8).map(|_| [far(), far()]).collect();
            check(&wide(&points), around(&points), "far apart");
            check(&wide(&points), [-1.0, -1e-9, 3.0, 1e9], "far apart");
        }
    }
}

/// Points that are almost on a line, or almost on a circle around 0: circumcentres far away, or all in one place.
#[test]
fn nearly_flat_and_nearly_cocircular_points_have_their_cells() {
    let mut random = Rand64::new(3);
    for round in 0..seeds() {
        let mut nudge =
            |x: f64| f64::from_bits(x.to_bits().saturating_add_signed(random.rand_range(0..3) as i64 - 1));
        let n = 3 + round % 15;
        let line: Vec<[f64; 2]> =
            (0..n).map(|i| [nudge(1.0 + i as f64), nudge(0.3 + 0.1 * i as f64)]).collect();
        check(&wide(&line), [0.0, 0.0, 16.0, 3.0], "nearly a line");
        let circle: Vec<[f64; 2]> = (0..n)
            .map(|i| std::f64::consts::TAU * i as f64 / n as f64)
            .map(|angle| [nudge(libm::cos(angle)), nudge(libm::sin(angle))])
            .collect();
        check(&wide(&circle), [-1.0, -1.0, 1.0, 1.0], "nearly a circle");
        check(&wide(&circle), [0.0, -1e-16, 1e-16, 1e-16], "the middle of a circle");
    }
}

/// Inputs of issues of d3-delaunay and other software for Voronoi diagrams.
#[test]
fn points_that_broke_others_have_their_cells() {
    let issue_141: Vec<[f64; 2]> =
        [[10.0, 190.0]].into_iter().chain((0..7).map(|i| [80.0 * i as f64, (50 * i) as f64 / 7.0])).collect();
    let issue_65: Vec<[f64; 2]> =
        (0..15).map(|i| [10.0 + 7.1 * i as f64, 20.0 + 7.1 * i as f64 * 0.3]).collect();
    let sets: [(&str, &[[f64; 2]]); 8] = [
        ("d3-delaunay 29", &[[100.0, 100.0], [200.0, 100.0], [100.0, 200.0]]),
        ("d3-delaunay 20", &[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]),
        ("d3-delaunay 141", &issue_141),
        ("d3-delaunay 65", &issue_65),
        ("javascript-voronoi 12", &[[100.0, 100.0], [200.0, 200.0001], [300.0, 300.0]]),
        (
            "geos 1040",
            &[
                [6.6584, 53.583000000000006],
                [6.6576, 53.583600000000004],
                [6.657, 53.5848],
                [6.6572000000000005, 53.5842],
            ],
        ),
        (
            "geos 1286",
            &[
                [-1.3890020986020145e-10, 4.860466764224401],
                [-1.3889120965221466e-10, -5.531838081766228],
                [-1.388852095135568e-10, -12.460041312426647],
                [0.9999999999166641, -3.799787274101123],
            ],
        ),
        (
            "boost polygon 43",
            &[
                [35058879.0, -35000000.0],
                [35058879.0, -25732145.0],
                [35058879.0, -19586070.0],
                [-31657205.0, -35000000.0],
            ],
        ),
    ];
    for (name, points) in sets {
        let bounds = boxes(points, &mut Rand64::new(5));
        for bounds in bounds.into_iter().chain([[0.0, 0.0, 960.0, 500.0], [-1e7, -1e7, 1e7, 1e7]]) {
            check(&wide(points), bounds, name);
        }
    }
}

#[test]
fn few_points_share_the_box() {
    let cells_of = |points: &[[f64; 2]]| {
        let positions = wide(points);
        list(&triangulate(&positions).unwrap().voronoi(&positions, [0.0, 0.0, 4.0, 2.0]).unwrap())
    };
    assert!(cells_of(&[]).is_empty());
    let whole = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]];
    assert_eq!(cells_of(&[[9.0, 9.0]]), [whole]);
    assert_eq!(
        cells_of(&[[3.0, 1.0], [3.0, 1.0], [1.0, 1.0]]),
        [
            vec![[2.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0]],
            vec![],
            vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]],
        ]
    );
    assert_eq!(cells_of(&[[9.0, 9.0], [1.0, 1.0]])[0].len(), 0);
}

/// Twice the area of a polygon, from a point of it.
fn area(corners: &[[f64; 2]]) -> f64 {
    let [x, y] = corners.first().copied().unwrap_or_default();
    let pairs =
        corners.windows(2).map(|pair| [pair[0][0] - x, pair[0][1] - y, pair[1][0] - x, pair[1][1] - y]);
    pairs.map(|[px, py, qx, qy]| px * qy - py * qx).sum()
}

/// Large sets: the cells fill the box, each side of a cell is that of its neighbour from the other side, cells are
/// convex, and have their points.
#[test]
fn cells_fit_together() {
    for (name, kind) in KINDS {
        let points = points(kind, 3000, 1);
        let positions = wide(&points);
        let triangulation = triangulate(&positions).unwrap();
        for bounds in boxes(&points, &mut Rand64::new(1)) {
            let voronoi = triangulation.voronoi(&positions, bounds).unwrap();
            let [left, bottom, right, top] = bounds;
            let size = (right - left).max(top - bottom);
            let (mut sum, mut sides) = (0.0, BTreeMap::new());
            for (i, &[x, y]) in points.iter().enumerate() {
                let cell = voronoi.cell(i);
                sum += area(cell);
                let is_inside = left < x && x < right && bottom < y && y < top;
                let is_copy = triangulation.duplicates.iter().any(|pair| pair[0] == i as u32);
                assert!(!cell.is_empty() || !is_inside || is_copy, "{name}: {i} has no cell");
                for k in 0..cell.len() {
                    let [p, q, r] = [k, k + 1, k + 2].map(|k| cell[k % cell.len()]);
                    let turn = |a: [f64; 2]| (q[0] - p[0]) * (a[1] - p[1]) - (q[1] - p[1]) * (a[0] - p[0]);
                    assert!(turn(r) > -1e-15 * size * size, "{name}: cell {i} is not convex");
                    assert!(
                        !is_inside || turn([x, y]) > -1e-15 * size * size,
                        "{name}: {i} is not in its cell"
                    );
                    // Where a corner is as near to others as the rounding, cells may have sides in common that are
                    // not of an edge between them. So all are counted.
                    let is_first = p.partial_cmp(&q).is_some_and(|order| order.is_lt());
                    let (key, step) = if is_first { ([p, q], 1) } else { ([q, p], -1) };
                    *sides.entry(key.map(|p| p.map(f64::to_bits))).or_insert(0) += step;
                }
            }
            let box_area = 2.0 * (right - left) * (top - bottom);
            assert!((sum / box_area - 1.0).abs() < 1e-9, "{name}: {sum} of {box_area} in {bounds:?}");
            for (key, count) in sides {
                let [[px, py], [qx, qy]] = key.map(|p| p.map(f64::from_bits));
                let is_on_box =
                    (px == qx && [left, right].contains(&px)) || (py == qy && [bottom, top].contains(&py));
                assert!((count != 0) == is_on_box, "{name}: a side of one cell only in {bounds:?}");
            }
        }
    }
}

#[cfg(feature = "threads")]
#[test]
fn threads_have_no_effect() {
    let positions = wide(&points(KINDS[2].1, 20_000, 1));
    let triangulation = triangulate(&positions).unwrap();
    let diagram = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| triangulation.voronoi(&positions, [0.1, 0.2, 0.7, 0.8]).unwrap())
    };
    let one = diagram(1);
    assert!(one.corners.len() > 1000);
    assert!([2, 3, 8].into_iter().all(|count| diagram(count) == one));
}

#[test]
fn wrong_boxes_are_refused() {
    let points = wide(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let triangulation = triangulate(&points).unwrap();
    for bounds in [
        [0.0, 0.0, 0.0, 1.0],
        [0.0, 1.0, 1.0, 1.0],
        [1.0, 0.0, 0.0, 1.0],
        [0.0, 0.0, f64::INFINITY, 1.0],
        [f64::NAN, 0.0, 1.0, 1.0],
        [-0.0, 0.0, 0.0, 1.0],
    ] {
        let error = triangulation.voronoi(&points, bounds).unwrap_err();
        assert!(matches!(error, Error::Option { option: "bounds", .. }), "{error}");
    }
}

/// A triangulation with one word changed, or of other points.
#[test]
fn what_is_no_triangulation_of_the_points_is_refused() {
    let mut random = Rand64::new(11);
    let mut messages = BTreeSet::new();
    let bounds = [0.0, 0.0, 1.0, 1.0];
    for round in 0..400 * seeds() {
        let (_, kind) = KINDS[round as usize % KINDS.len()];
        let positions = wide(&set(kind, 30.0, round));
        let good = triangulate(&positions).unwrap();
        let mut wrong = good.clone();
        let words = [&mut wrong.triangles, &mut wrong.twins, &mut wrong.hull];
        let changed = words.into_iter().nth(random.rand_range(0..3) as usize).unwrap();
        let word = [NONE, NONE - 1, random.rand_range(0..40) as u32][random.rand_range(0..3) as usize];
        match random.rand_range(0..4) {
            0 => drop(changed.pop()),
            1 => changed.push(word),
            2 if !wrong.duplicates.is_empty() => drop(wrong.duplicates.pop()),
            _ => {
                let at = random.rand_range(0..changed.len().max(1) as u64) as usize;
                changed.iter_mut().skip(at).take(1).for_each(|old| *old = word);
            }
        }
        match wrong.voronoi(&positions, bounds) {
            // The hull matters only if there are no triangles.
            Ok(_) => assert!(
                wrong == good
                    || !good.is_flat() && wrong == Triangulation { hull: wrong.hull.clone(), ..good }
            ),
            Err(Error::Option { option, message }) => {
                assert_eq!(option, "triangulation");
                messages.insert(message);
            }
            Err(_) => {}
        }
        let others = wide(&set(kind, 30.0, round + 1));
        if others != positions
            && let Ok(voronoi) = triangulate(&positions).unwrap().voronoi(&others, bounds)
        {
            // Other points may have the same triangles.
            assert_eq!(
                list(&voronoi),
                list(&triangulate(&others).unwrap().voronoi(&others, bounds).unwrap())
            );
        }
    }
    println!("{messages:#?}");
    assert!(messages.len() >= 7);
}

/// Twins that go in circles, several hulls, and triangles that cover others.
#[test]
fn consistent_arrays_that_are_no_triangulation_are_refused() {
    let refused = |points: &[[f64; 2]], triangles: Vec<u32>, twins: Vec<u32>, part: &str| {
        let given = Triangulation { triangles, twins, ..Triangulation::default() };
        let error = given.voronoi(&wide(points), [0.0, 0.0, 1.0, 1.0]).unwrap_err();
        assert!(error.to_string().contains(part), "{error}");
    };
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    refused(&square[..4], vec![0, 1, 2, 0, 2, 3], vec![NONE; 6], "hull is not");
    refused(&square[..4], vec![0, 1, 2], vec![NONE; 3], "neither");
    refused(&square[..3], vec![0, 1, 2], vec![0, 1, 2], "twin");
    refused(&square[..3], vec![0, 1, 2], vec![NONE; 2], "twins");
    refused(&square[..3], vec![0, 1], vec![NONE; 2], "multiple of 3");
    refused(&square[..3], vec![0, 2, 1], vec![NONE; 3], "counter-clockwise");
    refused(&square[..3], vec![0, 1, 3], vec![NONE; 3], "out of range");
    refused(&square, vec![0, 1, 2, 0, 2, 3], vec![NONE, NONE, 3, 2, NONE, NONE], "neither");
    let kite = [[0.0, 0.0], [4.0, -1.0], [8.0, 0.0], [4.0, 1.0]];
    refused(&kite, vec![0, 1, 2, 0, 2, 3], vec![NONE, NONE, 3, 2, NONE, NONE], "Delaunay;");
    // Two copies of a triangle, and one that lies on another.
    refused(&square[..3], vec![0, 1, 2, 0, 1, 2], vec![NONE; 6], "hull is not");
    refused(&[], vec![0, 1, 2], vec![NONE; 3], "out of range");
    // A star that goes around twice.
    let star: Vec<[f64; 2]> = [[0.0, 0.0]]
        .into_iter()
        .chain(
            (0..7)
                .map(|i| std::f64::consts::TAU * 2.0 * f64::from(i) / 7.0)
                .map(|a| [libm::cos(a), libm::sin(a)]),
        )
        .collect();
    let rows: Vec<u32> = (0..7).flat_map(|i| [0, i + 1, (i + 1) % 7 + 1]).collect();
    let twins: Vec<u32> = (0..7).flat_map(|i| [3 * ((i + 6) % 7) + 2, NONE, 3 * ((i + 1) % 7)]).collect();
    refused(&star, rows, twins, "");
}
