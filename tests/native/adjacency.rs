//! The adjacency that a session keeps for kernels of the caller is that of its triangles, after every update.
#![cfg(feature = "gpu")]

use edgeflip::{Backend, Dimension, GpuBuffers, Mesh, NONE, Options, Positions, Session, families, wgpu};
use pollster::block_on;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;

/// The first words of a buffer.
fn read(gpu: &GpuBuffers, buffer: &wgpu::Buffer, count: usize) -> Vec<u32> {
    let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: buffer.size(),
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, buffer.size());
    gpu.queue.submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |_| ());
    gpu.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let view = staging.get_mapped_range(..).unwrap();
    let (words, []) = view.as_chunks() else { unreachable!("a buffer of words") };
    words[..count].iter().map(|&bytes| u32::from_le_bytes(bytes)).collect()
}

fn next(h: u32) -> u32 {
    h / 3 * 3 + (h + 1) % 3
}

fn prev(h: u32) -> u32 {
    h / 3 * 3 + (h + 2) % 3
}

/// The twins of triangles, by a list of the half-edges of each edge.
fn twins_of(triangles: &[u32]) -> Vec<u32> {
    let end = |h: u32| triangles[next(h) as usize];
    let mut edges: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for (h, &start) in (0..).zip(triangles) {
        edges.entry([start.min(end(h)), start.max(end(h))]).or_default().push(h);
    }
    let mut twins = vec![NONE; triangles.len()];
    for half_edges in edges.into_values() {
        if let [h, g] = half_edges[..]
            && triangles[h as usize] == end(g)
            && h / 3 != g / 3
        {
            (twins[h as usize], twins[g as usize]) = (g, h);
        }
    }
    twins
}

/// The triangles of a vertex that a walk reaches from a half-edge.
fn walked(twins: &[u32], start: u32) -> Vec<u32> {
    let mut found = vec![start / 3];
    let mut h = twins[prev(start) as usize];
    while h != NONE && h != start {
        found.push(h / 3);
        h = twins[prev(h) as usize];
    }
    found
}

/// Checks both buffers of a session. Returns how many vertices have one fan, and how many have several.
fn check(session: &mut Session, vertices: usize) -> [usize; 2] {
    let triangles = block_on(session.triangles()).unwrap();
    let gpu = session.gpu().unwrap();
    let given = |buffer: &Option<wgpu::Buffer>, count| read(&gpu, buffer.as_ref().unwrap(), count);
    let twins = given(&gpu.twins, triangles.len());
    let starts = given(&gpu.vertex_half_edges, vertices);
    assert_eq!(read(&gpu, &gpu.triangles, triangles.len()), triangles);
    assert_eq!(twins, twins_of(&triangles));
    let mut corners = vec![Vec::new(); vertices];
    for (h, &v) in (0..).zip(&triangles) {
        corners[v as usize].push(h);
    }
    let mut kinds = [0; 2];
    for (corners, &start) in corners.iter().zip(&starts) {
        let borders = || corners.iter().copied().filter(|&h| twins[h as usize] == NONE);
        assert_eq!(start, borders().min().or(corners.iter().copied().min()).unwrap_or(NONE));
        if start == NONE {
            continue;
        }
        let found = walked(&twins, start);
        let of_walk: BTreeSet<u32> = found.iter().copied().collect();
        assert_eq!(of_walk.len(), found.len(), "no triangle twice");
        // The fans are what twins join: a closed one, or one that begins at a border.
        let is_whole =
            borders().count() == usize::from(twins[start as usize] == NONE) && found.len() == corners.len();
        let all: BTreeSet<u32> = corners.iter().map(|h| h / 3).collect();
        assert_eq!(is_whole, of_walk == all);
        kinds[usize::from(!is_whole)] += 1;
    }
    kinds
}

/// A session on the GPU that gives its adjacency.
fn session(mesh: &Mesh, options: Options) -> Session {
    let options = Options { backend: Backend::Gpu, adjacency: true, ..options };
    block_on(Session::new(mesh, options)).unwrap()
}

/// Checks a mesh before and after a run, and after each of some updates. Returns the kinds of its vertices, and the
/// flips.
fn moves(mesh: &Mesh, options: Options) -> ([usize; 2], u64) {
    let (vertices, stride) = (mesh.vertex_count(), mesh.dimension().stride());
    let mut session = session(mesh, options);
    let kinds = check(&mut session, vertices);
    block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
    assert_eq!(check(&mut session, vertices), kinds);
    let rest = mesh.positions().to_f32();
    for frame in 0..24u8 {
        let time = 0.4 * f32::from(frame);
        let moved = rest.chunks(stride).flat_map(|p| {
            let (x, y) = (p[0] + 0.3 * (9.0 * p[1] + time).sin(), p[1] + 0.3 * (9.0 * p[0] - time).sin());
            [x, y].into_iter().chain(p.get(2).copied())
        });
        session.update(Some(moved.collect::<Vec<_>>().into()), u32::from(frame % 4)).unwrap();
        assert_eq!(check(&mut session, vertices), kinds, "frame {frame}");
    }
    let flips = block_on(session.counters()).unwrap().flips;
    // The positions have folds: the host untangles, and writes other triangles.
    block_on(session.set_positions(rest)).unwrap();
    assert_eq!(check(&mut session, vertices), kinds);
    (kinds, flips)
}

