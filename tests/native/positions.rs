//! A session whose vertices have moved equals a new one on its present triangles, on the CPU and the GPU, if it only flips.
#![cfg(feature = "gpu")]

use crate::{matrix, meshes};
use edgeflip::{Backend, Error, Mesh, Options, Order, Outcome, Positions, Session, Timings};
use oorandom::Rand64;
use pollster::block_on;

/// An outcome without times and dispatches.
fn said(mut session: Session) -> (Outcome, String, Session) {
    let mut outcome = block_on(session.outcome()).unwrap();
    (outcome.timings, outcome.dispatches, outcome.device_bytes, outcome.fallback) =
        (Timings::default(), 0, 0, None);
    let audit = block_on(session.verify()).unwrap();
    (outcome, format!("{audit:?}"), session)
}

/// Moves the vertices, and compares the session with a new one on the same mesh after every iteration. Returns the
/// session, and whether the backend accepted the positions.
fn compare(
    name: &str,
    mut session: Session,
    positions: &Positions,
    mesh: &Mesh,
    options: &Options,
) -> (Session, bool) {
    let before = block_on(session.triangles()).unwrap();
    let moved = Mesh::new(mesh.dimension(), positions.clone(), before.clone()).unwrap();
    let mut fresh = match block_on(Session::new(moved, options.clone())) {
        Ok(fresh) => fresh,
        Err(Error::BackendLimit { .. }) => {
            let (outcome, audit, mut session) = said(session);
            let refused = block_on(session.set_positions(positions.clone()));
            assert!(matches!(refused, Err(Error::BackendLimit { .. })), "{name}");
            let (after, audit_after, session) = said(session);
            assert_eq!((outcome, audit), (after, audit_after), "{name}: refused positions change nothing");
            return (session, false);
        }
        Err(error) => panic!("{name}: {error}"),
    };
    block_on(session.set_positions(positions.clone())).unwrap();
    assert_eq!((session.iterations(), session.flips()), (0, 0), "{name}");
    loop {
        let name = format!("{name}, iteration {}", fresh.iterations());
        assert_eq!(
            block_on(session.edge_states()).unwrap(),
            block_on(fresh.edge_states()).unwrap(),
            "{name}: states"
        );
        let [step, want] = [&mut session, &mut fresh].map(|session| {
            block_on(session.step())
                .unwrap()
                .map(|step| (step.index, step.labelled, step.flips, step.blocked))
        });
        assert_eq!(step, want, "{name}");
        assert_eq!(block_on(session.triangles()).unwrap(), block_on(fresh.triangles()).unwrap(), "{name}");
        if step.is_none() {
            break;
        }
    }
    let (outcome, audit, session) = said(session);
    let (want, audit_wanted, _) = said(fresh);
    assert_eq!(outcome, want, "{name}");
    assert_eq!(audit, audit_wanted, "{name}");
    (session, true)
}

/// Moved positions of the vertices, as 32-bit floats: shaken; stretched and mirrored; folded over; all at one position.
fn moves(mesh: &Mesh) -> Vec<Positions> {
    let mut random = Rand64::new(7);
    let mapped = |map: &mut dyn FnMut([f32; 3]) -> [f32; 3]| {
        let finite = |p: [f32; 3]| p.map(|x| x.clamp(f32::MIN, f32::MAX));
        meshes::moved(mesh, |p| finite(map(finite(p)))).positions().clone()
    };
    // Multiples of powers of two have few bits, so the GPU accepts them.
    let shaken =
        &mut |p: [f32; 3]| p.map(|x| x + x.abs().max(0.0625) * (random.rand_range(0..8) as f32 / 16.0));
    let mirrored = &mut |[x, y, z]: [f32; 3]| [-x, 4.0 * y, 0.5 * z];
    let folded = &mut |[x, y, z]: [f32; 3]| [(x - 0.5).abs(), y, z + 0.5 * y];
    vec![mapped(shaken), mapped(mirrored), mapped(folded), vec![0f32; mesh.positions().len()].into()]
}

