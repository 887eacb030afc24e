//! Attributes of corners survive flips on dirty meshes: `Wedges` gives the same result as following each flip. Vertices
//! are welded and split.

use crate::meshes::{joined, moved, plane, signed, soup};
use crate::runs::rounds;
use edgeflip::families::by_name;
use edgeflip::{
    Adjacency, Backend, Dimension, Error, Mesh, NONE, Options, Order, Reason, Session, Wedges, welded,
};
use oorandom::Rand64;
use pollster::block_on;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

fn next(h: usize) -> usize {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

fn below(random: &mut Rand64, n: usize) -> usize {
    random.rand_range(0..n as u64) as usize
}

/// Two balls that share some vertices, with repeated and reversed triangles, and triangles with a repeated corner.
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

/// Numbers for the corners, made in one of four ways: random numbers; equal numbers except a few; one number for the
/// first triangles and another for the rest; a number for each sector of a random cut.
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
            let sectors = sectors(mesh, 0.3 * random.rand_float(), random);
            sectors.into_iter().map(|sector| sector % (1 + few as u32)).collect()
        }
    }
}

/// Cuts the mesh along a random share of its edges. Returns, for each corner, the corner that represents its sector:
/// the corners of a vertex that the cut leaves together.
fn sectors(mesh: &Mesh, share: f64, random: &mut Rand64) -> Vec<u32> {
    let mut sectors: Vec<u32> = (0..mesh.triangles().len() as u32).collect();
    for (h, &g) in Adjacency::new(mesh).twins.iter().enumerate() {
        if g != NONE && h < g as usize && random.rand_float() >= share {
            let g = g as usize;
            for (x, y) in [(h, next(g)), (next(h), g)] {
                let [from, to] = [sectors[x], sectors[y]];
                sectors.iter_mut().filter(|sector| **sector == from).for_each(|sector| *sector = to);
            }
        }
    }
    sectors
}

/// The triangles before a run and after each of its iterations, and whether an edge was blocked as a duplicate.
fn run(mesh: &Mesh, options: &Options) -> (Vec<Vec<u32>>, bool) {
    block_on(async {
        let mut session = Session::new(mesh, options.clone()).await.unwrap();
        let mut states = vec![session.triangles().await.unwrap()];
        let mut is_blocked = false;
        while let Some(step) = session.step().await.unwrap() {
            states.push(session.triangles().await.unwrap());
            is_blocked |= step.blocked[Reason::Duplicate] > 0;
        }
        is_blocked |= session.outcome().await.unwrap().remaining[Reason::Duplicate] > 0;
        (states, is_blocked)
    })
}

