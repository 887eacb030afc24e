//! In headless Chromium: the CPU engine and the WebGPU engine against the digests of the simulation.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![cfg(target_arch = "wasm32")]

#[path = "wasm/device.rs"]
mod device;
mod meshes;
mod simulation;

use device::{class_of, code_of, options_object};
use edgeflip::js::JsSession;
use edgeflip::{
    Backend, EdgeState, Edges, Error, Mesh, Options, Outcome, Session, Status, families::by_name,
};
use js_sys::Reflect;
use simulation::{Digest, Expected, expected};
use wasm_bindgen::JsValue;
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};

wasm_bindgen_test_configure!(run_in_browser);

/// Cases of at most so many triangles and iterations: SwiftShader, Chromium's software GPU, is slow.
fn cases(triangles: usize, iterations: usize) -> Vec<(meshes::Case, Expected)> {
    let small = |(case, want): &(meshes::Case, Expected)| {
        case.mesh.triangle_count() <= triangles && want.iterations <= iterations
    };
    meshes::all().into_iter().zip(expected()).filter(small).collect()
}

async fn watched(mesh: &Mesh, options: Options) -> Result<(u64, Digest, Outcome), Error> {
    let mut session = Session::new(mesh.clone(), options).await?;
    let mut digest = Digest::default();
    let mut labelled = 0;
    digest.feed(&session.triangles().await?);
    loop {
        // Both half-edges of an edge flip.
        let states = session.edge_states().await?;
        let foretold = states.iter().filter(|&&state| state == EdgeState::Flips).count() / 2;
        let Some(iteration) = session.step().await? else { break };
        assert_eq!(foretold, iteration.flips as usize);
        labelled += u64::from(iteration.labelled);
        digest.feed(&session.triangles().await?);
    }
    Ok((labelled, digest, session.outcome().await?))
}

/// Returns how many cases the backend took; the others it must have refused for their coordinates.
async fn compare(backend: Backend, cases: Vec<(meshes::Case, Expected)>) -> usize {
    let mut taken = 0;
    for (case, want) in cases {
        let name = format!("{} at β = {}, {backend:?}", case.name, case.beta);
        let options = Options { backend, max_normal_angle: case.beta, ..Options::default() };
        let (labelled, digest, outcome) = match watched(&case.mesh, options).await {
            Err(Error::BackendLimit { .. }) if backend == Backend::Gpu => continue,
            result => result.unwrap_or_else(|error| panic!("{name}: {error}")),
        };
        assert_eq!(outcome.status, Status::Done, "{name}");
        assert_eq!((outcome.iterations as usize, outcome.flips), (want.iterations, want.flips), "{name}");
        assert_eq!((labelled, digest), (want.labelled, want.digest), "{name}");
        assert_eq!(outcome.remaining, want.remaining, "{name}");
        taken += 1;
    }
    taken
}

#[wasm_bindgen_test]
async fn cpu_gives_the_digests_of_the_simulation() {
    assert!(compare(Backend::Cpu, cases(10_000, 300)).await > 50);
}

#[wasm_bindgen_test]
async fn webgpu_gives_the_digests_of_the_simulation() {
    assert!(compare(Backend::Gpu, cases(800, 12)).await > 20);
}

/// The batch with its tail, which watching does not run.
#[wasm_bindgen_test]
async fn a_whole_run_on_webgpu_is_that_of_the_cpu() {
    for spec in ["strips 50", "uvsphere 14"] {
        let mesh = by_name(spec).unwrap();
        let mut indices = Vec::new();
        for backend in [Backend::Cpu, Backend::Gpu] {
            let options = Options { backend, ..Options::default() };
            let mut session = Session::new(mesh.clone(), options).await.unwrap();
            while session.advance().await.unwrap() {}
            let outcome = session.outcome().await.unwrap();
            assert!(session.verify().await.unwrap().is_clean(), "{spec}");
            let adapter = outcome.adapter.as_ref().is_some_and(|name| !name.is_empty());
            assert_eq!(adapter, backend == Backend::Gpu, "{spec}");
            let edges = session.edges().await.unwrap();
            assert_eq!(edges, Edges::new(mesh.vertex_count(), &outcome.triangles), "{spec}");
            indices.push((outcome.triangles, outcome.flips_per_iteration, outcome.remaining));
        }
        assert_eq!(indices[0], indices[1], "{spec}");
    }
}

/// It looks before it opens a device, which would compile the kernels.
#[wasm_bindgen_test]
async fn auto_finds_an_engine() {
    let mesh = by_name("random 10").unwrap();
    let asked = device::devices_asked_for();
    let mut session = Session::new(mesh, Options::default()).await.unwrap();
    while session.advance().await.unwrap() {}
    let outcome = session.outcome().await.unwrap();
    assert_eq!(outcome.remaining.total(), 0);
    assert_eq!(outcome.backend == "cpu", outcome.fallback.is_some());
    assert!(outcome.backend != "cpu" || device::devices_asked_for() == asked);
}

/// What the npm package calls: the GPU's objects are those that the page can draw from.
#[wasm_bindgen_test]
async fn javascript_gets_the_buffers_of_webgpu() {
    let mesh = by_name("random 10").unwrap();
    let create = |fields: &[(&str, JsValue)]| {
        let (positions, indices) = (device::positions_array(&mesh), mesh.triangles().to_vec());
        JsSession::create(positions, indices, 2.0, options_object(fields))
    };
    let mut session = create(&[("backend", "webgpu".into())]).await.unwrap();
    while session.advance().await.unwrap() {}
    assert_eq!(session.backend(), "webgpu");
    assert!(session.flips() > 0.0);
    assert_eq!(class_of(&session.device()), "GPUDevice");
    // The page may set it, as three does.
    assert!(Reflect::get(&session.device(), &"onuncapturederror".into()).unwrap().is_null());
    for (buffer, numbers) in [
        (session.position_buffer(), mesh.positions().len()),
        (session.index_buffer(), mesh.triangles().len()),
    ] {
        assert_eq!(class_of(&buffer), "GPUBuffer");
        assert_eq!(Reflect::get(&buffer, &"size".into()).unwrap(), 4.0 * numbers as f64);
    }
    let outcome = session.outcome().await.unwrap();
    assert_eq!(Reflect::get(&outcome, &"status".into()).unwrap(), "done");

    let session = create(&[("backend", "cpu".into())]).await.unwrap();
    assert!(session.device().is_undefined() && session.index_buffer().is_undefined());
    let error = create(&[("maxNormalAngle", 181.0.into())]).await.err().unwrap();
    assert_eq!(code_of(&error), "invalid-option");
}
