//! Sessions of meshes that move, frame by frame, on the CPU and on the GPU, with the audit as the judge.
#![cfg(feature = "gpu")]

use edgeflip::{
    Backend, Counters, Dimension, Error, Mesh, Options, Positions, Reason, Session, families, quality,
};
use pollster::block_on;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Two sessions on one mesh.
struct Pair {
    sessions: [Session; 2],
    options: Options,
    dimension: Dimension,
}

impl Pair {
    fn new(mesh: Mesh, options: &Options) -> Self {
        let mesh = Arc::new(mesh);
        let session = |backend| {
            let options = Options { backend, ..options.clone() };
            block_on(Session::new(mesh.clone(), options)).unwrap()
        };
        let dimension = mesh.dimension();
        Self { sessions: [Backend::Cpu, Backend::Gpu].map(session), options: options.clone(), dimension }
    }

    /// Updates both, and audits the result.
    fn update(&mut self, positions: &[f32], iterations: u32) -> Counters {
        let before = block_on(self.sessions[0].triangles()).unwrap();
        let [cpu, gpu] = self.sessions.each_mut().map(|session| {
            session.update(Some(positions.to_vec().into()), iterations).unwrap();
            let triangles = block_on(session.triangles()).unwrap();
            (block_on(session.counters()).unwrap(), triangles)
        });
        assert!(cpu == gpu, "{:?} on the CPU, {:?} on the GPU", cpu.0, gpu.0);
        let (counters, triangles) = cpu;
        let input = Mesh::new(self.dimension, positions.to_vec(), before).unwrap();
        let audit = quality::audit(&input, &triangles, &self.options);
        assert!(audit.violations.is_empty(), "{:?}", audit.violations);
        assert_eq!(audit.remaining, counters.remaining);
        let areas = [&audit.inverted, &audit.flat].map(|list| list.len() as u32);
        assert_eq!((areas, counters.undecided), ([counters.inverted, counters.flat], 0));
        counters
    }
}

/// Twice the area of a triangle. Exact for coordinates that are multiples of 2^-12 and below 4.
fn area(positions: &[f32], triangle: &[u32]) -> f64 {
    let [a, b, c] =
        [0, 1, 2].map(|k| [0, 1].map(|axis| f64::from(positions[2 * triangle[k] as usize + axis])));
    (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0])
}

/// The middle of the sheet turns by 4 degrees more in each frame, its rim does not. Triangles turn over, and flips mend
/// the folds that they can.
#[test]
fn a_sheet_is_twisted_for_200_frames() {
    let mesh = families::by_name("random 20").unwrap();
    let rest = mesh.positions().to_f32();
    let mut pair = Pair::new(mesh, &Options { untangle: Some(false), ..Options::default() });
    let (mut folded, mut mended) = (0, 0);
    for frame in 0..200u8 {
        let positions: Vec<f32> = rest
            .chunks(2)
            .flat_map(|p| {
                let (x, y) = (p[0] - 0.5, p[1] - 0.5);
                let angle = f32::from(frame) * 4f32.to_radians() * (1.0 - 2.0 * x.abs().max(y.abs()));
                let (sin, cos) = angle.sin_cos();
                [x * cos - y * sin, x * sin + y * cos].map(|x| (x * 4096.0).round() / 4096.0)
            })
            .collect();
        let before = block_on(pair.sessions[0].triangles()).unwrap();
        let counters = pair.update(&positions, 32);
        let triangles = block_on(pair.sessions[0].triangles()).unwrap();
        let [turned, left] = [&before, &triangles]
            .map(|triangles| triangles.chunks(3).filter(|t| area(&positions, t) <= 0.0).count() as u32);
        // No flip turns a triangle over.
        assert!(left <= turned, "frame {frame}: {turned} before, {left} after");
        let flat = triangles.chunks(3).filter(|t| area(&positions, t) == 0.0).count() as u32;
        assert_eq!([counters.inverted, counters.flat], [left - flat, flat], "frame {frame}");
        // An edge whose flip would mend a fold is not Delaunay, and may flip.
        assert_eq!(counters.remaining[Reason::Stopped], 0, "frame {frame}");
        folded += turned;
        mended += turned - left;
    }
    assert!(mended > 100, "{mended} of {folded} folds were mended");
}

/// Other calls end the motion.
#[test]
fn a_motion_ends_with_a_run() {
    let mesh = families::by_name("uvsphere 10").unwrap();
    let moved: Vec<f32> =
        mesh.positions().to_f32().chunks(3).flat_map(|p| [p[0], 1.4 * p[1], p[2] + 0.3 * p[0]]).collect();
    let locked_edges = mesh.triangles().chunks(30).map(|t| [t[0], t[1]]).collect();
    let options = Options { max_normal_angle: 60.0, locked_edges, track_changes: true, ..Options::default() };
    let mut pair = Pair::new(mesh, &options);
    pair.update(&moved, 1);
    let outcomes = pair.sessions.each_mut().map(|session| {
        assert!(block_on(session.changes()).unwrap().contains(&1));
        block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
        let outcome = block_on(session.outcome()).unwrap();
        assert!(block_on(session.verify()).unwrap().is_clean());
        assert_eq!(block_on(session.counters()).unwrap().updates, 0);
        assert!(block_on(session.changes()).unwrap().iter().all(|&update| update == 0));
        (outcome.triangles, outcome.flips_per_iteration, outcome.remaining)
    });
    assert!(outcomes[0] == outcomes[1] && !outcomes[0].1.is_empty());
    // The motion begins again.
    assert!(pair.update(&moved, 0).updates == 1);
}

