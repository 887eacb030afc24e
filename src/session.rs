//! The loop around an engine: options in, iterations and statistics out, and the honest result.

use crate::engine::{Cpu, Engine, Lawson};
#[cfg(feature = "gpu")]
use crate::engine::{Device, WebGpu};
use crate::predicates::cos_degrees;
use crate::{Error, Mesh, frozen};
use std::ops::ControlFlow;
use std::sync::Arc;
use web_time::Instant;

/// Which engine runs the phases.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The GPU where there is one that can take the mesh, else the CPU; the outcome says which and why.
    #[default]
    Auto,
    /// The CPU. Takes every mesh.
    Cpu,
    /// The GPU (WebGPU compute), or an error.
    Gpu,
}

/// Which of the many valid orders of flips is taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The parallel pipeline: the same bits on every engine after every iteration.
    #[default]
    Reproducible,
    /// Lawson's sequential algorithm on the CPU: faster on one thread, no iterations to watch.
    Any,
}

/// What the caller can choose.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Which engine.
    pub backend: Backend,
    /// β: the largest angle in degrees, 0 to 180, between the normals of two triangles whose edge may
    /// flip, before and after (3D only).
    pub max_normal_angle: f64,
    /// Stop after so many iterations; `None`: run to the end, which is always reached.
    pub max_iterations: Option<u32>,
    /// Reproducible pipeline or Lawson's algorithm.
    pub order: Order,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            backend: Backend::Auto,
            max_normal_angle: 10.0,
            max_iterations: None,
            order: Order::Reproducible,
        }
    }
}

/// Why a non-Delaunay edge was left.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reason {
    /// The triangles' normals differ by more than β before or after the flip.
    Angle,
    /// A new triangle would turn over (3D) or not be strictly positive (2D).
    Fold,
    /// The edge that the flip would make exists already.
    Duplicate,
    /// Three or more triangles, or one triangle twice, meet at the edge.
    NonManifold,
    /// Its two triangles are oriented against each other.
    Inconsistent,
    /// The run was stopped, by cancellation or the cap on iterations, before it was flipped.
    Stopped,
}

impl Reason {
    /// All reasons, in the order in which they are reported.
    pub const ALL: [Self; 6] =
        [Self::Angle, Self::Fold, Self::Duplicate, Self::NonManifold, Self::Inconsistent, Self::Stopped];

    /// The word used in results: `angle`, `fold`, `duplicate`, `non-manifold`, `inconsistent`, `stopped`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Angle => "angle",
            Self::Fold => "fold",
            Self::Duplicate => "duplicate",
            Self::NonManifold => "non-manifold",
            Self::Inconsistent => "inconsistent",
            Self::Stopped => "stopped",
        }
    }
}

/// Numbers of edges by [`Reason`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reasons([u64; 6]);

impl Reasons {
    /// Edges in all.
    pub fn total(&self) -> u64 {
        self.0.iter().sum()
    }

    /// The reasons with at least one edge.
    pub fn iter(&self) -> impl Iterator<Item = (Reason, u64)> + '_ {
        Reason::ALL.into_iter().map(|reason| (reason, self[reason])).filter(|&(_, n)| n > 0)
    }
}

impl std::ops::Index<Reason> for Reasons {
    type Output = u64;
    fn index(&self, reason: Reason) -> &u64 {
        &self.0[reason as usize]
    }
}

impl std::ops::IndexMut<Reason> for Reasons {
    fn index_mut(&mut self, reason: Reason) -> &mut u64 {
        &mut self.0[reason as usize]
    }
}

/// What one watched iteration did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iteration {
    /// Its number, from 0.
    pub index: u32,
    /// Non-Delaunay edges that may flip, in the whole mesh, before the iteration.
    pub labelled: u32,
    /// Edges flipped.
    pub flips: u32,
    /// Non-Delaunay edges that may not flip, by reason, in the whole mesh, before the iteration.
    pub blocked: Reasons,
    /// Wall time in milliseconds.
    pub ms: f64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// No edge is left that may flip.
    Done,
    /// Cancelled or capped, after a complete iteration.
    Stopped,
}

/// Wall times in milliseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Timings {
    /// Making the engine ready: upload, adjacency and the checks around it.
    pub adjacency: f64,
    /// The iterations.
    pub flip: f64,
    /// All of it, with the read-back and the final count.
    pub total: f64,
}

