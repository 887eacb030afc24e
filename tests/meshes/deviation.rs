//! Surfaces with a limit for the deviation: a small limit, a limit that some flips meet exactly, or none.

use super::{Case, case, lifted, moved, signed, soup};
use edgeflip::{Mesh, families::by_name};
use oorandom::Rand64;

pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |name: &str, mesh: &Mesh, beta: f64, limits: &[f64]| {
        for (index, &deviation) in limits.iter().enumerate() {
            let name = format!("deviation-{name}-{index}");
            cases.push(Case { deviation, ..case(&name, mesh.clone(), beta) });
        }
    };
    let sphere = by_name("uvsphere 14").unwrap();
    add("sphere", &sphere, 180.0, &[0.0, 0.003, 0.03, 1e30]);
    add("sphere-beta", &sphere, 20.0, &[0.01]);
    add("sphere-f64", &wide(&sphere, f64::EPSILON), 180.0, &[1e-12, 0.003, 1e30]);
    add("pole", &by_name("pole 40").unwrap(), 180.0, &[0.003]);

    // Diagonals at the heights 0 and 0.01, in parallel planes.
    let height = 0.01f32;
    let limits = [height.next_down(), height, height.next_up()].map(f64::from);
    let steps = lattice(height);
    add("steps", &steps, 180.0, &limits);
    // In doubles. No limit equals the height of the steps.
    add("steps-f64", &wide(&steps, 1e-9), 180.0, &limits[1..]);
    for (name, scale) in [("large", 2f32.powi(100)), ("small", 2f32.powi(-100))] {
        let steps = moved(&steps, |p| p.map(|x| x * scale));
        add(
            &format!("steps-{name}"),
            &steps,
            180.0,
            &limits[..2].iter().map(|limit| limit * f64::from(scale)).collect::<Vec<_>>(),
        );
    }
    // Every difference is rounded.
    add("steps-far", &moved(&steps, |[x, y, z]| [x + 3000.0, y - 7000.0, z]), 180.0, &limits[..2]);

    let mut random = Rand64::new(29);
    let noisy = lifted(&by_name("random 16").unwrap(), |_, _| 0.02 * signed(&mut random));
    add("noise", &noisy, 120.0, &[0.005, 0.02]);
    for seed in 1..3 {
        let (_, bent) = soup(seed, 7, 8);
        add(&format!("soup-{seed}"), &bent, 180.0, &[0.0, 1.0]);
    }
    cases
}

/// A sheared lattice, every other vertex of which is raised.
fn lattice(height: f32) -> Mesh {
    let lattice = by_name("regular 12").unwrap();
    // The lattice's spacing is 0.1.
    let is_raised = |x: f32, y: f32| ((10.0 * x).round() + (10.0 * y).round()) % 2.0 != 0.0;
    let steps = lifted(&lattice, |x, y| if is_raised(x, y) { height } else { 0.0 });
    moved(&steps, |[x, y, z]| [x - 0.7 * y, y, z])
}

/// The mesh scaled up by a factor so near to 1 that 32-bit floats cannot hold the result.
fn wide(mesh: &Mesh, more: f64) -> Mesh {
    let positions: Vec<f64> = mesh.positions().iter().map(|x| x * (1.0 + more)).collect();
    Mesh::new(mesh.dimension(), positions, mesh.triangles().to_vec()).unwrap()
}