#[test]
fn wrong_updates_change_nothing() {
    let mut pair = Pair::new(families::by_name("random 5").unwrap(), &Options::default());
    for session in &mut pair.sessions {
        let before = block_on(session.triangles()).unwrap();
        let many = session.update(None, 65).unwrap_err();
        assert!(matches!(many, Error::Option { option: "iterations", .. }));
        let short = session.update(Some(Positions::F32(vec![0.0; 4])), 1).unwrap_err();
        assert!(matches!(short, Error::PositionCount { length: 4, .. }));
        assert_eq!(block_on(session.triangles()).unwrap(), before);
        assert_eq!(block_on(session.counters()).unwrap().updates, 0);
    }
    // The GPU takes 32-bit floats only; the CPU takes both.
    let doubles = || Some(Positions::F64(vec![0.25; 50]));
    assert!(pair.sessions[0].update(doubles(), 1).is_ok());
    assert!(matches!(pair.sessions[1].update(doubles(), 1), Err(Error::BackendLimit { .. })));
}

fn own_device() -> edgeflip::GpuDevice {
    let instance =
        edgeflip::wgpu::Instance::new(edgeflip::wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = block_on(instance.request_adapter(&Default::default())).unwrap();
    let (device, queue) = block_on(adapter.request_device(&Default::default())).unwrap();
    edgeflip::GpuDevice { instance, device, queue, adapter: adapter.get_info() }
}

#[test]
fn a_device_that_is_lost_fails_updates() {
    let given = own_device();
    let options = Options { backend: Backend::Gpu, device: Some(given.clone()), ..Options::default() };
    let mut session = block_on(Session::new(families::by_name("random 10").unwrap(), options)).unwrap();
    session.update(None, 1).unwrap();
    block_on(session.counters()).unwrap();
    given.device.destroy();
    // The first update may not know it yet.
    let _ = session.update(None, 1);
    assert!(matches!(block_on(session.counters()), Err(Error::Device { .. })));
    assert!(matches!(session.update(None, 1), Err(Error::Device { .. })));
    assert!(matches!(block_on(session.triangles()), Err(Error::Device { .. })));
}

/// wgpu gives devices of different instances the same numbers.
#[test]
fn devices_of_two_instances_are_told_apart() {
    let mesh = families::by_name("random 10").unwrap();
    let session = |device: &edgeflip::GpuDevice| {
        let options = Options { backend: Backend::Gpu, device: Some(device.clone()), ..Options::default() };
        block_on(Session::new(&mesh, options)).unwrap()
    };
    // The device that sessions share is of an instance of its own.
    let shared = Options { backend: Backend::Gpu, ..Options::default() };
    let mut others = vec![block_on(Session::new(&mesh, shared)).unwrap()];
    let given = [own_device(), own_device()];
    let mut lost = session(&given[0]);
    others.push(session(&given[1]));
    given[0].device.destroy();
    assert!(matches!(block_on(lost.triangles()), Err(Error::Device { .. })));
    for session in &mut others {
        block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
    }
}

/// A device of the program, and what a session gives it.
#[test]
fn a_program_shares_its_device() {
    let given = own_device();
    let mesh = families::by_name("random 10").unwrap();
    let options = Options {
        backend: Backend::Gpu,
        device: Some(given.clone()),
        track_changes: true,
        ..Options::default()
    };
    let mut session = block_on(Session::new(&mesh, options)).unwrap();
    let gpu = session.gpu().unwrap();
    assert!(gpu.device == given.device && gpu.queue == given.queue);
    assert_eq!(gpu.positions.size(), 8 * mesh.vertex_count() as u64);
    assert_eq!(gpu.triangles.size(), 12 * mesh.triangle_count() as u64);
    let (changes, offset) = gpu.changes.unwrap();
    assert!(offset % 256 == 0 && offset + 4 * mesh.triangle_count() as u64 <= changes.size());
    let moved: Vec<u8> =
        mesh.positions().to_f32().iter().flat_map(|x| (x * x + 0.5 * x).to_le_bytes()).collect();
    gpu.queue.write_buffer(&gpu.positions, 0, &moved);
    session.update(None, 64).unwrap();
    assert_eq!(block_on(session.counters()).unwrap().remaining[Reason::Stopped], 0);
    assert!(block_on(session.verify()).unwrap().is_clean());
}