fn deform(name: &str, mesh: &Mesh, options: &Options) -> u32 {
    let mut taken = 0;
    let Ok(mut session) = block_on(Session::new(mesh.clone(), options.clone())) else { return 0 };
    // First in the middle of a run, later at its end.
    block_on(session.step()).unwrap();
    for (positions, number) in moves(mesh).iter().chain([mesh.positions()]).zip(0..) {
        let name = format!("{name}, {:?}, move {number}", options.backend);
        let fits;
        (session, fits) = compare(&name, session, positions, mesh, options);
        taken += u32::from(fits);
    }
    taken
}

#[test]
fn a_session_with_moved_vertices_equals_a_new_one() {
    let (mut on_cpu, mut on_gpu) = (0, 0);
    for case in matrix::cases().iter().filter(|case| case.mesh.triangle_count() <= 500) {
        let options = Options { untangle: Some(false), ..case.options(Backend::Cpu) };
        on_cpu += deform(&case.name, &case.mesh, &options);
        if case.mesh.triangle_count() <= 130 {
            on_gpu += deform(&case.name, &case.mesh, &Options { backend: Backend::Gpu, ..options });
        }
    }
    assert!(on_cpu > 400 && on_gpu > 200, "{on_cpu} on the CPU, {on_gpu} on the GPU");
}

#[test]
fn with_lawsons_algorithm_it_equals_a_new_one_too() {
    for spec in ["random 12", "uvsphere 9"] {
        let mesh = edgeflip::families::by_name(spec).unwrap();
        let options =
            Options { backend: Backend::Cpu, order: Order::Any, untangle: Some(false), ..Options::default() };
        assert_eq!(deform(spec, &mesh, &options), 5);
    }
}

/// The engine runs by sweeps and by lists. Stamps of the lists must not outlive a move.
#[test]
fn batches_after_a_move_are_those_of_a_new_session() {
    let mesh = edgeflip::families::by_name("strips 200").unwrap();
    let options = |backend| Options { backend, untangle: Some(false), ..Options::default() };
    let mut session = block_on(Session::new(mesh.clone(), options(Backend::Gpu))).unwrap();
    for positions in moves(&mesh).iter().take(2).chain([mesh.positions()]) {
        block_on(session.run(|_, _| std::ops::ControlFlow::Continue(()))).unwrap();
        let triangles = block_on(session.triangles()).unwrap();
        let moved = Mesh::new(mesh.dimension(), positions.clone(), triangles).unwrap();
        block_on(session.set_positions(positions.clone())).unwrap();
        let mut fresh = block_on(Session::new(moved, options(Backend::Cpu))).unwrap();
        for session in [&mut session, &mut fresh] {
            block_on(session.run(|_, _| std::ops::ControlFlow::Continue(()))).unwrap();
        }
        let [outcome, want] = [&mut session, &mut fresh].map(|session| block_on(session.outcome()).unwrap());
        assert_eq!(outcome.triangles, want.triangles);
        assert_eq!(outcome.flips_per_iteration, want.flips_per_iteration);
    }
}

#[test]
fn bad_positions_change_nothing() {
    let mesh = edgeflip::families::by_name("random 8").unwrap();
    for backend in [Backend::Cpu, Backend::Gpu] {
        let options = Options { backend, ..Options::default() };
        let mut session = block_on(Session::new(mesh.clone(), options)).unwrap();
        block_on(session.step()).unwrap();
        let (outcome, audit, mut session) = said(session);
        let error = block_on(session.set_positions(vec![0f32; 3])).unwrap_err();
        assert_eq!(error.to_string(), "positions has 3 numbers, but the vertices of the mesh take 128");
        let mut positions = mesh.positions().to_f32();
        positions[5] = f32::NAN;
        let error = block_on(session.set_positions(positions)).unwrap_err();
        assert!(matches!(error, Error::NonFinite { vertex: 2, axis: 'y', .. }), "{error}");
        let (after, audit_after, _) = said(session);
        assert_eq!((outcome, audit), (after, audit_after));
    }
}
