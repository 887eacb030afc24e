//! The options of a run.

use crate::error::number;
use crate::phases::Thresholds;
use crate::system::threads::checked;
use crate::{Error, cos_degrees};
use std::num::NonZeroUsize;

/// Which engine runs the phases.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The CPU or the GPU, whichever is estimated to finish first, start-up included; the outcome says which and why. A
    /// GPU that an earlier session has opened needs no start-up.
    #[default]
    Auto,
    /// The CPU. Takes every mesh.
    Cpu,
    /// The GPU (WebGPU compute), or an error.
    Gpu,
    /// The GPU through WebGL2, in a browser, or an error.
    WebGl,
}

/// The order of the flips. Each order gives a valid result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The parallel iterations: the same bits on every engine after every iteration.
    #[default]
    Reproducible,
    /// Lawson's algorithm on the CPU. It is faster, and has no iterations to watch.
    Any,
}

/// The options of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The engine.
    pub backend: Backend,
    /// β: the largest angle in degrees, 0 to 180, between the normals of two triangles whose edge may flip, before and
    /// after the flip (3D only). An edge of the input over β is a crease: it never flips, even if flips around it lower
    /// its angle.
    pub max_normal_angle: f64,
    /// The largest distance between the old and the new diagonal of a flip, in the units of the positions, rounded down
    /// to a 32-bit float (3D only). It limits how far one flip moves the surface; infinity sets no limit. The distance
    /// is that of the lines through the two diagonals, even if the diagonals end before their lines come closest.
    pub max_deviation: f64,
    /// The most iterations; `None`: no limit. Every run ends by itself.
    pub max_iterations: Option<u32>,
    /// Edges that never flip, each by its two vertices in any order. Pairs may repeat, and each has to be an edge of
    /// the mesh. [`Reason::Locked`](crate::Reason::Locked) counts those that are not Delaunay at the end. Locking a
    /// boundary edge or a frozen edge changes nothing.
    pub locked_edges: Vec<[u32; 2]>,
    /// Triangles that stay, by their indices: all of their edges are locked.
    pub locked_triangles: Vec<u32>,
    /// A number for each triangle, or empty. Edges between triangles of different numbers are locked, so every group
    /// keeps its border, and every triangle stays in its group.
    pub groups: Vec<u32>,
    /// Edges to bring in before the run, each by its two vertices (2D only). They are locked. A vertex on one
    /// splits it. See [`constrained`](crate::constrained). In the npm package, another module brings them in.
    pub constraints: Vec<[u32; 2]>,
    /// The largest distance of a vertex from a constraint that counts as on it, in the units of the positions: the
    /// constraint then goes through the vertex, so that lines meet which miss their common vertex by rounding.
    /// [`Outcome::constraint_deviation`](crate::Outcome::constraint_deviation) is the largest of these distances. Each
    /// vertex within it counts, in the order along the constraint. 0: only those exactly on it. Constraints then come in
    /// on one thread.
    pub constraint_tolerance: f64,
    /// Whether constraints that cannot be brought in are left out, and listed in
    /// [`Outcome::left_out`](crate::Outcome::left_out). Otherwise they are errors.
    pub skips_constraints: bool,
    /// In the plane: whether triangles that have turned over, or have no area, become positive again. Flips cannot do
    /// that: vertices are lifted out, and put back where their points are. The vertices stay, and so does the boundary.
    /// `None`: after the vertices have moved, in [`Session::set_positions`](crate::Session::set_positions) and the calls
    /// that act like it, and in a fixed number of rounds in each [`Session::update`](crate::Session::update).
    /// `Some(true)`: also before the first run; an error for a mesh in space. `Some(false)`: never.
    pub untangle: Option<bool>,
    /// The order of the flips.
    pub order: Order,
    /// Whether a session keeps, for each triangle, the update that changed it last:
    /// [`Session::changes`](crate::Session::changes).
    pub track_changes: bool,
    /// Whether a session on WebGPU keeps the adjacency in buffers, for kernels that walk around vertices: `twins` and
    /// `vertex_half_edges` of [`GpuBuffers`](crate::GpuBuffers), 12 bytes per triangle and 4 per vertex.
    pub adjacency: bool,
    /// Threads of the CPU engine, at most [`MOST_THREADS`](crate::MOST_THREADS); `None`: one per core. The engine starts
    /// at most one thread per 4,096 triangles, and runs meshes of fewer than 65,536 triangles on one thread. The result
    /// does not depend on the number. Lawson's algorithm flips on several threads only if every vertex has one fan.
    /// Without the feature `threads` the engine always has one thread. Copies to and from a GPU use one thread per core.
    pub threads: Option<NonZeroUsize>,
    /// The device for the WebGPU engine, instead of a device of its own. The engine never destroys it, changes none of
    /// its settings, and ignores errors of calls that are not its own. If it is a software GPU, `Auto` takes the CPU.
    #[cfg(any(
        all(target_arch = "wasm32", feature = "js"),
        all(not(target_arch = "wasm32"), feature = "gpu")
    ))]
    pub device: Option<crate::engine::GpuDevice>,
    /// Whether `Auto`, which JavaScript has asked already, takes the GPU or fails: another WebAssembly module then runs
    /// the CPU engine, on threads.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub leaves_cpu: bool,
    /// A promise of a Uint32Array for the triangles of the result, or of nothing.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub spare: Option<js_sys::Object>,
    /// Locked edges that the mesh lost when it was untangled before the session, each with the smaller vertex first.
    /// Sorted.
    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    pub lost_edges: Vec<[u32; 2]>,
    /// The object of JavaScript that these options were read from, without its lists. Other modules read it again.
    #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
    pub given: js_sys::Object,
}

