//! Attributes of corners, on dirty meshes: each corner of a result has those that it has when the flips are followed one
//! by one.
#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

mod meshes;

use edgeflip::{Adjacency, Backend, Error, Mesh, NONE, Options, Order, Session, Wedges, families::by_name};
use meshes::{joined, moved, plane, signed};
use oorandom::Rand64;
use pollster::block_on;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

/// Random meshes to try; `EDGEFLIP_ROUNDS` asks for more.
fn rounds() -> usize {
    std::env::var("EDGEFLIP_ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(400)
}

fn next(h: usize) -> usize {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

fn below(random: &mut Rand64, n: usize) -> usize {
    random.rand_range(0..n as u64) as usize
}

/// Two balls that share some vertices, so that they touch, with triangles twice, turned, and with a corner twice.
fn glued(random: &mut Rand64, n: usize) -> Mesh {
    let mut ball = || {
        moved(&by_name(&format!("uvsphere {n}")).unwrap(), |p| p.map(|x| x * (1.0 + 0.3 * signed(random))))
    };
    let mesh = joined(&ball(), &ball());
    let vertices = mesh.vertex_count();
    let mut triangles = mesh.triangles().to_vec();
    for _ in 0..below(random, 4) {
        let [from, to] = [(); 2].map(|()| below(random, vertices) as u32);
        triangles.iter_mut().filter(|v| **v == from).for_each(|v| *v = to);
    }
    for _ in 0..below(random, 4) {
        let t = 3 * below(random, triangles.len() / 3);
        let [a, b, c] = [0, 1, 2].map(|k| triangles[t + k]);
        triangles.extend(match below(random, 4) {
            0 => [a, b, c],
            1 => [b, c, a],
            2 => [a, c, b],
            _ => [a, b, b],
        });
    }
    mesh.with_triangles(triangles).unwrap()
}

/// Numbers for the corners: at random; a few others among equal ones; by triangle; or one for each sector between
/// edges that are cut at random, of few numbers in all.
fn classes(mesh: &Mesh, random: &mut Rand64) -> Vec<u32> {
    let corners = mesh.triangles().len();
    let few = 1 + below(random, 3);
    match below(random, 4) {
        0 => (0..corners).map(|_| below(random, few) as u32).collect(),
        1 => {
            let mut classes = vec![0; corners];
            (0..below(random, 12)).for_each(|_| classes[below(random, corners)] = 1);
            classes
        }
        2 => {
            let border = below(random, corners / 3) as u32;
            (0..corners as u32 / 3).flat_map(|t| [u32::from(t < border); 3]).collect()
        }
        _ => {
            let share = random.rand_float() * 0.3;
            let mut sectors: Vec<usize> = (0..corners).collect();
            for (h, &g) in Adjacency::new(mesh).twins.iter().enumerate() {
                if g != NONE && h < g as usize && random.rand_float() >= share {
                    let g = g as usize;
                    for (x, y) in [(h, next(g)), (next(h), g)] {
                        let (from, to) = (sectors[x], sectors[y]);
                        sectors.iter_mut().filter(|sector| **sector == from).for_each(|sector| *sector = to);
                    }
                }
            }
            sectors.into_iter().map(|sector| (sector % (1 + few)) as u32).collect()
        }
    }
}

/// The triangles before a run and after each of its iterations.
fn states(mesh: &Mesh, options: &Options) -> Vec<Vec<u32>> {
    block_on(async {
        let mut session = Session::new(mesh, options.clone()).await.unwrap();
        let mut states = vec![session.triangles().await.unwrap()];
        while session.step().await.unwrap().is_some() {
            states.push(session.triangles().await.unwrap());
        }
        states
    })
}

/// Follows the flips of an iteration: a corner that has moved to another vertex gets the number that the vertex has in
/// the triangle on the other side. Both have to agree at the ends of the edge.
fn follow(before: &[u32], after: &[u32], classes: &mut [u32]) -> usize {
    let old = classes.to_vec();
    let changed: Vec<usize> = (0..before.len()).filter(|&k| before[k] != after[k]).collect();
    for &k in &changed {
        let [a, b, c] = [next(next(k)), k, next(k)].map(|x| before[x]);
        let others: Vec<usize> = changed
            .iter()
            .copied()
            .filter(|&l| {
                before[l] == a && before[next(next(l))] == b && before[next(l)] == after[k] && after[l] == c
            })
            .collect();
        let [l] = others[..] else { panic!("corner {k} has moved with {others:?}") };
        assert_eq!([old[next(next(k))], old[k]], [old[l], old[next(next(l))]], "a seam has flipped");
        classes[k] = old[next(l)];
    }
    changed.len() / 2
}

/// The half-edges of each edge.
fn edges(triangles: &[u32]) -> BTreeMap<[u32; 2], Vec<usize>> {
    let mut edges: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for h in 0..triangles.len() {
        let [u, v] = [triangles[h], triangles[next(h)]];
        edges.entry([u.min(v), u.max(v)]).or_default().push(h);
    }
    edges
}

/// The half-edges of an edge with their numbers at both ends, and whether a flip can go across it.
fn sides(half_edges: &[usize], triangles: &[u32], classes: &[u32]) -> (Vec<[u32; 3]>, bool) {
    let side = |&h: &usize| [triangles[h], classes[h], classes[next(h)]];
    let mut sides: Vec<_> = half_edges.iter().map(side).collect();
    sides.sort_unstable();
    let is_open = match *half_edges {
        [h, g] => {
            h / 3 != g / 3
                && triangles[h] == triangles[next(g)]
                && classes[h] == classes[next(g)]
                && classes[next(h)] == classes[g]
        }
        _ => false,
    };
    (sides, is_open)
}

/// What has to hold whatever the order of flips: all that is no place to flip is as it was, attributes included, all
/// other edges have the same on both sides, and no vertex has new ones.
fn assert_carried(mesh: &Mesh, before: &[u32], triangles: &[u32], after: &[u32]) {
    let (old, new) = (edges(mesh.triangles()), edges(triangles));
    for (edge, half_edges) in &old {
        let (was, is_open) = sides(half_edges, mesh.triangles(), before);
        assert!(is_open || sides(&new[edge], triangles, after) == (was, false), "{edge:?}");
    }
    let is_known =
        |edge, half_edges: &[usize]| old.contains_key(edge) || sides(half_edges, triangles, after).1;
    assert!(new.iter().all(|(edge, half_edges)| is_known(edge, half_edges)));
    let pairs = |triangles: &[u32], classes: &[u32]| -> BTreeSet<_> {
        triangles.iter().copied().zip(classes.iter().copied()).collect()
    };
    assert_eq!(pairs(mesh.triangles(), before), pairs(triangles, after));
}

#[test]
fn attributes_survive_flips_on_dirty_meshes() {
    let [mut flips, mut moved, mut locked] = [0; 3];
    for seed in 0..rounds() {
        let random = &mut Rand64::new(seed as u128);
        let n = 3 + seed % 5;
        let (flat, bent) = meshes::soup(seed as u64, n, seed / 5 % 12);
        for mesh in [flat, bent, glued(random, n), by_name(&format!("random {n} seed={seed}")).unwrap()] {
            let classes = classes(&mesh, random);
            let wedges = Wedges::new(&mesh, classes.clone()).unwrap();
            let options = Options {
                backend: Backend::Cpu,
                max_normal_angle: 180.0,
                locked_edges: wedges.locked_edges().to_vec(),
                locked_triangles: wedges.locked_triangles().to_vec(),
                ..Options::default()
            };
            let states = states(&mesh, &options);
            let mut followed = classes.clone();
            for pair in states.windows(2) {
                flips += follow(&pair[0], &pair[1], &mut followed);
                assert_eq!(wedges.carried(&pair[1]).unwrap(), followed, "seed {seed}");
            }
            let end = states.last().unwrap();
            assert_carried(&mesh, &classes, end, &followed);
            moved += (0..end.len()).filter(|&k| end[k] != states[0][k] && followed[k] != classes[k]).count();
            locked += wedges.locked_triangles().len();
            let any = Options { order: Order::Any, ..options };
            let any =
                edgeflip::make_delaunay(&mesh, &any, |_, _| ControlFlow::Continue(())).unwrap().triangles;
            assert_carried(&mesh, &classes, &any, &wedges.carried(&any).unwrap());
        }
    }
    println!("{flips} flips, {moved} corners with other numbers, {locked} locked triangles");
    assert!(flips > 10 * rounds() && moved > rounds() && locked > rounds());
}

/// ```text
///   3-----2
///   | 1 / |     the corners at 0 differ on the two sides of 0-2
///   | / 0 |
///   0-----1
/// ```
#[test]
fn an_edge_is_a_seam_if_attributes_differ_at_one_end() {
    let square = plane(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]], &[[0, 1, 2], [0, 2, 3]]);
    let seams = |classes: [u32; 6]| Wedges::new(&square, classes.to_vec()).unwrap().locked_edges().to_vec();
    assert!(seams([1, 2, 3, 1, 3, 4]).is_empty());
    assert_eq!(seams([1, 2, 3, 5, 3, 4]), [[0, 2]]);
    assert_eq!(seams([1, 2, 3, 1, 5, 4]), [[0, 2]]);
}

