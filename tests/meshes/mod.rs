//! The meshes that every engine is tested on: small families, dirty meshes, extreme coordinates.
#![allow(dead_code, unused_imports, reason = "each test crate takes what it needs of this module")]
#![allow(clippy::unwrap_used, reason = "a test that cannot make its mesh must stop")]

mod deviation;
pub mod dirty;
mod extreme;
mod locked;

pub use dirty::soup;
pub use locked::edges;

use edgeflip::{Backend, Dimension, Mesh, Options, families::by_name};
use oorandom::Rand64;

/// A mesh with a name and the options of its runs: β in degrees (without effect in 2D), and the locked edges.
pub struct Case {
    pub name: String,
    pub mesh: Mesh,
    pub beta: f64,
    pub locked: Vec<[u32; 2]>,
    /// The limit of the deviation (without effect in 2D).
    pub deviation: f64,
}

impl Case {
    pub fn options(&self, backend: Backend) -> Options {
        let locked_edges = self.locked.clone();
        let (max_normal_angle, max_deviation) = (self.beta, self.deviation);
        Options { backend, max_normal_angle, max_deviation, locked_edges, ..Options::default() }
    }
}

/// All cases. `(name, beta)` is unique, names have no spaces.
pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    for spec in [
        "grid 25",
        "random 25",
        "random 40",
        "shear 25",
        "shear 20 30",
        "regular 20",
        "regular 20 100000",
        "strips 8",
        "strips 12",
        "strips 16",
        "strips 200",
        "strips 1000",
        "fan2 50",
        "fan2 300",
        "sweep 300",
        "sweep 1000",
        "shuffled random 25",
    ] {
        cases.push(case(&spec.replace(' ', "-"), by_name(spec).unwrap(), 10.0));
    }
    for spec in
        ["uvsphere 20", "shuffled uvsphere 20", "roof 10", "pole 100", "pillow 3", "pillow 3 0.9", "pillow 8"]
    {
        for beta in [0.0, 10.0, 60.0, 90.0, 180.0] {
            cases.push(case(&spec.replace(' ', "-"), by_name(spec).unwrap(), beta));
        }
    }
    cases.push(case("uvsphere-45", by_name("uvsphere 45").unwrap(), 10.0));
    for spec in ["regular 200", "regular 200 100000"] {
        let (name, lattice) = (spec.replace(' ', "-"), by_name(spec).unwrap());
        cases.push(case(&format!("{name}-one-ulp"), off_by_one_ulp(&lattice), 10.0));
        cases.push(case(&name, lattice, 10.0));
    }
    cases.extend(surfaces());
    cases.extend(dirty::all());
    cases.extend(extreme::all());
    cases.extend(locked::all());
    cases.extend(deviation::all());
    cases
}

pub fn case(name: &str, mesh: Mesh, beta: f64) -> Case {
    Case { name: name.into(), mesh, beta, locked: Vec::new(), deviation: f64::INFINITY }
}

/// A small mesh written down.
pub fn plane(points: &[[f32; 2]], triangles: &[[u32; 3]]) -> Mesh {
    Mesh::new(Dimension::Two, points.concat(), triangles.concat()).unwrap()
}

/// A small mesh written down.
pub fn space(points: &[[f32; 3]], triangles: &[[u32; 3]]) -> Mesh {
    Mesh::new(Dimension::Three, points.concat(), triangles.concat()).unwrap()
}

/// The mesh with every vertex moved. In 2D, `map` gets 0 as the third number, and the third number of its result is
/// dropped.
pub fn moved(mesh: &Mesh, mut map: impl FnMut([f32; 3]) -> [f32; 3]) -> Mesh {
    let stride = mesh.dimension().stride();
    let move_one = |p: &[f32]| map([p[0], p[1], p.get(2).copied().unwrap_or(0.0)])[..stride].to_vec();
    let positions: Vec<_> = mesh.positions().to_f32().chunks(stride).flat_map(move_one).collect();
    Mesh::new(mesh.dimension(), positions, mesh.triangles().to_vec()).unwrap()
}

/// The mesh with every vertex moved, in doubles.
pub fn moved_wide(mesh: &Mesh, mut map: impl FnMut([f64; 2]) -> Vec<f64>) -> Mesh {
    let numbers: Vec<_> = mesh.positions().iter().collect();
    let positions: Vec<_> = numbers.chunks(2).flat_map(|p| map([p[0], p[1]])).collect();
    let dimension = if positions.len() == numbers.len() { Dimension::Two } else { Dimension::Three };
    Mesh::new(dimension, positions, mesh.triangles().to_vec()).unwrap()
}

