//! Attributes that lock no edges, and the attributes that lock the most.

use super::original::{FLIPPED, SQUARE, facet, named, square_obj, square_ply, text};
use super::*;
use crate::make_delaunay;
use oorandom::Rand64;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

fn read(format: Format, bytes: impl AsRef<[u8]>, ignored: &[&str]) -> Result<Loaded, Error> {
    let ignore_attributes = ignored.iter().map(ToString::to_string).collect();
    let options =
        ReadOptions { ignore_attributes, dimension: Some(crate::Dimension::Two), ..ReadOptions::default() };
    parse(format, bytes.as_ref(), &options)
}

/// The attributes that lock edges, and the triangles and the file after a run.
fn run(format: Format, bytes: impl AsRef<[u8]>, ignored: &[&str]) -> (AttributeEdges, Vec<u32>, Vec<u8>) {
    let loaded = read(format, bytes, ignored).unwrap();
    let mut options = Options { backend: crate::Backend::Cpu, ..Options::default() };
    let locked = loaded.constrain(&mut options).unwrap();
    let outcome = make_delaunay(&loaded.mesh, &options, |_, _| ControlFlow::Continue(())).unwrap();
    (locked, outcome.triangles.clone(), loaded.file_bytes(named(format), outcome.triangles).unwrap())
}

/// What locks the only inner edge of a file of [`SQUARE`].
fn locks(names: &[&str]) -> AttributeEdges {
    AttributeEdges {
        count: usize::from(!names.is_empty()),
        by_name: names.iter().map(|name| (name.to_string(), 1)).collect(),
    }
}

/// Without the names, nothing flips; with them, the edge flips, and the file ends so.
#[track_caller]
fn flips_if_ignored(format: Format, file: &str, names: &[&str], end: &str) {
    let (locked, _, written) = run(format, file, &[]);
    assert_eq!((locked, text(written).as_str()), (locks(names), file));
    for (i, name) in names.iter().enumerate().filter(|_| names.len() > 1) {
        let (locked, _, written) = run(format, file, &[name]);
        let others: Vec<&str> =
            names.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, name)| *name).collect();
        assert_eq!((locked, text(written).as_str()), (locks(&others), file));
    }
    let (locked, triangles, written) = run(format, file, names);
    assert_eq!((locked, triangles.as_slice()), (locks(&[]), FLIPPED.as_slice()));
    let written = text(written);
    assert!(written.ends_with(end), "{written}");
}

#[test]
fn a_property_of_each_face_stays_with_its_triangle() {
    let properties =
        "property list uchar int vertex_indices\nproperty int id\nproperty list uchar int tags\n";
    let ply = square_ply(properties, "3 0 1 2 7 0\n3 0 2 3 8 0\n");
    flips_if_ignored(Format::Ply, &ply, &["id"], "\n3 3 1 2 7 0\n3 0 1 3 8 0\n");
    let ply = square_ply(properties, "3 0 1 2 7 0\n3 0 2 3 8 2 5 6\n");
    flips_if_ignored(Format::Ply, &ply, &["id", "tags"], "\n3 3 1 2 7 0\n3 0 1 3 8 2 5 6\n");
    let off = format!("OFF 4 2\n{}\n3 0 1 2 1 0 0\n3 0 2 3 0 1 0\n", SQUARE.join("\n"));
    flips_if_ignored(Format::Off, &off, &["colour"], "\n3 3 1 2 1 0 0\n3 0 1 3 0 1 0\n");
    let obj = square_obj("g a\nusemtl m\nf 1 2 3\nusemtl n\ns 1\nf 1 3 4\n");
    let end = "\ng a\nusemtl m\nf 4 2 3\nusemtl n\ns 1\nf 1 2 4\n";
    flips_if_ignored(Format::Obj, &obj, &["usemtl", "s"], end);
}