/// A sheet with some triangles left out, by their indices.
fn with_holes(sheet: &Mesh, is_hole: impl Fn(usize) -> bool) -> Vec<u32> {
    let kept = sheet.triangles().chunks(3).enumerate().filter(|(t, _)| !is_hole(*t));
    kept.flat_map(|(_, corners)| corners).copied().collect()
}

#[test]
fn sheets_with_holes_isolated_vertices_and_locked_edges() {
    let sheet = families::by_name("shuffled random 14").unwrap();
    let triangles = with_holes(&sheet, |t| t % 40 == 7);
    let positions: Vec<f32> =
        sheet.positions().to_f32().into_iter().chain([0.1, 0.2, 5.0, 5.0, -3.0, 1.0]).collect();
    let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
    let locked_edges = mesh.triangles().chunks(45).map(|t| [t[0], t[1]]).collect();
    let (kinds, flips) = moves(&mesh, Options { locked_edges, track_changes: true, ..Options::default() });
    assert!(kinds[0] > 150 && kinds.iter().sum::<usize>() <= mesh.vertex_count() - 3, "{kinds:?}");
    assert!(flips > 500, "{flips}");
}

#[test]
fn components_of_opposite_windings_that_touch_in_a_vertex() {
    let sheet = families::by_name("random 8").unwrap();
    let count = sheet.vertex_count() as u32;
    // The last vertex of the first sheet is the first of the second one.
    let shifted = |v: u32| v + count - 1;
    let second = sheet.triangles().chunks(3).flat_map(|t| [t[0], t[2], t[1]].map(shifted));
    let triangles: Vec<u32> = sheet.triangles().iter().copied().chain(second).collect();
    let first = sheet.positions().to_f32();
    let corner = [first[first.len() - 2] - first[0], first[first.len() - 1] - first[1]];
    let second = first.chunks(2).skip(1).flat_map(|p| [p[0] + corner[0], p[1] + corner[1]]);
    let positions: Vec<f32> = first.iter().copied().chain(second).collect();
    let mesh = Mesh::new(Dimension::Two, positions, triangles).unwrap();
    let (kinds, flips) = moves(&mesh, Options::default());
    assert_eq!(kinds, [2 * count as usize - 2, 1]);
    assert!(flips > 100, "{flips}");
}

#[test]
fn edges_of_three_triangles_and_of_triangles_that_disagree() {
    let ball = families::by_name("uvsphere 9").unwrap();
    let mut triangles = ball.triangles().to_vec();
    let count = ball.vertex_count() as u32;
    let positions: Vec<f32> = ball.positions().to_f32().into_iter().chain([2.0, 2.0, 0.0]).collect();
    triangles.extend([triangles[30], triangles[31], count]);
    triangles.swap(60, 61);
    let mesh = Mesh::new(Dimension::Three, positions, triangles).unwrap();
    let (kinds, flips) = moves(&mesh, Options { max_normal_angle: 40.0, ..Options::default() });
    assert!(kinds[0] > 50 && kinds[1] >= 2, "{kinds:?}");
    assert!(flips > 0);
}

#[test]
fn meshes_of_few_triangles() {
    // A buffer has at least four words: those behind the last half-edge and the last vertex do not count.
    for count in 0..3 {
        let triangles = [0, 1, 2, 1, 3, 2][..3 * count].to_vec();
        let positions = [0.0f32, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let mesh = Mesh::new(Dimension::Two, positions[..2 * (count + 2)].to_vec(), triangles).unwrap();
        for _ in 0..2 {
            let mut session = session(&mesh, Options::default());
            assert_eq!(check(&mut session, mesh.vertex_count()), [if count > 0 { count + 2 } else { 0 }, 0]);
        }
    }
}

/// Positions of 64-bit floats get other buffers.
#[test]
fn other_buffers_have_it_too() {
    let mesh = families::by_name("random 10").unwrap();
    let mut session = session(&mesh, Options::default());
    let before = session.gpu().unwrap();
    let doubles: Vec<f64> = mesh.positions().to_f32().iter().map(|&x| f64::from(x) * 1.000_000_1).collect();
    block_on(session.set_positions(Positions::F64(doubles))).unwrap();
    assert!(session.gpu().unwrap().twins != before.twins);
    block_on(session.run(|_, _| ControlFlow::Continue(()))).unwrap();
    assert_eq!(check(&mut session, mesh.vertex_count()), [100, 0]);
}

#[test]
fn it_is_only_there_if_somebody_asks() {
    let mesh = families::by_name("random 10").unwrap();
    let bytes = |adjacency| {
        let options = Options { backend: Backend::Gpu, adjacency, ..Options::default() };
        let mut session = block_on(Session::new(&mesh, options)).unwrap();
        let gpu = session.gpu().unwrap();
        assert_eq!([&gpu.twins, &gpu.vertex_half_edges].map(Option::is_some), [adjacency; 2]);
        block_on(session.outcome()).unwrap().device_bytes
    };
    let (triangles, vertices) = (mesh.triangle_count() as u64, mesh.vertex_count() as u64);
    assert_eq!(bytes(true) - bytes(false), 12 * triangles + 4 * vertices);
    let options = Options { backend: Backend::Cpu, adjacency: true, ..Options::default() };
    assert!(block_on(Session::new(&mesh, options)).unwrap().gpu().is_none());
}
