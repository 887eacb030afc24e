//! Meshes with locked edges, across, around, everywhere and where they change nothing.

use super::{Case, case, joined, reversed, soup};
use edgeflip::{Edges, Mesh, NONE, families::by_name};

pub fn all() -> Vec<Case> {
    let mut cases = vec![
        locked("locked-polyline", random(25), 10.0, polyline),
        locked("locked-boundary", random(12), 10.0, boundary),
        locked("locked-all", random(12), 10.0, every(1)),
        locked("locked-all-3d", by_name("uvsphere 12").unwrap(), 10.0, every(1)),
        locked("locked-mixed-components", joined(&random(8), &reversed(&random(9))), 10.0, every(6)),
    ];
    for beta in [0.0, 10.0, 180.0] {
        cases.push(locked("locked-belt", by_name("uvsphere 20").unwrap(), beta, belt));
        cases.push(locked("locked-roof", by_name("roof 10").unwrap(), beta, every(5)));
    }
    for seed in 0..4 {
        let (flat, bent) = soup(seed, 4 + seed as usize / 2, 1 + 3 * seed as usize);
        cases.push(locked(&format!("locked-soup-{seed}"), flat, 10.0, every(4)));
        for beta in [90.0, 180.0] {
            cases.push(locked(&format!("locked-soup-{seed}-3d"), bent.clone(), beta, every(4)));
        }
    }
    cases
}

fn random(n: usize) -> Mesh {
    by_name(&format!("random {n}")).unwrap()
}

fn locked(name: &str, mesh: Mesh, beta: f64, choose: impl Fn(&Mesh) -> Vec<[u32; 2]>) -> Case {
    Case { locked: choose(&mesh), ..case(name, mesh, beta) }
}

/// The vertices of each edge, as [`Edges`] has them.
pub fn edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    let Edges { v1, v2, .. } = Edges::new(mesh.vertex_count(), mesh.triangles());
    v1.into_iter().zip(v2).map(|(u, v)| [u, v]).collect()
}

/// Every `n`th edge, half of them the other way round, and the first one twice.
fn every(n: usize) -> impl Fn(&Mesh) -> Vec<[u32; 2]> {
    let turned = |(i, [u, v]): (usize, [u32; 2])| if i % 2 == 0 { [u, v] } else { [v, u] };
    move |mesh| {
        let mut pairs: Vec<_> = edges(mesh).into_iter().step_by(n).enumerate().map(turned).collect();
        pairs.extend(pairs.first().copied());
        pairs
    }
}

/// The edges with one triangle of a mesh without frozen edges.
fn boundary(mesh: &Mesh) -> Vec<[u32; 2]> {
    let Edges { tb, .. } = Edges::new(mesh.vertex_count(), mesh.triangles());
    let is_boundary = |&(_, &tb): &(_, &u32)| tb == NONE;
    edges(mesh).into_iter().zip(&tb).filter(is_boundary).map(|(pair, _)| pair).collect()
}

/// A path across a mesh in the plane, from each vertex to its neighbour furthest to the right.
fn polyline(mesh: &Mesh) -> Vec<[u32; 2]> {
    let positions = mesh.positions().to_f32();
    let x = |v: u32| positions[2 * v as usize];
    let all = edges(mesh);
    let neighbours = |u: u32| all.iter().filter(move |pair| pair.contains(&u)).map(move |[v, w]| v ^ w ^ u);
    let rightmost = |u: u32| neighbours(u).max_by(|&v, &w| x(v).total_cmp(&x(w)));
    let mut at = (0..mesh.vertex_count() as u32).min_by(|&v, &w| x(v).total_cmp(&x(w))).unwrap();
    let mut path = Vec::new();
    while let Some(next) = rightmost(at).filter(|&next| x(next) > x(at)) {
        path.push([at, next]);
        at = next;
    }
    path
}

/// The edges of a sphere of rings of 20 vertices that lie in two strips between three of its rings.
fn belt(mesh: &Mesh) -> Vec<[u32; 2]> {
    let rings = 1 + 3 * 20..1 + 6 * 20;
    edges(mesh).into_iter().filter(|pair| pair.iter().all(|v| rings.contains(v))).collect()
}