/// The result of a run, and what there is to say about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Vertex indices, 3 a triangle; a flip rotates two triangles in place.
    pub triangles: Vec<u32>,
    /// Done or stopped.
    pub status: Status,
    /// The engine that ran: `cpu` or `gpu`.
    pub backend: &'static str,
    /// The GPU's name and driver.
    pub adapter: Option<String>,
    /// Why `auto` did not take an engine it tried first.
    pub fallback: Option<String>,
    /// Iterations with at least one flip.
    pub iterations: u32,
    /// Flips in all.
    pub flips: u64,
    /// Flips of each iteration; a whole pass of Lawson's algorithm is one.
    pub flips_per_iteration: Vec<u32>,
    /// Compute dispatches encoded on the GPU.
    pub dispatches: u64,
    /// Edges of the mesh.
    pub edges: u64,
    /// Edges with one triangle.
    pub boundary_edges: u64,
    /// Frozen edges: three or more triangles, or one triangle twice.
    pub non_manifold_edges: u64,
    /// Frozen edges: two triangles oriented against each other.
    pub inconsistent_edges: u64,
    /// Non-Delaunay edges left, by reason.
    pub remaining: Reasons,
    /// Wall times.
    pub timings: Timings,
}

/// A mesh on an engine, step by step.
pub struct Session {
    mesh: Arc<Mesh>,
    options: Options,
    engine: Box<dyn Engine>,
    fallback: Option<String>,
    flips_per_iteration: Vec<u32>,
    has_ended: bool,
    timings: Timings,
}

impl Session {
    /// Checks the options and makes an engine ready for `mesh`.
    ///
    /// # Errors
    /// [`Error::Option`]; [`Error::BackendUnavailable`], [`Error::BackendLimit`] or [`Error::Device`] where
    /// the GPU was asked for (`Auto` takes the CPU instead).
    pub async fn new(mesh: Mesh, options: Options) -> Result<Self, Error> {
        if !(0.0..=180.0).contains(&options.max_normal_angle) {
            let message = format!("{} is not an angle from 0 to 180 degrees", options.max_normal_angle);
            return Err(Error::Option { option: "max_normal_angle", message });
        }
        let start = Instant::now();
        let mesh = Arc::new(mesh);
        let (engine, fallback) = engine_for(&mesh, &options).await?;
        Ok(Self {
            mesh,
            options,
            engine,
            fallback,
            flips_per_iteration: Vec::new(),
            has_ended: false,
            timings: Timings { adjacency: ms_since(start), ..Timings::default() },
        })
    }

    /// One iteration, watched: counts the edges of the whole mesh before it. `None` when nothing is left to
    /// flip, or the cap on iterations is reached.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub async fn step(&mut self) -> Result<Option<Iteration>, Error> {
        if self.has_ended || self.iterations_left() == 0 {
            return Ok(None);
        }
        let start = Instant::now();
        let census = self.engine.census().await?;
        let index = self.flips_per_iteration.len() as u32;
        self.iterate(1).await?;
        let ms = ms_since(start);
        Ok(self.flips_per_iteration.get(index as usize).map(|&flips| Iteration {
            index,
            labelled: census.labelled,
            flips,
            blocked: census.blocked,
            ms,
        }))
    }

    /// Runs to the end. `watch` is called after every batch of iterations with the numbers of iterations and
    /// flips so far; [`ControlFlow::Break`] stops the run after a complete iteration.
    ///
    /// # Errors
    /// [`Error::Device`], unless the backend is `Auto`: then the CPU begins again.
    pub async fn run(&mut self, mut watch: impl FnMut(u32, u64) -> ControlFlow<()>) -> Result<(), Error> {
        while !self.has_ended {
            let count = self.engine.batch().min(self.iterations_left());
            if count == 0 {
                break;
            }
            self.iterate(count).await?;
            if watch(self.flips_per_iteration.len() as u32, self.flips()).is_break() {
                break;
            }
        }
        Ok(())
    }

    /// The triangles as they are now: vertex indices, 3 a triangle.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub async fn triangles(&mut self) -> Result<Vec<u32>, Error> {
        self.engine.triangles().await
    }

    /// The result so far: reads the triangles back and counts what remains.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub async fn outcome(&mut self) -> Result<Outcome, Error> {
        let start = Instant::now();
        let triangles = self.engine.triangles().await?;
        let census = self.engine.census().await?;
        let counts = self.engine.edge_counts();
        let mut remaining = census.blocked;
        remaining[Reason::Stopped] = u64::from(census.labelled);
        if counts.non_manifold + counts.inconsistent > 0 {
            let frozen = frozen::count_non_delaunay(&self.mesh, &triangles);
            for reason in [Reason::NonManifold, Reason::Inconsistent] {
                remaining[reason] = frozen[reason];
            }
        }
        let Timings { adjacency, flip, .. } = self.timings;
        Ok(Outcome {
            triangles,
            status: if census.labelled == 0 { Status::Done } else { Status::Stopped },
            backend: self.engine.backend(),
            adapter: self.engine.adapter(),
            fallback: self.fallback.clone(),
            iterations: self.flips_per_iteration.len() as u32,
            flips: self.flips(),
            flips_per_iteration: self.flips_per_iteration.clone(),
            dispatches: self.engine.dispatches(),
            edges: u64::from(counts.edges),
            boundary_edges: u64::from(counts.boundary),
            non_manifold_edges: u64::from(counts.non_manifold),
            inconsistent_edges: u64::from(counts.inconsistent),
            remaining,
            timings: Timings { total: adjacency + flip + ms_since(start), adjacency, flip },
        })
    }

    fn flips(&self) -> u64 {
        self.flips_per_iteration.iter().map(|&n| u64::from(n)).sum::<u64>()
    }

    fn iterations_left(&self) -> u32 {
        let done = self.flips_per_iteration.len() as u32;
        self.options.max_iterations.map_or(u32::MAX, |cap| cap.saturating_sub(done))
    }

    async fn iterate(&mut self, count: u32) -> Result<(), Error> {
        let start = Instant::now();
        match self.engine.iterate(count).await {
            Ok(flips) => {
                self.has_ended = (flips.len() as u32) < count;
                self.flips_per_iteration.extend(flips);
            }
            // Determinism makes up for what the device took with it: the CPU goes the same way again.
            Err(Error::Device { message }) if self.options.backend == Backend::Auto => {
                self.fallback = Some(format!("the device failed during the run: {message}"));
                self.engine = Box::new(self.cpu());
                self.flips_per_iteration.clear();
            }
            Err(error) => return Err(error),
        }
        self.timings.flip += ms_since(start);
        Ok(())
    }

    fn cpu(&self) -> Cpu {
        Cpu::new(self.mesh.clone(), cos_degrees(self.options.max_normal_angle))
    }
}

