//! Meshes at full size on which other programs cycle, hang or leave wrong edges: each run ends, and the audit agrees.

use edgeflip::quality::audit;
use edgeflip::{Backend, Dimension, Mesh, Options, Order, Outcome, Reason, Status, families, make_delaunay};
use std::ops::ControlFlow;

fn flipped(mesh: &Mesh, options: &Options) -> Outcome {
    make_delaunay(mesh, options, |_, _| ControlFlow::Continue(())).unwrap()
}

/// Runs `mesh` to the end with the phases and with Lawson's algorithm. Returns the outcome of the phases.
fn run(name: &str, mesh: &Mesh, beta: f64) -> Outcome {
    let options = Options { backend: Backend::Cpu, max_normal_angle: beta, ..Options::default() };
    let any = flipped(mesh, &Options { order: Order::Any, ..options.clone() });
    let outcome = flipped(mesh, &options);
    for outcome in [&any, &outcome] {
        assert_eq!(outcome.status, Status::Done, "{name}");
        let audit = audit(mesh, &outcome.triangles, &options);
        assert!(audit.is_clean(), "{name}: {:?}", audit.violations);
        assert_eq!(audit.remaining, outcome.remaining, "{name}");
        assert_eq!(outcome.remaining[Reason::Stopped], 0, "{name}");
        if mesh.dimension() == Dimension::Two {
            assert_eq!(outcome.remaining.total(), 0, "{name}");
        }
    }
    outcome
}

fn family(spec: &str, beta: f64) -> Outcome {
    run(spec, &families::by_name(spec).unwrap(), beta)
}

#[test]
fn nearly_collinear_fans_end() {
    for spec in ["fan2 100", "fan2 1000"] {
        assert!(family(spec, 10.0).flips > 0);
    }
}

#[test]
fn the_worst_case_of_the_paper_takes_all_its_flips() {
    let outcome = family("strips 1000", 10.0);
    assert_eq!((outcome.iterations, outcome.flips), (997, 249_001));
    // As in figure 12 of the paper, most flips are in the middle of the run.
    let peak = outcome.flips_per_iteration.iter().position(|&flips| flips == 499);
    assert_eq!(peak, Some(498));
}

#[test]
fn a_sweep_triangulation_ends() {
    assert!(family("sweep 100000", 10.0).flips > 1_000_000);
}

#[test]
fn spheres_keep_their_poles_and_creases() {
    for (spec, beta) in
        [("uvsphere 200", 10.0), ("uvsphere 45", 10.0), ("uvsphere 100 0.3", 10.0), ("pole 5000", 180.0)]
    {
        let outcome = family(spec, beta);
        assert!(outcome.flips > 0 || spec.starts_with("pole"), "{spec}");
    }
}

#[test]
fn a_pillow_gets_no_edge_twice() {
    for spec in ["pillow 3", "pillow 4", "pillow 1000"] {
        family(spec, 180.0);
    }
}

#[test]
fn a_roof_keeps_its_ridge() {
    let outcome = family("roof 100", 10.0);
    assert!(outcome.flips > 0 && outcome.remaining[Reason::Angle] > 0);
}

#[test]
fn a_clockwise_mesh_flips_like_its_mirror_image() {
    let mesh = families::by_name("random 100").unwrap();
    let mirrored: Vec<f32> = mesh.positions().to_f32().chunks(2).flat_map(|p| [-p[0], p[1]]).collect();
    let clockwise = Mesh::new(Dimension::Two, mirrored, mesh.triangles().to_vec()).unwrap();
    assert_eq!(run("clockwise", &clockwise, 10.0).triangles, run("mirrored", &mesh, 10.0).triangles);
}

/// Two meshes that share one vertex.
#[test]
fn a_bow_tie_is_two_meshes() {
    let mesh = families::by_name("random 30").unwrap();
    let count = mesh.vertex_count() as u32;
    // The second mesh is the first, rotated by 180° about the common vertex 0, which is a corner of both.
    let mut positions = mesh.positions().to_f32();
    let (x, y) = (positions[0], positions[1]);
    let turned: Vec<_> = positions[2..].chunks(2).flat_map(|p| [2.0 * x - p[0], 2.0 * y - p[1]]).collect();
    positions.extend(turned);
    let mut triangles = mesh.triangles().to_vec();
    triangles.extend(mesh.triangles().iter().map(|&v| if v == 0 { 0 } else { v + count - 1 }));
    let bow_tie = Mesh::new(Dimension::Two, positions, triangles).unwrap();
    let (one, both) = (run("half", &mesh, 10.0), run("bow-tie", &bow_tie, 10.0));
    assert!(both.flips > one.flips);
}
