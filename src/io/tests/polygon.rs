//! Polygons are cut as the polygons that they are.

use super::*;
use crate::make_delaunay;
use glam::{DVec2, DVec3, dvec2};
use oorandom::Rand64;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::time::Instant;

/// A prism of two L-shaped hexagons and six quadrilaterals: area 46, volume 11.
const PRISM: &str = "v 6 0 0\nv 6 1 0\nv 1 1 0\nv 1 6 0\nv 0 6 0\nv 0 0 0\n\
    v 6 0 1\nv 6 1 1\nv 1 1 1\nv 1 6 1\nv 0 6 1\nv 0 0 1\n\
    f 7 8 9 10 11 12\nf 6 5 4 3 2 1\n\
    f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
const ELL: &str = "v 0 0 0\nv 6 0 0\nv 6 1 0\nv 1 1 0\nv 1 6 0\nv 0 6 0\nf 2 3 4 5 6 1\n";
const COMB: &str = "v 0 0 0\nv 6 0 0\nv 6 4 0\nv 5 4 0\nv 5 1 0\nv 4 1 0\nv 4 4 0\nv 3 4 0\nv 3 1 0\nv 2 1 0\n\
    v 2 4 0\nv 0 4 0\nf 1 2 3 4 5 6 7 8 9 10 11 12\n";

/// The corners of the triangles.
fn corners(mesh: &Mesh, triangles: &[u32]) -> Vec<[DVec3; 3]> {
    triangles.as_chunks().0.iter().map(|triangle| triangle.map(|vertex| mesh.point3(vertex))).collect()
}

fn area(mesh: &Mesh, triangles: &[u32]) -> f64 {
    corners(mesh, triangles).into_iter().map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum()
}

fn run(loaded: &Loaded, angle: f64) -> Vec<u32> {
    let options = Options { backend: crate::Backend::Cpu, max_normal_angle: angle, ..Options::default() };
    make_delaunay(&loaded.mesh, &options, |_, _| ControlFlow::Continue(())).unwrap().triangles
}

#[test]
fn dents_stay() {
    let prism = obj(PRISM).unwrap();
    // At 90° and more, edges of the prism itself may flip.
    let ran = [20.0, 89.0].map(|angle| run(&prism, angle));
    for triangles in [prism.mesh.triangles(), &ran[0], &ran[1]] {
        let volume: f64 =
            corners(&prism.mesh, triangles).iter().map(|[a, b, c]| a.cross(*b).dot(*c) / 6.0).sum();
        assert_eq!((area(&prism.mesh, triangles), volume), (46.0, 11.0));
    }
    for (text, want) in [(ELL, 11.0), (COMB, 18.0)] {
        let loaded = obj(text).unwrap();
        let mesh = &loaded.mesh;
        assert_eq!((mesh.dimension(), area(mesh, mesh.triangles()), loaded.polygons), (Two, want, 1));
        for turned in [false, true] {
            let text =
                if turned { text.replace("v ", "v 0 ").replace(" 0\n", "\n") } else { text.to_owned() };
            let loaded = obj(text).unwrap();
            assert_eq!(area(&loaded.mesh, loaded.mesh.triangles()), want);
            assert!(loaded.crossing.is_empty());
        }
    }
}

#[test]
fn dents_stay_in_subnormal_numbers() {
    let small: String = COMB
        .lines()
        .map(|line| match line.strip_prefix("v ") {
            Some(point) => {
                let numbers: Vec<String> = point.split(' ').map(|x| format!("{x}e-320")).collect();
                format!("v {}\n", numbers.join(" "))
            }
            None => format!("{line}\n"),
        })
        .collect();
    assert_eq!(obj(small).unwrap().mesh.triangles(), obj(COMB).unwrap().mesh.triangles());
}