#[test]
fn the_attribute_of_a_facet_stays_with_its_triangle() {
    let header = [[b'.'; 80].as_slice(), &2u32.to_le_bytes()].concat();
    let file = [header, facet([0, 1, 2], [1, 0]), facet([0, 2, 3], [2, 0])].concat();
    let (locked, _, written) = run(Format::Stl, &file, &[]);
    assert_eq!((locked, written.as_slice()), (locks(&["attribute"]), file.as_slice()));
    let (locked, triangles, written) = run(Format::Stl, &file, &["attribute"]);
    assert_eq!((locked, triangles.as_slice()), (locks(&[]), FLIPPED.as_slice()));
    assert_eq!((&written[132..134], &written[182..]), (&[1, 0][..], &[2, 0][..]));
}

#[test]
fn the_normal_of_a_facet_stays_with_its_triangle() {
    let obj = square_obj("vn 0 0 1\nvn 0 0.0001 1\nf 1//1 2//1 3//1\nf 1//2 3//2 4//2\n");
    flips_if_ignored(Format::Obj, &obj, &["vn"], "\nf 4//1 2//1 3//1\nf 1//2 2//2 4//2\n");
    // Each corner has a line of its own, with the same text.
    let obj = square_obj(
        "vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 2\nvn 0 0 2\nvn 0 0 2\nf 1//1 2//2 3//3\nf 1//4 3//5 4//6\n",
    );
    flips_if_ignored(Format::Obj, &obj, &["vn"], "\nf 4//1 2//1 3//1\nf 1//4 2//4 4//4\n");
}

#[test]
fn new_corners_have_what_their_vertex_had_beside_them() {
    let corners = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 5 5\nvt 6 6\n";
    let obj = square_obj(corners) + "vn 0 0 1\nf 1/1/1 2/2/1 3/3/1\nf 1/5/1 3/6/1 4/4/1\n";
    flips_if_ignored(Format::Obj, &obj, &["vt"], "\nf 4/4/1 2/2/1 3/3/1\nf 1/5/1 2/2/1 4/4/1\n");
    let properties = "property list uchar int vertex_indices\nproperty list uchar float texcoord\n";
    let ply = square_ply(properties, "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 5 5 6 6 0 1\n");
    let end = "\n3 3 1 2 6 0 1 1 0 1 1\n3 0 1 3 6 5 5 1 0 0 1\n";
    flips_if_ignored(Format::Ply, &ply, &["texcoord"], end);
    // One face without texture coordinates: the new triangle has none either, and the other has some at all corners.
    let ply = square_ply(properties, "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 0\n");
    flips_if_ignored(Format::Ply, &ply, &["texcoord"], "\n3 3 1 2 6 0 0 1 0 1 1\n3 0 1 3 0\n");
    let obj = square_obj(corners) + "f 1/1 2/2 3/3\nf 1 3 4\n";
    flips_if_ignored(Format::Obj, &obj, &["vt"], "\nf 4/1 2/2 3/3\nf 1 2 4\n");
}

#[test]
fn names_that_the_file_does_not_have_are_errors() {
    let properties =
        "property list uchar int vertex_indices\nproperty int id\nproperty list uchar float texcoord\n";
    let ply = square_ply(properties, "3 0 1 2 7 6 0 0 1 0 1 1\n3 0 2 3 8 6 0 0 1 1 0 1\n");
    let obj = square_obj("g a\nusemtl m\nvn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\n");
    let off = format!("OFF 4 2\n{}\n3 0 1 2\n3 0 2 3\n", SQUARE.join("\n"));
    let gltf = r#"{"asset":{"version":"2.0"}}"#;
    for (format, file, names) in [
        (Format::Ply, ply.as_str(), "`texcoord`, `id`"),
        (Format::Obj, &obj, "`vn`, `usemtl`, `g`"),
        (Format::Off, &off, "none"),
        (Format::Stl, "solid\nendsolid\n", "none"),
        (Format::Gltf, gltf, "none"),
    ] {
        let message = format!(
            "option ignore_attributes: no attribute of faces or corners is named `quality`; the file has: {names}"
        );
        for keep in [true, false] {
            let ignore_attributes = vec!["quality".to_owned()];
            let options = ReadOptions { ignore_attributes, keep, ..ReadOptions::default() };
            let error = parse(format, file.as_bytes(), &options).unwrap_err();
            assert_eq!(error.to_string(), message);
        }
        for name in names.split(", ").filter(|name| *name != "none") {
            read(format, file, &[name.trim_matches('`')]).unwrap();
        }
    }
}