/// Two closed surfaces that touch at vertex 0, each with attributes of its own there, and three triangles at one edge.
#[test]
fn triangles_stay_where_only_their_numbers_tell_attributes() {
    let tetrahedron = |[a, b, c]: [u32; 3]| [[0, a, b], [0, b, c], [0, c, a], [a, c, b]].concat();
    let points: Vec<f32> = (0..21).map(|i| (i * i) as f32).collect();
    let mesh = |triangles| Mesh::new(edgeflip::Dimension::Three, points.clone(), triangles).unwrap();
    let touching = mesh([tetrahedron([1, 2, 3]), tetrahedron([4, 5, 6])].concat());
    let locked = |mesh: &Mesh, classes: &[u32]| {
        Wedges::new(mesh, classes.to_vec()).unwrap().locked_triangles().to_vec()
    };
    assert_eq!(locked(&touching, &[[1; 12], [2; 12]].concat()), [0, 4]);
    assert!(locked(&touching, &[1; 24]).is_empty());
    let fan = mesh(vec![0, 1, 2, 1, 0, 3, 0, 1, 4]);
    assert_eq!(locked(&fan, &[1, 1, 1, 1, 1, 1, 2, 1, 1]), [0, 2]);
    assert!(locked(&fan, &[1, 1, 1, 2, 2, 2, 1, 1, 1]).is_empty());
}

#[test]
fn what_is_no_result_is_refused() {
    let square = plane(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]], &[[0, 1, 2], [0, 2, 3]]);
    assert!(matches!(Wedges::new(&square, vec![1; 5]), Err(Error::Option { option: "classes", .. })));
    let wedges = Wedges::new(&square, vec![1, 1, 1, 2, 1, 1]).unwrap();
    assert_eq!(wedges.carried(&[0, 1, 2, 0, 2, 3]).unwrap(), [1, 1, 1, 2, 1, 1]);
    let refused = |triangles: &[u32]| wedges.carried(triangles).unwrap_err().to_string();
    assert_eq!(refused(&[0, 1, 2]), "triangles has 3 numbers, and those of the file have 6");
    assert_eq!(
        refused(&[0, 1, 2, 0, 2, 4]),
        "triangle 1: vertex index 4 is out of range, the mesh has 4 vertices"
    );
    assert_eq!(
        refused(&[0, 3, 1, 1, 3, 2]),
        "option triangles: triangle 0 is none that flips make while seams are locked"
    );
}