#[test]
fn polygons_of_many_corners_take_no_square_of_time() {
    const COUNT: usize = 30_000;
    let arc = (0..COUNT).rev().map(|i| format!("{i} {}", 10.0 * (i as f64 / COUNT as f64 - 0.5).powi(2)));
    let fan: Vec<String> = arc.chain([format!("{} -100000", COUNT / 2)]).collect();
    let tooth = |i: usize| [(4 * i + 4, 10), (4 * i + 3, 10), (4 * i + 3, 1), (4 * i + 1, 1)];
    let teeth = (0..COUNT / 4).rev().flat_map(tooth).map(|(x, y)| format!("{x} {y}"));
    let comb: Vec<String> = ["0 0".to_owned(), format!("{COUNT} 0")].into_iter().chain(teeth).collect();
    for points in [fan, comb] {
        let count = points.len();
        let face: String = (0..count).map(|corner| format!(" {corner}")).collect();
        let text = format!("2OFF {count} 1 0\n{}\n{count}{face}\n", points.join("\n"));
        let start = Instant::now();
        let loaded = off(text).unwrap();
        // It would take minutes.
        assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
        assert!(loaded.crossing.is_empty());
        assert_eq!(loaded.mesh.triangle_count(), count - 2);
    }
}

#[test]
fn fans_stay_where_they_fit() {
    // The third has a corner on its first side; the fan of the last is right although it has a dent.
    for points in [
        "0 0 0\n2 0 0\n2 2 0\n0 2 0\n",
        "0 0 0\n2 0 0\n3 1 0\n2 2 0\n0 2 0\n-1 1 0\n",
        "0 0 0\n1 0 0\n2 0 0\n2 2 0\n0 2 0\n",
        "0 0 0\n4 0 0\n3 3 0\n0 4 0\n",
        "0 0 0\n4 0 0\n1 1 0\n0 4 0\n",
    ] {
        let count = points.lines().count();
        let face: String = (0..count).map(|corner| format!(" {corner}")).collect();
        let loaded = off(format!("OFF {count} 1 0\n{points}{count}{face}\n")).unwrap();
        let fan: Vec<u32> = (1..count as u32 - 1).flat_map(|i| [0, i, i + 1]).collect();
        assert_eq!(loaded.mesh.triangles(), fan);
    }
}

#[test]
fn polygons_that_cross_themselves_are_named() {
    let points = "OFF 6 5 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n1 0 0\n1 1 0\n";
    // A bow tie, a square, a triangle, a polygon that touches its own side, and a square that goes around twice.
    let faces = "4 0 2 1 3\n4 0 1 2 3\n3 0 1 2\n5 0 1 2 4 3\n8 0 1 2 3 0 1 2 3\n";
    let loaded = off(format!("{points}{faces}")).unwrap();
    assert_eq!((loaded.polygons, loaded.crossing), (4, vec![0, 3, 4]));
    assert_eq!(loaded.mesh.triangles()[..6], [0, 2, 1, 0, 1, 3]);
}

#[test]
fn corners_keep_their_attributes_when_cut() {
    // The first face is cut around its third corner; the second has a vertex twice, with two texture vertices.
    let text = "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nv 9 0 1\nv 5 0 1\n\
        vt 1 0\nvt 2 0\nvt 3 0\nvt 4 0\nusemtl a\nf 2/2 3/3 4/4 1/1\n";
    let loaded = obj(text).unwrap();
    assert_eq!(loaded.mesh.triangles(), [1, 2, 0, 2, 3, 0]);
    let written = loaded.file_bytes("a.obj", vec![2, 0, 1, 0, 2, 3]).unwrap();
    let written = String::from_utf8(written).unwrap();
    assert!(written.ends_with("f 3/3 1/1 2/2\nf 1/1 3/3 4/4\n"), "{written}");
    assert_eq!(loaded.file_bytes("a.obj", loaded.mesh.triangles().to_vec()).unwrap(), text.as_bytes());
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nelement face 1\n\
        property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n";
    let ply = format!("{head}0 0\n4 0\n1 1\n0 4\n4 1 2 3 0 8 2 0 3 0 4 0 1 0\n");
    let loaded = parsed(Format::Ply, &ply).unwrap();
    let written = loaded.file_bytes("a.ply", vec![2, 0, 1, 0, 2, 3]).unwrap();
    let want = "3 2 0 1 6 3 0 1 0 2 0\n3 0 2 3 6 1 0 3 0 4 0\n";
    assert!(String::from_utf8(written).unwrap().ends_with(want));
}

