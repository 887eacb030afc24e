//! Sessions whose device is lost, refuses the mesh, or becomes ready during the run.

#![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

use super::*;
use crate::Backend;
use crate::engine::{Answer, Census, Cpu, EdgeCounts, Moved};
use crate::mesh::areas::Areas;
use crate::mesh::named_edges;
use crate::system::threads::Threads;
use pollster::block_on;

/// An engine that fails after `questions_left` questions: its device is lost, or it refuses the mesh.
struct Failing {
    cpu: Cpu,
    questions_left: u32,
    refuses: bool,
}

impl Failing {
    fn answer<'a, T: 'a>(&'a mut self, ask: impl FnOnce(&'a mut Cpu) -> Answer<'a, T>) -> Answer<'a, T> {
        if self.questions_left == 0 {
            let message = "lost on purpose".to_owned();
            let limit = Error::BackendLimit { backend: EngineKind::Gpu, message: message.clone() };
            let error = if self.refuses { limit } else { Error::Device { message } };
            return Box::pin(std::future::ready(Err(error)));
        }
        self.questions_left -= 1;
        ask(&mut self.cpu)
    }
}

impl Engine for Failing {
    fn batch(&self) -> u32 {
        2
    }
    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        self.cpu.lock(half_edges)
    }
    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        self.answer(|cpu| cpu.iterate(count))
    }
    fn census(&mut self) -> Answer<'_, Census> {
        self.answer(|cpu| cpu.census())
    }
    fn areas(&mut self) -> Answer<'_, Areas> {
        self.answer(|cpu| cpu.areas())
    }
    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        self.answer(|cpu| Engine::triangles(cpu))
    }
    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        self.answer(|cpu| Engine::twins(cpu))
    }
    fn set_positions(&mut self, mesh: Arc<Mesh>, twins: Option<Vec<u32>>) -> Answer<'_, ()> {
        self.answer(|cpu| cpu.set_positions(mesh, twins))
    }
    fn update(
        &mut self,
        positions: Option<Positions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), Error> {
        self.cpu.update(positions, iterations, untangles)
    }
    fn moved(&mut self) -> Answer<'static, Moved> {
        self.cpu.moved()
    }
    fn track_changes(&mut self) -> Answer<'_, ()> {
        self.cpu.track_changes()
    }
    fn changes(&mut self) -> Answer<'_, Vec<u32>> {
        self.answer(|cpu| cpu.changes())
    }
    fn positions(&mut self) -> Answer<'_, Positions> {
        self.answer(|cpu| cpu.positions())
    }
    fn edge_counts(&self) -> EdgeCounts {
        self.cpu.edge_counts()
    }
    fn backend(&self) -> EngineKind {
        EngineKind::Gpu
    }
}

/// One edge of every fifth triangle is locked.
fn session(backend: Backend, questions_left: u32) -> Session {
    let mesh = crate::families::by_name("random 20").unwrap();
    let locked_edges = mesh.triangles().chunks(15).map(|t| [t[0], t[1]]).collect();
    let options = Options { backend: Backend::Cpu, locked_edges, ..Options::default() };
    let mut session = block_on(Session::new(mesh, options)).unwrap();
    let mut cpu = Cpu::new(session.mesh.clone(), Thresholds::from(&session.options), Threads::default());
    block_on(cpu.lock(named_edges::half_edges(&session.mesh, &session.options.locked_edges).unwrap()))
        .unwrap();
    session.engine = Box::new(Failing { cpu, questions_left, refuses: false });
    session.options.backend = backend;
    session
}

/// The triangles after every iteration, and the outcome.
fn watch(mut session: Session) -> Result<(Vec<Vec<u32>>, Outcome), Error> {
    block_on(async {
        let mut seen = Vec::new();
        while session.step().await?.is_some() {
            seen.push(session.triangles().await?);
        }
        Ok((seen, session.outcome().await?))
    })
}

