//! What a session asks of an engine, and what an engine answers.

#[cfg(feature = "gpu")]
use crate::Reason;
use crate::{Adjacency, EngineKind, Error, Mesh, Reasons};
use std::pin::Pin;
use std::sync::Arc;

/// What an engine answers, once its device has.
pub(crate) type Answer<'a, T> = Pin<Box<dyn Future<Output = Result<T, Error>> + 'a>>;

/// Every non-Delaunay interior edge of the mesh, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Census {
    /// Those that may flip.
    pub(crate) labelled: u32,
    /// Those that may not, by `Angle`, `Fold`, `Duplicate`, `Locked` or `Deviation`.
    pub(crate) blocked: Reasons,
}

#[cfg(feature = "gpu")]
impl Census {
    /// As the shaders count: the labelled ones, then those blocked by each reason.
    pub(super) fn of_counts(counts: &[u32]) -> Self {
        let mut census = Self { labelled: counts[0], ..Self::default() };
        for (reason, count) in Reason::ALL.into_iter().zip(&counts[1..]) {
            census.blocked[reason] = u64::from(*count);
        }
        census
    }
}

/// Numbers of edges of the mesh as it was given; flips do not change them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct EdgeCounts {
    pub(crate) edges: u32,
    pub(crate) boundary: u32,
    pub(crate) non_manifold: u32,
    pub(crate) inconsistent: u32,
}

impl From<&Adjacency> for EdgeCounts {
    fn from(adjacency: &Adjacency) -> Self {
        let &Adjacency { edges, boundary, non_manifold, inconsistent, .. } = adjacency;
        Self { edges, boundary, non_manifold, inconsistent }
    }
}

/// Triangles in an array of JavaScript.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(super) fn array(triangles: Answer<'_, Vec<u32>>) -> Answer<'_, js_sys::Uint32Array> {
    Box::pin(async { Ok(triangles.await?.as_slice().into()) })
}

/// One mesh on one engine, between two iterations.
pub(crate) trait Engine {
    /// How many iterations to ask for at a time: as many as make it worth while to ask.
    fn batch(&self) -> u32;

    /// Locks the edges of these half-edges, which are those of both sides: they never flip. Those without a twin are
    /// passed over. Before the first iteration.
    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()>;

    /// Runs up to `count` iterations and returns the flips of each; fewer than `count` when there is nothing
    /// left to flip.
    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>>;

    /// Counts the non-Delaunay interior edges of the whole mesh.
    fn census(&mut self) -> Answer<'_, Census>;

    /// The triangles as they are now.
    fn triangles(&mut self) -> Answer<'_, Vec<u32>>;

    /// The same in an array of JavaScript.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn triangles_array(&mut self) -> Answer<'_, js_sys::Uint32Array> {
        self::array(self.triangles())
    }

    /// The twins as they are now, with the flags [`CREASE`](crate::mesh::half_edge::CREASE) and
    /// [`LOCKED`](crate::mesh::half_edge::LOCKED).
    fn twins(&mut self) -> Answer<'_, Vec<u32>>;

    /// Moves the vertices: from now on as a new engine on `mesh`, whose triangles are those of the engine as they
    /// are now, with the same locks. Where it fails with [`Error::BackendLimit`], the engine is as before.
    fn set_positions(&mut self, mesh: Arc<Mesh>) -> Answer<'_, ()>;

    /// What the adjacency found.
    fn edge_counts(&self) -> EdgeCounts;

    /// `cpu`, `gpu` or `webgl2`.
    fn backend(&self) -> EngineKind;

    /// The device's name and driver, on a GPU.
    fn adapter(&self) -> Option<String> {
        None
    }

    /// Compute dispatches encoded so far.
    fn dispatches(&self) -> u64 {
        0
    }

    /// The most bytes that its buffers took on a GPU at a time.
    fn device_bytes(&self) -> u64 {
        0
    }

    /// Milliseconds that the adjacency took, where more than that is done to begin.
    fn adjacency_ms(&self) -> Option<f64> {
        None
    }

    /// What a page can draw from, where the engine runs on the browser's GPU.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn shared_objects(&self) -> Option<SharedObjects> {
        None
    }
}

/// The browser's objects of an engine.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(crate) struct SharedObjects {
    /// GPUDevice.
    pub(crate) device: wasm_bindgen::JsValue,
    /// GPUBuffer: f32, 2 or 3 a vertex; of doubles the nearest ones.
    pub(crate) positions: wasm_bindgen::JsValue,
    /// GPUBuffer: u32, 3 a triangle.
    pub(crate) triangles: wasm_bindgen::JsValue,
}