/// A number from `low` to `high`.
fn number(random: &mut Rand64, low: f64, high: f64) -> f64 {
    low + (high - low) * random.rand_float()
}

fn below(random: &mut Rand64, count: usize) -> usize {
    random.rand_range(0..count as u64) as usize
}

/// A polygon whose corners are seen from its middle one after another.
fn star(random: &mut Rand64, count: usize) -> Vec<DVec2> {
    let at = |i: usize| DVec2::from_angle(TAU * i as f64 / count as f64) * number(random, 0.2, 1.0);
    (0..count).map(at).collect()
}

fn comb(random: &mut Rand64, count: usize) -> Vec<DVec2> {
    let teeth = (count / 4).max(1);
    let width = 1.0 / (2 * teeth) as f64;
    let mut points = vec![dvec2(0.0, 0.0), dvec2(1.0, 0.0)];
    for tooth in (0..teeth).rev() {
        let (left, height) = (width * (2 * tooth) as f64, number(random, 0.3, 1.0));
        points.extend([(1.0, height), (0.0, height), (0.0, 0.1)].map(|(x, y)| dvec2(left + width * x, y)));
    }
    points.pop();
    points
}

fn spiral(random: &mut Rand64, count: usize) -> Vec<DVec2> {
    let turns = number(random, 0.5, 3.0);
    let half = (count / 2).max((10.0 * turns) as usize);
    let at = |i: usize, inner: f64| {
        let angle = TAU * turns * i as f64 / half as f64;
        DVec2::from_angle(angle) * (0.1 + angle / TAU - inner)
    };
    (0..half).map(|i| at(i, -0.3)).chain((0..half).rev().map(|i| at(i, 0.0))).collect()
}

/// A square with square holes; a bridge leads to each, and its ends are in the outline twice.
fn holes(random: &mut Rand64, count: usize) -> Vec<DVec2> {
    let holes = (count / 6).max(1);
    let wide = holes as f64;
    let mut points = vec![dvec2(0.0, 0.0)];
    for hole in 0..holes {
        let x = hole as f64;
        let low = number(random, 0.2, 0.4);
        let square = [(0.25, low), (0.25, 0.8), (0.75, 0.8), (0.75, low), (0.25, low)];
        points.push(dvec2(x + 0.125, 0.0));
        points.extend(square.map(|(u, v)| dvec2(x + u, v)));
        points.push(dvec2(x + 0.125, 0.0));
    }
    points.extend([dvec2(wide, 0.0), dvec2(wide, 1.0), dvec2(0.0, 1.0)]);
    points
}

/// Random points, joined by an outline whose crossings are undone one after another.
fn tangle(random: &mut Rand64, count: usize) -> Vec<DVec2> {
    let count = count.min(40);
    let mut points: Vec<_> = (0..count).map(|_| dvec2(random.rand_float(), random.rand_float())).collect();
    let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a) > 0.0;
    let crosses = |a, b, c, d| side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b);
    loop {
        let pairs = (0..count).flat_map(|i| (i + 2..count).map(move |j| (i, j)));
        let mut pairs = pairs.filter(|&(i, j)| (j + 1) % count != i);
        let Some((i, j)) =
            pairs.find(|&(i, j)| crosses(points[i], points[i + 1], points[j], points[(j + 1) % count]))
        else {
            return points;
        };
        points[i + 1..=j].reverse();
    }
}