#[test]
fn a_lost_device_changes_no_result_at_any_moment() {
    let (expected, outcome) = watch(session(Backend::Auto, u32::MAX)).unwrap();
    assert!(outcome.remaining[Reason::Locked] > 0);
    let questions = 3 * expected.len() as u32 + 4;
    for questions_left in 0..questions {
        let (seen, other) = watch(session(Backend::Auto, questions_left)).unwrap();
        assert_eq!(seen, expected, "lost after {questions_left} questions");
        assert!(other.fallback.is_some_and(|why| why.contains("lost on purpose")));
        assert_eq!((other.backend, other.status), (EngineKind::Cpu, Status::Done));
        assert_eq!(other.flips_per_iteration, outcome.flips_per_iteration);
        assert_eq!(other.remaining, outcome.remaining);

        let mut session = session(Backend::Auto, questions_left);
        let mut counts = Vec::new();
        block_on(session.run(|iterations, _| {
            counts.push(iterations);
            ControlFlow::Continue(())
        }))
        .unwrap();
        assert!(counts.is_sorted());
        assert_eq!(block_on(session.outcome()).unwrap().triangles, outcome.triangles);
    }
}

#[test]
fn a_mesh_that_is_refused_late_goes_to_the_next_engine() {
    let refusing = |backend| {
        let mut session = session(backend, 0);
        let cpu = Cpu::new(session.mesh.clone(), Thresholds::from(&session.options), Threads::default());
        session.engine = Box::new(Failing { cpu, questions_left: 0, refuses: true });
        watch(session)
    };
    let (_, outcome) = refusing(Backend::Auto).unwrap();
    assert_eq!((outcome.backend, outcome.status), (EngineKind::Cpu, Status::Done));
    assert!(outcome.fallback.is_some_and(|why| why.starts_with("backend gpu ")));
    assert!(matches!(refusing(Backend::Gpu), Err(Error::BackendLimit { .. })));
}

#[test]
fn an_explicit_backend_never_falls_back() {
    assert!(matches!(watch(session(Backend::Gpu, 4)), Err(Error::Device { .. })));
}

/// As [`watch`], after one iteration and a move of the vertices.
fn watch_moved(mut session: Session) -> Result<(Vec<Vec<u32>>, Outcome), Error> {
    let moved: Vec<f64> =
        session.mesh.positions().iter().enumerate().map(|(i, x)| x * (1.0 + (i % 2) as f64)).collect();
    block_on(async {
        session.step().await?;
        session.set_positions(moved).await
    })?;
    watch(session)
}

#[test]
fn a_lost_device_changes_no_result_when_vertices_move() {
    let (expected, outcome) = watch_moved(session(Backend::Auto, u32::MAX)).unwrap();
    assert!(expected.len() > 2);
    for questions_left in 0..3 * expected.len() as u32 + 8 {
        let (seen, other) = watch_moved(session(Backend::Auto, questions_left)).unwrap();
        assert_eq!(seen, expected, "lost after {questions_left} questions");
        assert!(other.fallback.is_some_and(|why| why.contains("lost on purpose")));
        assert_eq!(other.flips_per_iteration, outcome.flips_per_iteration);
        assert_eq!(other.remaining, outcome.remaining);
        if questions_left < 4 {
            let error = watch_moved(session(Backend::Gpu, questions_left)).unwrap_err();
            assert!(matches!(error, Error::Device { .. }));
        }
    }
}

/// Coordinates that span too many bits for the GPU, as floats and as doubles.
#[cfg(feature = "gpu")]
#[test]
fn the_cpu_takes_over_positions_that_the_gpu_refuses() {
    let mesh = crate::families::by_name("random 8").unwrap();
    for x in [f64::from(1e-30f32), 1e-30] {
        let mut positions: Vec<f64> = mesh.positions().iter().collect();
        positions[0] = x;
        let options = Options { backend: Backend::Gpu, ..Options::default() };
        let mut session = block_on(Session::new(mesh.clone(), options)).unwrap();
        let refused = block_on(session.set_positions(positions.clone()));
        assert!(matches!(refused, Err(Error::BackendLimit { .. })));

        session.options.backend = Backend::Auto;
        block_on(session.set_positions(positions)).unwrap();
        let (_, outcome) = watch(session).unwrap();
        assert_eq!((outcome.backend, outcome.status), (EngineKind::Cpu, Status::Done));
        assert!(outcome.fallback.is_some_and(|why| why.contains("span")));
    }
}

