//! What a session asks of an engine, and what an engine answers.

#[cfg(feature = "gpu")]
use crate::Reason;
use crate::mesh::areas::Areas;
use crate::{Adjacency, EngineKind, Error, Mesh, Positions, Reasons};
use std::pin::Pin;
use std::sync::Arc;

/// A future for the answer of an engine.
pub(crate) type Answer<'a, T> = Pin<Box<dyn Future<Output = Result<T, Error>> + 'a>>;

/// The numbers of non-Delaunay interior edges in the whole mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Census {
    /// Edges that may flip.
    pub(crate) labelled: u32,
    /// Edges that may not, by `Angle`, `Fold`, `Duplicate`, `Locked` or `Deviation`.
    pub(crate) blocked: Reasons,
}

#[cfg(feature = "gpu")]
impl Census {
    /// The reasons that the shaders count: those up to `Deviation`.
    const REASONS: usize = Reason::Deviation as usize + 1;

    /// From the counts of the shaders: the labelled edges, then the edges blocked by each reason.
    pub(super) fn of_counts(counts: &[u32]) -> Self {
        let mut census = Self { labelled: counts[0], ..Self::default() };
        for (reason, count) in Reason::ALL.into_iter().take(Self::REASONS).zip(&counts[1..]) {
            census.blocked[reason] = u64::from(*count);
        }
        census
    }
}

/// The most iterations of an update.
pub(crate) const MOST_ITERATIONS: u32 = 64;

/// The state of a mesh that moves, after an update.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Moved {
    pub(crate) census: Census,
    /// Edges left alone, because a number is not finite.
    pub(crate) infinite: u32,
    /// Edges left alone, because their points span more bits than the engine decides.
    pub(crate) wide: u32,
    /// Flips of all updates.
    pub(crate) flips: u64,
    pub(crate) areas: Areas,
}

#[cfg(feature = "gpu")]
impl Moved {
    /// From the counts of the shaders: those of the census, the edges left alone for either reason, the areas, the low
    /// and the high word of the flips.
    pub(super) fn of_counts(counts: &[u32]) -> Self {
        let (census, rest) = counts.split_at(1 + Census::REASONS);
        Self {
            census: Census::of_counts(census),
            infinite: rest[0],
            wide: rest[1],
            areas: Areas::of_counts(&rest[2..5]),
            flips: u64::from(rest[5]) | u64::from(rest[6]) << 32,
        }
    }
}

/// The numbers of edges of each kind. Flips do not change them.
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

/// Positions from the bits of 32-bit floats.
#[cfg(feature = "gpu")]
pub(super) fn positions_of(words: Vec<u32>) -> Positions {
    words.into_iter().map(f32::from_bits).collect::<Vec<_>>().into()
}

/// Triangles in a JavaScript array.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(super) fn array(triangles: Answer<'_, Vec<u32>>) -> Answer<'_, js_sys::Uint32Array> {
    Box::pin(async { Ok(triangles.await?.as_slice().into()) })
}

/// One mesh on one engine, between two iterations.
pub(crate) trait Engine {
    /// How many iterations to request at a time, so that the cost of a request is small.
    fn batch(&self) -> u32;

    /// Locks edges, so that they never flip. `half_edges` has both half-edges of each edge; half-edges without a twin
    /// are skipped. Called before the first iteration.
    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()>;

    /// Runs up to `count` iterations and returns the flips of each. Returns fewer than `count` when no edge is left to
    /// flip.
    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>>;

    /// Counts the non-Delaunay interior edges of the whole mesh.
    fn census(&mut self) -> Answer<'_, Census>;

    /// Counts the triangles whose area is not positive.
    fn areas(&mut self) -> Answer<'_, Areas>;

    /// The present triangles.
    fn triangles(&mut self) -> Answer<'_, Vec<u32>>;