/// A property that is there twice, in faces with and without texture coordinates.
#[test]
fn an_edge_counts_once_for_each_name() {
    let properties = "property list uchar int vertex_indices\nproperty int id\nproperty int id\n\
        property list uchar float texcoord\n";
    let ply = square_ply(properties, "3 0 1 2 7 1 6 0 0 1 0 1 1\n3 0 2 3 8 2 0\n");
    let (locked, _, _) = run(Format::Ply, ply, &[]);
    assert_eq!(locked, locks(&["texcoord", "id"]));
}

/// A grid of 5 × 5 squares in the plane, moved, with random diagonals, and random attributes.
struct Grid {
    file: String,
    triangles: Vec<[usize; 3]>,
    /// The material of each triangle, and for each of its corners the texture vertex and the normal.
    materials: Vec<u64>,
    corners: Vec<[[u64; 2]; 3]>,
}

impl Grid {
    fn new(random: &mut Rand64) -> Self {
        let mut file = String::new();
        for i in 0..36 {
            let [x, y] = [i % 6, i / 6].map(|at| f64::from(at) + 0.7 * random.rand_float());
            file += &format!("v {x:.4} {y:.4} 0\n");
        }
        for i in 0..4 {
            file += &format!("vt {i} 0\nvn 0 {i} 1\n");
        }
        let mut triangles = Vec::new();
        for a in (0..30).filter(|i| i % 6 < 5) {
            let [b, c, d] = [a + 1, a + 7, a + 6];
            let halves =
                if random.rand_float() < 0.5 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            triangles.extend(halves);
        }
        // Normals of facets, of corners, or missing; 0 is none.
        let kind = random.rand_range(0..4);
        let (mut materials, mut corners) = (Vec::new(), Vec::new());
        for triangle in &triangles {
            let material = random.rand_range(0..3) / 2;
            let vt = random.rand_range(0..9) / 8 + 1;
            let vn = [random.rand_range(1..5), 1, random.rand_range(0..5), 0][kind as usize];
            let own = triangle.map(|v| [vt, if kind == 1 { (v % 3 + 1) as u64 } else { vn }]);
            file += &format!("usemtl {material}\nf");
            for (v, [vt, vn]) in triangle.iter().zip(own) {
                file += &if vn > 0 { format!(" {}/{vt}/{vn}", v + 1) } else { format!(" {}/{vt}", v + 1) };
            }
            file.push('\n');
            materials.push(material);
            corners.push(own);
        }
        Self { file, triangles, materials, corners }
    }

    /// The edges that two triangles have, and the triangles.
    fn edges(&self) -> BTreeMap<[usize; 2], Vec<usize>> {
        let mut edges = BTreeMap::<_, Vec<usize>>::new();
        for (t, [a, b, c]) in self.triangles.iter().copied().enumerate() {
            for [u, v] in [[a, b], [b, c], [c, a]] {
                edges.entry([u.min(v), u.max(v)]).or_default().push(t);
            }
        }
        edges.retain(|_, triangles| triangles.len() == 2);
        edges
    }

    /// What a corner of a triangle refers to.
    fn at(&self, t: usize, vertex: usize) -> [u64; 2] {
        self.corners[t][self.triangles[t].iter().position(|&v| v == vertex).unwrap()]
    }
}