/// The GPU has one set of shaders for floats and one for doubles. Floats that are too large use those for doubles.
#[cfg(feature = "gpu")]
#[test]
fn vertices_move_from_floats_to_doubles_and_back() {
    let mesh = crate::families::by_name("random 8").unwrap();
    let moves: [fn(f64) -> f64; 5] = [|x| x * 0.3 + 0.1, |x| 1e6 - x, |x| x * x, |x| x * 3e38, |x| x];
    let run = |backend| {
        let options = Options { backend, ..Options::default() };
        block_on(async {
            let mut session = Session::new(mesh.clone(), options).await?;
            let mut states = Vec::new();
            for (turn, moved) in moves.into_iter().enumerate() {
                session.step().await?;
                let stretch = |(i, x)| moved(x) * if i % 2 == turn % 2 { 1.0 } else { 0.25 };
                session
                    .set_positions(mesh.positions().iter().enumerate().map(stretch).collect::<Vec<f64>>())
                    .await?;
                states.push((session.triangles().await?, session.engine.backend()));
            }
            session.run(|_, _| ControlFlow::Continue(())).await?;
            Ok::<_, Error>((states, session.outcome().await?))
        })
        .unwrap()
    };
    let ((expected, end), (found, gpu_end)) = (run(Backend::Cpu), run(Backend::Gpu));
    assert!(end.flips > 50);
    for ((expected, _), (found, backend)) in expected.iter().zip(&found) {
        assert_eq!((found, *backend), (expected, EngineKind::Gpu));
    }
    assert_eq!(gpu_end.triangles, end.triangles);
    assert_eq!(gpu_end.remaining, end.remaining);
}

/// `Auto` never takes a software GPU, so this test sets `Backend::Gpu` before the change.
#[cfg(feature = "gpu")]
#[test]
fn a_run_continues_on_a_gpu_that_has_become_ready() {
    let mesh = Arc::new(crate::families::by_name("random 160").unwrap());
    let locked_edges = mesh.triangles().chunks(15).map(|t| [t[0], t[1]]).collect();
    let threads = std::num::NonZeroUsize::new(1);
    let options =
        |backend| Options { backend, threads, locked_edges: Vec::clone(&locked_edges), ..Options::default() };
    let session = |backend| block_on(Session::new(mesh.clone(), options(backend))).unwrap();
    let (expected, outcome) = watch(session(Backend::Cpu)).unwrap();
    // Opens the device.
    drop(session(Backend::Gpu));
    for iterations in [1, 3] {
        let mut session = session(Backend::Cpu);
        session.options.backend = Backend::Gpu;
        for _ in 0..iterations {
            assert!(block_on(session.advance()).unwrap());
        }
        session.may_change = true;
        // So that the estimate does not depend on the speed of this machine.
        session.timings = Timings::default();
        block_on(session.change_to_gpu());
        assert_eq!((session.engine.backend(), session.may_change), (EngineKind::Gpu, false));
        assert_eq!(block_on(session.triangles()).unwrap(), expected[iterations - 1]);
        block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
        let changed = block_on(session.outcome()).unwrap();
        assert_eq!(changed.fallback.as_deref(), Some("the cpu began, until the gpu was ready"));
        assert_eq!(changed.flips_per_iteration, outcome.flips_per_iteration);
        assert_eq!((changed.triangles, changed.remaining), (outcome.triangles.clone(), outcome.remaining));
    }
}