/// The mesh with half of its coordinates moved to the next float, up or down. Zeros stay: the float next to 0 is beyond
/// the span that the GPU engines decide.
pub fn off_by_one_ulp(mesh: &Mesh) -> Mesh {
    let noisy = |(x, i): (f32, u32)| match i.wrapping_mul(0x9e37_79b9) >> 30 {
        _ if x == 0.0 => x,
        0 => x.next_up(),
        1 => x.next_down(),
        _ => x,
    };
    let positions: Vec<f32> = mesh.positions().to_f32().into_iter().zip(0..).map(noisy).collect();
    Mesh::new(mesh.dimension(), positions, mesh.triangles().to_vec()).unwrap()
}

/// A 2D mesh as a surface over the plane.
pub fn lifted(mesh: &Mesh, mut height: impl FnMut(f32, f32) -> f32) -> Mesh {
    let lift = |p: &[f32]| [p[0], p[1], height(p[0], p[1])];
    let positions: Vec<_> = mesh.positions().to_f32().chunks(2).flat_map(lift).collect();
    Mesh::new(Dimension::Three, positions, mesh.triangles().to_vec()).unwrap()
}

/// The mesh with all triangles reversed.
pub fn reversed(mesh: &Mesh) -> Mesh {
    mesh.with_triangles(mesh.triangles().chunks(3).flat_map(|t| [t[0], t[2], t[1]]).collect()).unwrap()
}

/// Both meshes, without a common vertex.
pub fn joined(first: &Mesh, second: &Mesh) -> Mesh {
    let offset = first.vertex_count() as u32;
    let positions = [first, second].map(|mesh| mesh.positions().to_f32()).concat();
    let triangles = first.triangles().iter().copied().chain(second.triangles().iter().map(|v| v + offset));
    Mesh::new(first.dimension(), positions, triangles.collect()).unwrap()
}

/// A number in [-1, 1).
pub fn signed(random: &mut Rand64) -> f32 {
    (2.0 * random.rand_float() - 1.0) as f32
}

/// Curved surfaces on which angle, fold and duplicate all matter.
fn surfaces() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut random = Rand64::new(3);
    let noisy = moved(&by_name("uvsphere 16 0").unwrap(), |p| {
        let radius = 1.0 + 0.5 * signed(&mut random);
        p.map(|x| x * radius)
    });
    for beta in [60.0, 90.0, 120.0, 150.0, 180.0] {
        cases.push(case("uvsphere-noisy", noisy.clone(), beta));
    }
    let coarse =
        moved(&by_name("uvsphere 5 0").unwrap(), |p| p.map(|x| x * (1.0 + 0.8 * signed(&mut random))));
    for beta in [90.0, 180.0] {
        cases.push(case("uvsphere-coarse", coarse.clone(), beta));
    }

    let flat = by_name("random 25").unwrap();
    cases.push(case("lifted-flat", lifted(&flat, |_, _| 0.0), 0.0));
    cases.push(case("lifted-flat", lifted(&flat, |_, _| 0.0), 180.0));
    let lattice = by_name("regular 12").unwrap();
    cases.push(case("lifted-lattice", lifted(&lattice, |x, y| x - y), 10.0));
    for beta in [10.0, 60.0] {
        cases.push(case("terrain", lifted(&flat, |x, y| 0.2 * x * y), beta));
        let mut random = Rand64::new(4);
        cases.push(case("terrain-noisy", lifted(&flat, |_, _| 0.01 * signed(&mut random)), beta));
    }
    for (n, beta) in [(3, 180.0), (4, 90.0), (4, 180.0), (7, 120.0), (7, 180.0)] {
        cases.push(case(&format!("torus-{n}"), torus(n), beta));
    }
    cases
}

/// A jittered torus of n x n vertices: with n = 3 every vertex is joined to nearly every other.
fn torus(n: u32) -> Mesh {
    let mut random = Rand64::new(5);
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let mut angle = |k: u32| {
                std::f64::consts::TAU * (f64::from(k) + 0.4 * f64::from(signed(&mut random))) / f64::from(n)
            };
            let ((sin, cos), (y, x)) = (libm::sincos(angle(j)), libm::sincos(angle(i)));
            let ring = 2.0 + cos;
            points.push([(ring * x) as f32, (ring * y) as f32, sin as f32]);
            let at = |i: u32, j: u32| (j % n) * n + i % n;
            let [p, q, r, s] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[p, q, r], [p, r, s]]);
        }
    }
    space(&points, &triangles)
}