impl Options {
    /// Checks each value alone, without the mesh.
    ///
    /// # Errors
    /// [`Error::Option`].
    pub(super) fn check(&self) -> Result<(), Error> {
        if !(0.0..=180.0).contains(&self.max_normal_angle) {
            let message = format!("{} is not an angle from 0 to 180 degrees", number(self.max_normal_angle));
            return Err(Error::Option { option: "max_normal_angle", message });
        }
        if self.max_deviation.is_nan() || self.max_deviation < 0.0 {
            let message = format!("{} is not a distance: give 0 or more", number(self.max_deviation));
            return Err(Error::Option { option: "max_deviation", message });
        }
        if self.track_changes && self.order == Order::Any {
            let message = "the order `any` has no changes to track".to_owned();
            return Err(Error::Option { option: "track_changes", message });
        }
        self.threads.map_or(Ok(()), |count| checked(count.get()).map(drop))
    }

    /// How many iterations a run may still do after `done` iterations.
    pub(super) fn iterations_left(&self, done: u32) -> u32 {
        self.max_iterations.map_or(u32::MAX, |most| most.saturating_sub(done))
    }
}

#[cfg(feature = "gpu")]
impl Options {
    /// The device that the caller gives, if any.
    pub(crate) fn given_device(&self) -> Option<&crate::engine::GivenDevice> {
        #[cfg(any(not(target_arch = "wasm32"), feature = "js"))]
        return self.device.as_ref();
        #[cfg(all(target_arch = "wasm32", not(feature = "js")))]
        None
    }
}

impl From<&Options> for Thresholds {
    fn from(options: &Options) -> Self {
        let most = options.max_deviation;
        let nearest = most as f32;
        Self {
            cos: cos_degrees(options.max_normal_angle),
            deviation: if f64::from(nearest) > most { nearest.next_down() } else { nearest },
        }
    }
}

impl Default for Options {
    fn default() -> Self {
        Self {
            backend: Backend::Auto,
            max_normal_angle: 10.0,
            max_deviation: f64::INFINITY,
            max_iterations: None,
            locked_edges: Vec::new(),
            locked_triangles: Vec::new(),
            groups: Vec::new(),
            constraints: Vec::new(),
            constraint_tolerance: 0.0,
            skips_constraints: false,
            untangle: None,
            order: Order::Reproducible,
            track_changes: false,
            adjacency: false,
            threads: None,
            #[cfg(any(
                all(target_arch = "wasm32", feature = "js"),
                all(not(target_arch = "wasm32"), feature = "gpu")
            ))]
            device: None,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            leaves_cpu: false,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            spare: None,
            #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
            lost_edges: Vec::new(),
            #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
            given: js_sys::Object::new(),
        }
    }
}