/// The vertex, the texture vertex and the normal of each corner, and the material of each face.
fn faces(file: &str) -> Vec<(u64, Vec<[u64; 3]>)> {
    let (mut material, mut faces) = (0, Vec::new());
    for line in file.lines() {
        if let Some(name) = line.strip_prefix("usemtl ") {
            material = name.parse().unwrap();
        } else if let Some(corners) = line.strip_prefix("f ") {
            let corner = |corner: &str| {
                let mut parts = corner.split('/').map(|part| part.parse().unwrap_or(0));
                [0; 3].map(|_| parts.next().unwrap_or(0))
            };
            faces.push((material, corners.split(' ').map(corner).collect()));
        }
    }
    faces
}

/// Any attributes of any files: the counts are those of the definition, and every triangle has what it had.
#[test]
fn what_is_ignored_stays_in_the_file() {
    let mut random = Rand64::new(4);
    let (mut flipped, mut freed) = (0, 0);
    for _ in 0..500 {
        let grid = Grid::new(&mut random);
        let loaded = read(Format::Obj, &grid.file, &[]).unwrap();
        let has_normals = grid.corners.as_flattened().iter().any(|corner| corner[1] > 0);
        let names = ["usemtl", "vt", "vn"];
        let ignored: Vec<&str> = names
            .into_iter()
            .filter(|name| random.rand_float() < 0.5 && (*name != "vn" || has_normals))
            .collect();
        // An edge for each name that locks it.
        let mut by_name = BTreeMap::new();
        let mut all = BTreeSet::new();
        for (edge, triangles) in grid.edges() {
            let [s, t] = [triangles[0], triangles[1]];
            let differs = |kind: usize| edge.iter().any(|&v| grid.at(s, v)[kind] != grid.at(t, v)[kind]);
            for (name, locks) in
                [("usemtl", grid.materials[s] != grid.materials[t]), ("vt", differs(0)), ("vn", differs(1))]
            {
                if locks && !ignored.contains(&name) {
                    *by_name.entry(name.to_owned()).or_insert(0) += 1;
                    all.insert(edge);
                }
            }
        }
        let (locked, triangles, written) = run(Format::Obj, &grid.file, &ignored);
        assert_eq!(locked.count, all.len());
        assert!(locked.by_name.is_sorted_by(|a, b| a.1 >= b.1));
        assert_eq!(locked.by_name.into_iter().collect::<BTreeMap<_, _>>(), by_name, "{}", grid.file);
        let written = faces(&text(written));
        assert_eq!(written.len(), grid.triangles.len());
        for (t, (material, corners)) in written.into_iter().enumerate() {
            let vertices: Vec<u64> = corners.iter().map(|corner| corner[0] - 1).collect();
            let after = &triangles[3 * t..3 * t + 3];
            assert!(vertices.iter().eq(after.iter().map(|&v| u64::from(v)).collect::<Vec<_>>().iter()));
            assert_eq!(material, grid.materials[t]);
            let own = grid.corners[t];
            let is_moved = after != &loaded.mesh.triangles()[3 * t..3 * t + 3];
            flipped += usize::from(is_moved);
            freed += usize::from(is_moved && !ignored.is_empty());
            for [vertex, vt, vn] in corners {
                let vertex = vertex as usize - 1;
                let old: Vec<usize> =
                    (0..grid.triangles.len()).filter(|&s| grid.triangles[s].contains(&vertex)).collect();
                for (kind, found) in [vt, vn].into_iter().enumerate() {
                    let values = own.map(|corner| corner[kind]);
                    if ignored.contains(&["vt", "vn"][kind]) && values == [values[0]; 3] {
                        assert_eq!(found, values[0]);
                    } else {
                        // A corner of an old triangle at that vertex has it.
                        assert!(old.iter().any(|&s| grid.at(s, vertex)[kind] == found));
                    }
                }
            }
        }
    }
    assert!(flipped > 5000 && freed > 3000, "{flipped} {freed}");
}
