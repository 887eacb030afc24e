//! Tests of the CPU engine and the WebGPU engine in headless Chromium that the parity matrix lacks.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]
#![cfg(target_arch = "wasm32")]

#[path = "wasm/device.rs"]
mod device;
mod meshes;

use device::{class_of, code_of, session_of, shared};
use edgeflip::{
    Backend, EdgeState, Edges, EngineKind, Error, Options, Positions, Session, families::by_name,
};
use js_sys::Reflect;
use wasm_bindgen_test::{wasm_bindgen_test, wasm_bindgen_test_configure};

wasm_bindgen_test_configure!(run_in_browser);

/// The same check as `native/edge_states.rs` makes natively.
#[wasm_bindgen_test]
async fn states_foretell_the_flips() {
    // SwiftShader, Chromium's software GPU, is slow, above all to compile the kernels for doubles and for deviations.
    let is_plain = |case: &meshes::Case| {
        matches!(case.mesh.positions(), Positions::F32(_)) && case.deviation.is_infinite()
    };
    for (backend, triangles, iterations) in [(Backend::Cpu, 10_000, 300), (Backend::Gpu, 800, 12)] {
        let mut taken = 0;
        let cases = meshes::all().into_iter().filter(|case| case.mesh.triangle_count() <= triangles);
        for case in cases.filter(|case| backend == Backend::Cpu || is_plain(case)) {
            let name = format!("{} at β = {}, {backend:?}", case.name, case.beta);
            let options = case.options(backend);
            let mut session = match Session::new(case.mesh, options).await {
                Err(Error::BackendLimit { .. }) if backend == Backend::Gpu => continue,
                session => session.unwrap_or_else(|error| panic!("{name}: {error}")),
            };
            for _ in 0..iterations {
                // Each edge that flips has two half-edges in the states.
                let states = session.edge_states().await.unwrap();
                let foretold = states.iter().filter(|&&state| state == EdgeState::Flips).count() / 2;
                let step = session.step().await.unwrap();
                assert_eq!(foretold, step.map_or(0, |step| step.flips as usize), "{name}");
                if foretold == 0 {
                    break;
                }
            }
            taken += 1;
        }
        assert!(taken > 100, "{taken} on {backend:?}");
    }
}

/// A run without stops also runs the tail, which single steps do not.
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

/// `auto` looks at the adapter first, because opening a device compiles kernels.
#[wasm_bindgen_test]
async fn auto_finds_an_engine() {
    let mesh = by_name("random 80").unwrap();
    let asked = device::devices_asked_for();
    let mut session = Session::new(mesh, Options::default()).await.unwrap();
    while session.advance().await.unwrap() {}
    let outcome = session.outcome().await.unwrap();
    assert_eq!(outcome.remaining.total(), 0);
    assert_eq!(outcome.backend == EngineKind::Cpu, outcome.fallback.is_some());
    assert!(outcome.backend != EngineKind::Cpu || device::devices_asked_for() == asked);
}

/// The npm package gets the objects of the GPU that the page can draw from.
#[wasm_bindgen_test]
async fn javascript_gets_the_buffers_of_webgpu() {
    let mesh = by_name("random 10").unwrap();
    let session = session_of(&mesh, &[("backend", "webgpu".into())]).await.unwrap();
    while session.advance().await.unwrap().is_truthy() {}
    assert_eq!(session.backend(), "webgpu");
    assert!(session.flips() > 0.0);
    assert_eq!(class_of(&shared(&session, "device")), "GPUDevice");
    // The handler stays free for the page: three.js sets it.
    assert!(Reflect::get(&shared(&session, "device"), &"onuncapturederror".into()).unwrap().is_null());
    for (buffer, numbers) in [
        (shared(&session, "positions"), mesh.positions().len()),
        (shared(&session, "indices"), mesh.triangles().len()),
    ] {
        assert_eq!(class_of(&buffer), "GPUBuffer");
        assert_eq!(Reflect::get(&buffer, &"size".into()).unwrap(), 4.0 * numbers as f64);
    }
    let outcome = session.outcome().await.unwrap();
    assert_eq!(Reflect::get(&outcome, &"status".into()).unwrap(), "done");

    let session = session_of(&mesh, &[("backend", "cpu".into())]).await.unwrap();
    assert!(session.gpu().is_undefined());
    let error = session_of(&mesh, &[("maxNormalAngle", 181.0.into())]).await.err().unwrap();
    assert_eq!(code_of(&error), "invalid-option");
}
