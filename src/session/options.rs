//! What the caller of a run can choose.

use crate::error::number;
use crate::phases::Thresholds;
use crate::{Error, cos_degrees};
use std::num::NonZeroUsize;

/// Which engine runs the phases.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The one of the CPU and the GPU that is done first, start-up included; the outcome says which and why. A GPU that a
    /// session before has made ready needs no start-up.
    #[default]
    Auto,
    /// The CPU. Takes every mesh.
    Cpu,
    /// The GPU (WebGPU compute), or an error.
    Gpu,
    /// The GPU through WebGL2, in a browser, or an error.
    WebGl,
}

/// Which of the many valid orders of flips is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The parallel pipeline: the same bits on every engine after every iteration.
    #[default]
    Reproducible,
    /// Lawson's sequential algorithm on the CPU: faster, no iterations to watch.
    Any,
}

/// The largest number for [`Options::threads`].
pub const MOST_THREADS: usize = 256;

/// What the caller can choose.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Which engine.
    pub backend: Backend,
    /// β: the largest angle in degrees, 0 to 180, between the normals of two triangles whose edge may
    /// flip, before and after (3D only). An edge of the input over β is a crease and stays, even if flips around
    /// it lower its angle.
    pub max_normal_angle: f64,
    /// The largest distance between the old and the new diagonal of a flip, in the units of the positions, rounded down to
    /// a 32-bit float (3D only): what one flip may move the surface by. Infinite: any. Of the lines that they lie on, where
    /// the diagonals themselves do not pass each other.
    pub max_deviation: f64,
    /// Stop after so many iterations; `None`: run to the end, which is always reached.
    pub max_iterations: Option<u32>,
    /// Edges that never flip, by the two vertices of each, in any order; repeated pairs are one. Those that are still
    /// not Delaunay at the end are counted by [`Reason::Locked`](crate::Reason::Locked). Every pair has to be an edge
    /// of the mesh; to lock one that cannot flip, on the boundary or frozen, changes nothing.
    pub locked_edges: Vec<[u32; 2]>,
    /// Triangles that stay as they are, by their numbers: their edges are locked.
    pub locked_triangles: Vec<u32>,
    /// A number for each triangle, or nothing: edges between triangles of different numbers are locked, so that every
    /// group keeps its border. Flips leave each triangle in its group.
    pub groups: Vec<u32>,
    /// Reproducible pipeline or Lawson's algorithm.
    pub order: Order,
    /// How many threads the CPU engine runs on, at most [`MOST_THREADS`]; `None`: one for each core. No more are started
    /// than there are pieces of 4,096 triangles, and a mesh of fewer than 65,536 is done on one, before others have woken
    /// up. The result is the same for any
    /// number. Lawson's algorithm flips on several in the plane only, where no vertex has triangles on two sides
    /// that share no edge. Without the feature `threads` it is always one.
    /// What goes to a GPU and comes back is copied on one for each core.
    pub threads: Option<NonZeroUsize>,
    /// The device that the GPU engine runs on, instead of one of its own. It is never destroyed here, nothing of it
    /// is set, and its errors about other calls are left alone. Of a software one, `Auto` takes the CPU.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub device: Option<crate::wasm::session::GpuDevice>,
    /// If set, `Auto` fails where it would take the CPU: another module has the CPU engine, on so many threads.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub leaves_cpu: Option<usize>,
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
            let message = format!("{} is not a distance from 0 on", number(self.max_deviation));
            return Err(Error::Option { option: "max_deviation", message });
        }
        self.threads.map_or(Ok(()), |count| threads(count.get()).map(drop))
    }

    /// How many iterations a run may do after so many.
    pub(super) fn iterations_left(&self, done: u32) -> u32 {
        self.max_iterations.map_or(u32::MAX, |most| most.saturating_sub(done))
    }
}

/// A number of threads, if it is one.
///
/// # Errors
/// [`Error::Option`].
pub(crate) fn threads(count: usize) -> Result<NonZeroUsize, Error> {
    NonZeroUsize::new(count).filter(|_| count <= MOST_THREADS).ok_or_else(|| {
        let message = format!("{count} is not a number of threads, 1 to {MOST_THREADS}");
        Error::Option { option: "threads", message }
    })
}

#[cfg(feature = "gpu")]
impl Options {
    /// The device that they give, if they do.
    pub(crate) fn given_device(&self) -> Option<&crate::engine::GivenDevice> {
        #[cfg(all(target_arch = "wasm32", feature = "js"))]
        return self.device.as_ref();
        #[cfg(not(all(target_arch = "wasm32", feature = "js")))]
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
            order: Order::Reproducible,
            threads: None,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            device: None,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            leaves_cpu: None,
            #[cfg(all(target_arch = "wasm32", feature = "js-session"))]
            given: js_sys::Object::new(),
        }
    }
}