/// A random polygon in space: its points, and the vertex of each corner.
fn polygon(random: &mut Rand64) -> (Vec<DVec3>, Vec<usize>) {
    let count = if random.rand_float() < 0.7 { 3 + below(random, 20) } else { 3 + below(random, 198) };
    let kinds = [star, comb, spiral, holes, tangle];
    let kind = below(random, kinds.len());
    let mut outline = kinds[kind](random, count);
    for _ in 0..below(random, 4) {
        let at = below(random, outline.len());
        let (point, next) = (outline[at], outline[(at + 1) % outline.len()]);
        // On a side that is no bridge, or at the same place.
        let is_bridge =
            (0..outline.len()).any(|i| [outline[i], outline[(i + 1) % outline.len()]] == [next, point]);
        let is_between = random.rand_float() < 0.5 && !is_bridge;
        outline.insert(at + 1, if is_between { point.midpoint(next) } else { point });
    }
    if random.rand_float() < 0.5 {
        outline.reverse();
    }
    let start = below(random, outline.len());
    outline.rotate_left(start);
    let direction = |random: &mut Rand64| {
        DVec3::from_array([0; 3].map(|_| number(random, -1.0, 1.0))).normalize_or(DVec3::X)
    };
    let along = if random.rand_float() < 0.3 { DVec3::Y } else { direction(random) };
    let (u, v) = along.any_orthonormal_pair();
    let bent = [0.0, 0.0, 0.01][below(random, 3)];
    let scale = [1.0, 1.0, 1e-30, 1e30][below(random, 4)];
    let offset = [0.0, 100.0][below(random, 2)] * direction(random);
    let size = outline.iter().fold(0.0, |size: f64, p| size.max(p.abs().max_element()));
    let (mut points, mut known, mut corners) = (Vec::new(), HashMap::new(), Vec::new());
    for (i, &p) in outline.iter().enumerate() {
        // A corner at the place of the one before is the same vertex or another.
        let is_other = i > 0 && outline[i - 1] == p && random.rand_float() < 0.5;
        let key = [p.x.to_bits(), p.y.to_bits(), if is_other { i as u64 } else { 0 }];
        corners.push(*known.entry(key).or_insert_with(|| {
            let height = bent * p.x * p.y / size;
            points.push(scale * (offset + p.x * u + p.y * v + height * along));
            points.len() - 1
        }));
    }
    (points, corners)
}