    /// The present triangles of an engine that is not used any more.
    #[cfg(not(target_arch = "wasm32"))]
    fn take_triangles(&mut self) -> Answer<'_, Vec<u32>> {
        self.triangles()
    }

    /// The present triangles in a JavaScript array.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn triangles_array(&mut self) -> Answer<'_, js_sys::Uint32Array> {
        self::array(self.triangles())
    }

    /// The present twins, with the flags [`CREASE`](crate::mesh::half_edge::CREASE) and
    /// [`LOCKED`](crate::mesh::half_edge::LOCKED).
    fn twins(&mut self) -> Answer<'_, Vec<u32>>;

    /// Replaces the positions. The engine then equals a new one on `mesh` with the same locks. `mesh` has the present
    /// triangles of the engine, or, with `twins`, others: these are their twins, with the flags of locked edges. Each
    /// vertex then has as many fans as before. After [`Error::BackendLimit`] the engine is unchanged.
    fn set_positions(&mut self, mesh: Arc<Mesh>, twins: Option<Vec<u32>>) -> Answer<'_, ()>;

    /// Whether the engine has started, so that [`Engine::update`] may follow.
    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    fn is_settled(&self) -> bool {
        true
    }

    /// Waits until the engine has started, so that [`Engine::update`] may follow.
    fn settle(&mut self) -> Answer<'_, ()> {
        Box::pin(std::future::ready(Ok(())))
    }

    /// The vertices have moved, to `positions` or, on a GPU, to those that the caller has written. Tests all edges, and
    /// runs up to `iterations` iterations. A GPU only submits them. The iterations count on from the updates before;
    /// the winding stays. `untangles`: whether triangles of a mesh in the plane that have turned over get others first;
    /// WebGL2 and the modules of the npm package only flip.
    fn update(&mut self, positions: Option<Positions>, iterations: u32, untangles: bool)
    -> Result<(), Error>;

    /// Counts after all updates so far. Later updates do not change the answer.
    fn moved(&mut self) -> Answer<'static, Moved>;

    /// Begins to keep the update in which each triangle last changed, for [`Engine::changes`].
    fn track_changes(&mut self) -> Answer<'_, ()>;

    /// For each triangle the number of the update in which it last changed, from 1 on; 0 if none has changed it. Empty
    /// if they are not tracked.
    fn changes(&mut self) -> Answer<'_, Vec<u32>>;

    /// The present positions, after updates.
    fn positions(&mut self) -> Answer<'_, Positions>;

    /// The numbers of edges of each kind.
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

    /// The peak size of the WebGPU buffers in bytes.
    fn device_bytes(&self) -> u64 {
        0
    }

    /// Milliseconds for the adjacency, if the engine measures them apart from its other start-up.
    fn adjacency_ms(&self) -> Option<f64> {
        None
    }

    /// Whether the triangles stay on the device until somebody asks for them. Else an engine may read them early.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn set_stays(&mut self, _stays: bool) {}

    /// A promise of a JavaScript array for the triangles, or of nothing.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn set_spare(&mut self, _spare: Option<js_sys::Object>) {}

    /// The buffers that a program can draw from, if the engine runs on WebGPU.
    #[cfg(all(not(target_arch = "wasm32"), feature = "gpu"))]
    fn gpu_buffers(&self) -> Option<GpuBuffers> {
        None
    }

    /// An object with the device and the buffers, as `SessionBuffers` in `src/js/session-buffers.ts`, if the engine
    /// runs on the browser's WebGPU; else undefined.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn shared_objects(&self) -> wasm_bindgen::JsValue {
        wasm_bindgen::JsValue::UNDEFINED
    }
}

/// What a program needs to write the positions on the GPU, and to draw from the buffers. See
/// [`Session::gpu`](crate::Session::gpu).
#[cfg(all(not(target_arch = "wasm32"), feature = "gpu"))]
#[derive(Clone, Debug, PartialEq)]
pub struct GpuBuffers {
    /// The device of the session.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// f32, 2 or 3 per vertex, without gaps. Its usage includes `STORAGE`, `VERTEX`, `COPY_SRC` and `COPY_DST`.
    pub positions: wgpu::Buffer,
    /// u32, 3 per triangle. Its usage includes `STORAGE`, `INDEX`, `COPY_SRC` and `COPY_DST`. Only read it.
    pub triangles: wgpu::Buffer,
    /// With [`Options::track_changes`](crate::Options::track_changes): a buffer, and the offset in bytes at which it has
    /// the words of [`Session::changes`](crate::Session::changes), one per triangle. Its usage includes `STORAGE` and
    /// `COPY_SRC`. Only read it.
    pub changes: Option<(wgpu::Buffer, u64)>,
    /// With [`Options::adjacency`](crate::Options::adjacency): u32, one per half-edge. Half-edge `3t + k` goes from
    /// corner `k` of triangle `t` to the next corner; its twin is the half-edge on the other side, in the opposite
    /// direction. [`NONE`](crate::NONE) on the boundary, at an edge of three or more triangles, and between triangles
    /// of opposite orientations. Its usage includes `STORAGE` and `COPY_SRC`. Only read it.
    pub twins: Option<wgpu::Buffer>,
    /// The same, one per vertex: a half-edge that starts at the vertex; the smallest without a twin, or else the
    /// smallest. From there `twins[prev(h)]`, with `prev(h)` the half-edge before `h` in its triangle, goes to the next
    /// triangle, and reaches all triangles of the vertex before it is the first half-edge again, or `NONE`. Where the
    /// triangles of a vertex are several fans, it reaches those of one fan. `NONE` for a vertex without triangles.
    pub vertex_half_edges: Option<wgpu::Buffer>,
}
