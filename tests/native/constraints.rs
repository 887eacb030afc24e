//! Constraints before a run: every engine has the same triangles as a run that starts with the constraints in place, and
//! the audit, which finds the constraints by itself, is clean. It is not if one is missing.
#![cfg(feature = "gpu")]

use crate::meshes;
use crate::runs::{options, unwatched, watched};
use edgeflip::quality::{Violation, audit};
use edgeflip::{Backend, Mesh, Options, Order, Reason, Session, constrained, families::by_name};
use oorandom::Rand64;
use pollster::block_on;

/// Up to twelve random pairs of vertices.
fn random_pairs(mesh: &Mesh, random: &mut Rand64) -> Vec<[u32; 2]> {
    let count = mesh.vertex_count() as u64;
    let mut pair = || [random.rand_range(0..count) as u32, random.rand_range(0..count) as u32];
    (0..12).map(|_| pair()).filter(|[u, v]| u != v).collect()
}

#[test]
fn every_engine_goes_on_from_the_constraints() {
    let mut random = Rand64::new(5);
    for name in ["random 12", "shear 12", "regular 9", "sweep 60", "strips 30", "fan2 20"] {
        let mesh = by_name(name).unwrap();
        let with = |backend, constraints: &[[u32; 2]]| Options {
            constraints: constraints.to_vec(),
            skips_constraints: true,
            ..options(backend, 10.0)
        };
        for _ in 0..8 {
            let constraints = random_pairs(&mesh, &mut random);
            let inserted = constrained(&mesh, &constraints, &[], true, 0.0, None).unwrap();
            let locks = Options { locked_edges: inserted.locked_edges, ..options(Backend::Cpu, 10.0) };
            let want = watched(&inserted.mesh, &locks).unwrap();
            for backend in [Backend::Cpu, Backend::Gpu] {
                assert_eq!(
                    watched(&mesh, &with(backend, &constraints)).unwrap(),
                    want,
                    "{name}, {backend:?}"
                );
            }
            let any = Options { order: Order::Any, ..with(Backend::Cpu, &constraints) };
            let any = unwatched(&mesh, &any).unwrap();
            assert_eq!((any.crossed_edges, &any.left_out), (inserted.crossed_edges, &inserted.left_out));
            // Without those left out, no constraint may be missing.
            let is_in = |i: &usize| inserted.left_out.iter().all(|left| left.index != *i);
            let kept: Vec<_> = (0..constraints.len()).filter(is_in).map(|i| constraints[i]).collect();
            let options = Options { skips_constraints: false, ..with(Backend::Cpu, &kept) };
            for (triangles, remaining) in [(&want.triangles, want.remaining), (&any.triangles, any.remaining)]
            {
                let audit = audit(&mesh, triangles, &options);
                assert!(audit.is_clean(), "{name}: {:?}", audit.violations);
                assert_eq!(audit.remaining, remaining, "{name}");
                assert_eq!(remaining.total(), remaining[Reason::Locked], "{name}");
            }
        }
    }
}

#[test]
fn the_audit_finds_a_missing_constraint() {
    let mesh = meshes::plane(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], &[[0, 1, 2], [0, 2, 3]]);
    let options = Options { constraints: vec![[3, 1]], ..options(Backend::Cpu, 10.0) };
    let audit = audit(&mesh, mesh.triangles(), &options);
    assert_eq!(audit.violations, [Violation::Constraint { u: 3, v: 1 }]);
}

#[test]
fn locks_by_triangle_and_by_group_stay() {
    let mesh = by_name("random 9").unwrap();
    let groups: Vec<u32> = (0..mesh.triangle_count() as u32).map(|t| t / 40).collect();
    let given = Options {
        groups,
        locked_triangles: vec![3, 70],
        constraints: vec![[0, 80], [8, 72]],
        skips_constraints: true,
        ..options(Backend::Cpu, 10.0)
    };
    let outcome = unwatched(&mesh, &given).unwrap();
    let audit = audit(&mesh, &outcome.triangles, &given);
    assert!(audit.is_clean(), "{:?}", audit.violations);
    assert_eq!(outcome.left_out.len(), 2);
}

#[test]
fn constraints_stay_while_the_mesh_moves() {
    let mesh = by_name("random 12").unwrap();
    let constraints = vec![[0, 143], [11, 3]];
    let inserted = constrained(&mesh, &constraints, &[], true, 0.0, None).unwrap();
    let options = Options { constraints, skips_constraints: true, ..options(Backend::Cpu, 10.0) };
    let mut session = block_on(Session::new(mesh.clone(), options)).unwrap();
    for frame in 0..3 {
        let sheared = meshes::moved_wide(&mesh, |[x, y]| vec![x + f64::from(frame) * y, y]);
        block_on(session.set_positions(sheared.positions().clone())).unwrap();
        block_on(session.run(|_, _| std::ops::ControlFlow::Continue(()))).unwrap();
        let moved = mesh.with_triangles(block_on(session.triangles()).unwrap()).unwrap();
        let edges = meshes::edges(&moved);
        let has = |[u, v]: [u32; 2]| edges.contains(&[u, v]) || edges.contains(&[v, u]);
        assert!(inserted.locked_edges.iter().all(|&pair| has(pair)));
        assert!(block_on(session.verify()).unwrap().is_clean());
    }
}