#[test]
fn random_polygons_keep_their_area() {
    let mut random = Rand64::new(49);
    let mut fans = 0;
    for n in 0..10_000 {
        let (points, corners) = polygon(&mut random);
        let mut text = String::new();
        for point in &points {
            text += &format!("v {} {} {}\n", point.x as f32, point.y as f32, point.z as f32);
        }
        let face: String = corners.iter().map(|corner| format!(" {}", corner + 1)).collect();
        text += &format!("f{face}\n");
        let loaded = obj(&text).unwrap();
        assert_eq!(loaded.crossing, [0; 0], "{n}\n{text}");
        let (mesh, count) = (&loaded.mesh, corners.len());
        let triangles = mesh.triangles();
        assert_eq!(triangles.len(), 3 * (count - 2), "{n}");
        let at = |corner: usize| mesh.point3(corners[corner % count] as u32) - mesh.point3(corners[0] as u32);
        let normal: DVec3 = (0..count).map(|corner| at(corner).cross(at(corner + 1))).sum::<DVec3>() / 2.0;
        let size = (0..count).fold(0.0, |size: f64, corner| size.max(at(corner).length()));
        let normal_area = normal.length();
        let ran = run(&loaded, 20.0);
        for triangles in [triangles, &ran] {
            let seen = |[a, b, c]: [DVec3; 3]| ((b - a).cross(c - a) / 2.0).dot(normal).abs() / normal_area;
            let found: f64 = self::corners(mesh, triangles).into_iter().map(seen).sum();
            assert!((found - normal_area).abs() <= 1e-9 * size * size, "{n}: {found} {normal_area}\n{text}");
        }
        // Each side is a side of a triangle, in the same direction.
        let sides = |corners: &[u32]| (0..3).map(|i| [corners[i], corners[(i + 1) % 3]]).collect::<Vec<_>>();
        let found: Vec<_> = triangles.chunks(3).flat_map(sides).collect();
        for i in 0..count {
            let side = [corners[i], corners[(i + 1) % count]].map(|corner| corner as u32);
            assert!(found.contains(&side), "{n}: no triangle has the side {side:?}\n{text}");
        }
        fans += usize::from(triangles.chunks(3).all(|triangle| triangle[0] == corners[0] as u32));
        assert_eq!(loaded.file_bytes("a.obj", triangles.to_vec()).unwrap(), text.as_bytes());
        // The other readers.
        let vertices = text
            .lines()
            .filter_map(|line| line.strip_prefix("v "))
            .fold(String::new(), |all, v| all + v + "\n");
        let face: String = corners.iter().map(|corner| format!(" {corner}")).collect();
        let (vertex_count, face) = (points.len(), format!("{count}{face}\n"));
        let head = format!(
            "ply\nformat ascii 1.0\nelement vertex {vertex_count}\nproperty float x\nproperty float y\n\
             property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        );
        for (format, name, head) in
            [(Format::Ply, "a.ply", head), (Format::Off, "a.off", format!("OFF {vertex_count} 1 0\n"))]
        {
            let text = format!("{head}{vertices}{face}");
            let loaded = parsed(format, &text).unwrap();
            assert_eq!(loaded.mesh.triangles(), triangles, "{n}");
            assert_eq!(loaded.file_bytes(name, triangles.to_vec()).unwrap(), text.as_bytes());
        }
    }
    assert!((500..5_000).contains(&fans), "{fans}");
}

/// A square with a chain of square holes. A bridge leads to each, whose sides have corners of their own.
fn chain_of_holes(random: &mut Rand64) -> Vec<[i32; 2]> {
    let holes = 1 + below(random, 4) as i32;
    let end = 8 * holes + 4;
    let mut some = |from: i32| Vec::from_iter((from + 1..from + 4).filter(|_| random.rand_float() < 0.3));
    let diagonal = |places: Vec<i32>| places.into_iter().map(|x| [x, x]);
    let (mut there, mut back) = (vec![[0, 0]], vec![[0, end], [end, end], [end, 0], [0, 0]]);
    for low in (0..holes).map(|hole| 8 * hole) {
        let [first, second] = [low + 4, low + 8];
        there.extend(diagonal(some(low)));
        there.extend([[first, first], [first, second], [second, second]]);
        back.extend(diagonal(some(low)));
        back.extend([[first, first], [second, first], [second, second]]);
    }
    // At the end of the chain it turns back.
    back.pop();
    there.into_iter().chain(back.into_iter().rev()).collect()
}

#[test]
fn the_sides_of_a_bridge_may_have_other_corners() {
    let mut random = Rand64::new(50);
    for n in 0..2_000 {
        let mut outline = chain_of_holes(&mut random);
        let start = below(&mut random, outline.len());
        outline.rotate_left(start);
        let mut axis = || DVec3::from_array([0; 3].map(|_| below(&mut random, 7) as f64 - 3.0));
        let [u, v, offset] = [axis(), axis(), axis()];
        if u.cross(v) == DVec3::ZERO {
            continue;
        }
        let points: Vec<DVec3> =
            outline.iter().map(|&[x, y]| f64::from(x) * u + f64::from(y) * v + offset).collect();
        let text: String = points.iter().map(|p| format!("v {} {} {}\n", p.x, p.y, p.z)).collect();
        let face: String = (1..=points.len()).map(|corner| format!(" {corner}")).collect();
        let loaded = obj(format!("{text}f{face}\n")).unwrap();
        assert_eq!(loaded.crossing, [0; 0], "{n}\n{text}f{face}");
        let triangles = loaded.mesh.triangles();
        assert_eq!(triangles.len(), 3 * (points.len() - 2), "{n}");
        let normal: DVec3 = points.windows(2).map(|pair| pair[0].cross(pair[1])).sum::<DVec3>()
            + points[points.len() - 1].cross(points[0]);
        let areas = triangles.chunks(3).map(|t| {
            let [a, b, c] = [0, 1, 2].map(|k| points[t[k] as usize]);
            (b - a).cross(c - a)
        });
        assert!(areas.clone().all(|area| area.dot(normal) > 0.0), "{n}: {triangles:?}\n{text}");
        assert_eq!(areas.sum::<DVec3>(), normal, "{n}");
    }
}