/// The locks of the wedges; in space with β = 180.
fn options(wedges: &Wedges) -> Options {
    Options {
        backend: Backend::Cpu,
        max_normal_angle: 180.0,
        locked_edges: wedges.locked_edges().to_vec(),
        locked_triangles: wedges.locked_triangles().to_vec(),
        ..Options::default()
    }
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

/// For each half-edge of an edge, its first vertex and its numbers at both ends, sorted. Then whether the edge may
/// flip.
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

/// Asserts what has to hold in any order of flips. An edge that may not flip is unchanged, and so are its attributes. A
/// new edge has the same attributes on both sides. No vertex gets new attributes.
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
    let rounds = rounds(400) as usize;
    for seed in 0..rounds {
        let random = &mut Rand64::new(seed as u128);
        let n = 3 + seed % 5;
        let (flat, bent) = soup(seed as u64, n, seed / 5 % 12);
        for mesh in [flat, bent, glued(random, n), by_name(&format!("random {n} seed={seed}")).unwrap()] {
            let classes = classes(&mesh, random);
            let wedges = Wedges::new(&mesh, classes.clone()).unwrap();
            let options = options(&wedges);
            let (states, _) = run(&mesh, &options);
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
    assert!(flips > 10 * rounds && moved > rounds && locked > rounds);
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

/// Two closed surfaces that touch at vertex 0, where each has its own attributes. Then three triangles at one edge.
#[test]
fn triangles_stay_where_no_barrier_identifies_attributes() {
    let tetrahedron = |[a, b, c]: [u32; 3]| [[0, a, b], [0, b, c], [0, c, a], [a, c, b]].concat();
    let points: Vec<f32> = (0..21).map(|i| (i * i) as f32).collect();
    let mesh = |triangles| Mesh::new(Dimension::Three, points.clone(), triangles).unwrap();
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
fn triangles_that_are_no_result_are_refused() {
    let square = plane(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.]], &[[0, 1, 2], [0, 2, 3]]);
    assert!(matches!(Wedges::new(&square, vec![1; 5]), Err(Error::Option { option: "classes", .. })));
    let wedges = Wedges::new(&square, vec![1, 1, 1, 2, 1, 1]).unwrap();
    assert_eq!(wedges.carried(&[0, 1, 2, 0, 2, 3]).unwrap(), [1, 1, 1, 2, 1, 1]);
    let refused = |triangles: &[u32]| wedges.carried(triangles).unwrap_err().to_string();
    assert_eq!(refused(&[0, 1, 2]), "triangles has 3 numbers, but the triangles of the file take 6");
    assert_eq!(
        refused(&[0, 1, 2, 0, 2, 4]),
        "triangle 1: vertex index 4 is out of range, the mesh has 4 vertices"
    );
    assert_eq!(
        refused(&[0, 3, 1, 1, 3, 2]),
        "option triangles: triangle 0 cannot result from flips while seams are locked"
    );
    // Each corner has a source, but the seam is not there.
    assert_eq!(refused(&[0, 1, 3, 1, 2, 3]), "option triangles: an edge along a seam has flipped");
}

/// The mesh with one vertex for each sector, and no other vertices.
fn cut(mesh: &Mesh, sectors: &[u32]) -> Mesh {
    let mut vertices: Vec<u32> = sectors.to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let numbers: Vec<f64> = mesh.positions().iter().collect();
    let stride = mesh.dimension().stride();
    let position =
        |&corner: &u32| numbers[stride * mesh.triangles()[corner as usize] as usize..][..stride].to_vec();
    let positions: Vec<f64> = vertices.iter().flat_map(position).collect();
    let vertex = |sector| vertices.binary_search(sector).unwrap() as u32;
    Mesh::new(mesh.dimension(), positions, sectors.iter().map(vertex).collect()).unwrap()
}

/// In the plane this always holds, because no edge is ever blocked as a duplicate. On a surface, runs with such an edge
/// are skipped.
#[test]
fn a_mesh_with_seams_flips_like_a_mesh_cut_along_them() {
    let mut iterations = [0; 2];
    let rounds = rounds(400) as usize;
    for seed in 0..rounds {
        let random = &mut Rand64::new(seed as u128);
        let size = 4 + seed % 9;
        for (kind, name) in ["random", "uvsphere"].into_iter().enumerate() {
            let mesh = by_name(&format!("{name} {size} seed={seed}")).unwrap();
            let sectors = sectors(&mesh, 0.5 * random.rand_float(), random);
            let cut = cut(&mesh, &sectors);
            let every: Vec<u32> = (0..cut.vertex_count() as u32).collect();
            let welded = welded(&cut, Some(&every)).unwrap();
            assert!(welded.wedges.locked_triangles().is_empty());
            let (with, is_blocked) = run(&welded.mesh, &options(&welded.wedges));
            let (without, _) =
                run(&cut, &Options { max_normal_angle: 180.0, backend: Backend::Cpu, ..Options::default() });
            if kind == 1 && is_blocked {
                continue;
            }
            assert_eq!(with.len(), without.len());
            for (with, without) in with.iter().zip(&without) {
                assert_eq!(&welded.split(with).unwrap(), without, "{name} {size} seed={seed}");
            }
            iterations[kind] += with.len() - 1;
        }
    }
    assert!(iterations.iter().all(|&count| count > rounds), "{iterations:?}");
}

/// A welded soup flips as the mesh with shared vertices does; a corner that stays keeps its vertex.
#[test]
fn a_soup_is_joined_and_split_again() {
    for name in ["random 12", "uvsphere 9", "uvsphere 6 0.5"] {
        let mesh = by_name(name).unwrap();
        let soup = cut(&mesh, &(0..mesh.triangles().len() as u32).collect::<Vec<_>>());
        let welded = welded(&soup, None).unwrap();
        assert_eq!(welded.joined(), soup.vertex_count() - mesh.vertex_count());
        assert!(welded.wedges.locked_edges().is_empty());
        assert_eq!(welded.split(welded.mesh.triangles()).unwrap(), soup.triangles());
        let (found, wanted) =
            (run(&welded.mesh, &options(&welded.wedges)).0, run(&mesh, &options(&welded.wedges)).0);
        assert!(wanted.len() > 2 && found.len() == wanted.len());
        for (found, wanted) in found.iter().zip(wanted) {
            let split = welded.split(found).unwrap();
            for (corner, v) in split.iter().enumerate() {
                assert_eq!(mesh.triangles()[*v as usize], wanted[corner]);
                assert!(wanted[corner] != mesh.triangles()[corner] || *v == corner as u32);
            }
        }
    }
}

/// 0 and -0 are the same position; the next float is a different one. Unreferenced vertices are joined too.
#[test]
fn positions_are_compared_exactly() {
    let tiny = f64::from_bits(1);
    let points: [[f64; 3]; 6] = [
        [0.0, 1.0, -0.0],
        [-0.0, 1.0, 0.0],
        [tiny, 1.0, 0.0],
        [5.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [5.0, -0.0, 0.1],
    ];
    let mesh = Mesh::new(Dimension::Three, points.concat(), vec![1, 3, 5, 2, 5, 4]).unwrap();
    let welded = welded(&mesh, None).unwrap();
    assert_eq!((&welded.places[..], welded.joined()), (&[0, 0, 2, 3, 0, 5][..], 2));
    assert_eq!(welded.mesh.triangles(), [0, 3, 5, 2, 5, 0]);
    assert_eq!(welded.mesh.positions(), mesh.positions());
    assert_eq!(welded.split(welded.mesh.triangles()).unwrap(), mesh.triangles());
    let refused = edgeflip::welded(&mesh, Some(&[1; 5])).unwrap_err();
    assert_eq!(refused.to_string(), "option attributes: it has 5 numbers, the mesh has 6 vertices");
}

/// The two triangles of a square, swapped. Their first corners have the same position, but are on different sides of
/// the seam.
#[test]
fn a_corner_keeps_its_vertex_only_with_its_attributes() {
    let square = plane(&[[0., 0.], [1., 0.], [1., 1.], [0., 1.], [0., 0.]], &[[0, 1, 2], [4, 2, 3]]);
    let split = |attributes: [u32; 5]| {
        welded(&square, Some(&attributes)).unwrap().split(&[0, 2, 3, 0, 1, 2]).unwrap()
    };
    assert_eq!(split([7, 7, 7, 7, 8]), [4, 2, 3, 0, 1, 2]);
    assert_eq!(split([7; 5]), [0, 2, 3, 4, 1, 2]);
}

/// A soup of triangles, some of them reversed. After the weld they are reversed back, and each keeps its vertices.
#[test]
fn a_welded_mesh_can_be_reoriented() {
    let mesh = by_name("uvsphere 9").unwrap();
    let soup = cut(&mesh, &(0..mesh.triangles().len() as u32).collect::<Vec<_>>());
    let random = &mut Rand64::new(3);
    let mut triangles = soup.triangles().to_vec();
    let turns = triangles.chunks_mut(3).filter(|_| random.rand_float() < 0.3).map(|t| t.swap(1, 2)).count();
    let dirty = soup.with_triangles(triangles).unwrap();
    for attributes in [None, Some((0..soup.vertex_count() as u32).map(|v| v % 2).collect::<Vec<_>>())] {
        let (welded, turned) = welded(&dirty, attributes.as_deref()).unwrap().reoriented().unwrap();
        assert_eq!(turned as usize, turns);
        assert_eq!(welded.split(welded.mesh.triangles()).unwrap(), soup.triangles());
        if let Some(attributes) = &attributes {
            let carried = welded.wedges.carried(welded.mesh.triangles()).unwrap();
            assert!(carried.iter().zip(soup.triangles()).all(|(class, v)| *class == attributes[*v as usize]));
        }
        assert_eq!(welded.wedges.locked_edges().is_empty(), attributes.is_none());
    }
}