/// The engine for the options, and why `Auto` did not take the GPU.
async fn engine_for(mesh: &Arc<Mesh>, options: &Options) -> Result<(Box<dyn Engine>, Option<String>), Error> {
    let cos = cos_degrees(options.max_normal_angle);
    let cpu = || Cpu::new(mesh.clone(), cos);
    match (options.order, options.backend) {
        (Order::Any, Backend::Gpu) => {
            let message = "`any` is sequential and runs on the cpu only".to_owned();
            Err(Error::Option { option: "order", message })
        }
        (Order::Any, _) => Ok((Box::new(Lawson::new(cpu())), None)),
        (Order::Reproducible, Backend::Cpu) => Ok((Box::new(cpu()), None)),
        (Order::Reproducible, Backend::Gpu) => Ok((gpu(mesh, cos).await?, None)),
        (Order::Reproducible, Backend::Auto) => match auto_gpu(mesh, cos).await {
            Ok(engine) => Ok((engine, None)),
            Err(error) => Ok((Box::new(cpu()), Some(error.to_string()))),
        },
    }
}

#[cfg(feature = "gpu")]
async fn gpu(mesh: &Arc<Mesh>, cos: f64) -> Result<Box<dyn Engine>, Error> {
    Ok(Box::new(WebGpu::new(Device::shared().await?, mesh, cos).await?))
}

/// `Auto` leaves a GPU alone that the processor plays.
#[cfg(feature = "gpu")]
async fn auto_gpu(mesh: &Arc<Mesh>, cos: f64) -> Result<Box<dyn Engine>, Error> {
    let device = Device::shared().await?;
    if device.is_software {
        let message = "the only adapter is software, slower than the cpu engine".to_owned();
        return Err(Error::BackendUnavailable { backend: "gpu", message });
    }
    gpu(mesh, cos).await
}

#[cfg(not(feature = "gpu"))]
use gpu as auto_gpu;

#[cfg(not(feature = "gpu"))]
async fn gpu(_mesh: &Arc<Mesh>, _cos: f64) -> Result<Box<dyn Engine>, Error> {
    let message = "this build has no GPU engine (feature `gpu`)".to_owned();
    Err(Error::BackendUnavailable { backend: "gpu", message })
}

fn ms_since(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}

/// Makes `mesh` Delaunay by flipping edges. `watch` is as in [`Session::run`].
///
/// # Errors
/// Those of [`Session::new`] and [`Session::run`].
#[cfg(not(target_arch = "wasm32"))]
pub fn make_delaunay(
    mesh: &Mesh,
    options: &Options,
    watch: impl FnMut(u32, u64) -> ControlFlow<()>,
) -> Result<Outcome, Error> {
    pollster::block_on(async {
        let mut session = Session::new(mesh.clone(), options.clone()).await?;
        session.run(watch).await?;
        session.outcome().await
    })
}
