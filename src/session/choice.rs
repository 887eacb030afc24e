//! Which engine a session runs on.

use super::cost::Job;
use super::fallback::without_gpu;
use super::{memory_bounds, open_gpu};
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use crate::engine::Proxy;
use crate::engine::{Answer, Cpu, Engine, Lawson};
use crate::mesh::named_edges;
use crate::phases::Thresholds;
use crate::system::memory;
use crate::system::threads::Threads;
use crate::{Backend, Error, Mesh, Options, Order};
use std::sync::Arc;

/// An engine, and why `Auto` chose the CPU, or started there.
pub(super) struct Choice {
    pub(super) engine: Box<dyn Engine>,
    pub(super) fallback: Option<String>,
    /// Whether the session may change from the CPU to a GPU that becomes ready.
    pub(super) may_change: bool,
}

/// The job that `Auto` estimates for a mesh.
pub(super) fn job_of(mesh: &Mesh, options: &Options) -> Job {
    let triangles = mesh.triangle_count();
    Job { triangles, dimension: mesh.dimension(), threads: Threads::count_for(options.threads, triangles) }
}

/// Whether a session with these options tries a GPU first for this job.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn asks_gpu(options: &Options, job: Job) -> bool {
    match (options.order, options.backend) {
        (Order::Reproducible, Backend::Auto) => job.waits_for_gpu(),
        (Order::Reproducible, backend) => backend == Backend::Gpu,
        (Order::Any, _) => false,
    }
}

/// Why `Auto` takes the CPU without trying a GPU, or `None` if it tries one. If the job suits a GPU that is not ready,
/// a browser starts to prepare it for later runs. `is_double`: whether the coordinates are 64-bit.
pub(crate) fn why_cpu(job: Job, is_double: bool, options: &Options) -> Option<String> {
    if !job.is_for_gpu() {
        return Some(format!("the cpu finishes {} triangles sooner", job.triangles));
    }
    if job.waits_for_gpu() || open_gpu::is_ready(job, is_double, options) {
        return None;
    }
    Some(open_gpu::why_not_ready(job, is_double, options))
}

/// Whether `Auto` continues on a GPU that has become ready, after `set_up` and `flip` milliseconds on the CPU.
pub(super) fn changes_to_gpu(mesh: &Mesh, options: &Options, (set_up, flip): (f64, f64)) -> bool {
    let job = job_of(mesh, options);
    job.continues_on_gpu(set_up, flip) && open_gpu::is_ready(job, mesh.positions().is_double(), options)
}

/// The engine for the options. Boxed, as [`open`].
///
/// # Errors
/// Those of the requested engine; for `Auto`, only [`Error::OutOfMemory`]; [`Error::Option`] for an edge to lock that
/// the mesh does not have.
pub(super) fn engine_for<'a>(mesh: &'a Arc<Mesh>, options: &'a Options) -> Answer<'a, Choice> {
    Box::pin(async move {
        match (options.order, options.backend) {
            (Order::Any, Backend::Gpu | Backend::WebGl) => {
                let message = "`any` runs on the cpu only".to_owned();
                Err(Error::Option { option: "order", message })
            }
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            (Order::Reproducible, Backend::Auto) if options.leaves_cpu => auto(mesh, options).await,
            (Order::Reproducible, Backend::Auto) => {
                let is_double = mesh.positions().is_double();
                match why_cpu(job_of(mesh, options), is_double, options) {
                    None => auto(mesh, options).await,
                    Some(why) => Ok(Choice { may_change: true, ..cpu_after(why, mesh, options).await? }),
                }
            }
            (Order::Any, _) => alone(Backend::Cpu, mesh, options, None).await,
            (Order::Reproducible, backend) => alone(backend, mesh, options, None).await,
        }
    })
}

/// The engine that a session begins with. Takes the memory for its result from the options, so that no session holds it
/// for longer than the engine needs it.
///
/// # Errors
/// Those of [`engine_for`].
pub(super) async fn first_engine(mesh: &Arc<Mesh>, options: &mut Options) -> Result<Choice, Error> {
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    {
        let spare = options.spare.take();
        let mut choice = engine_for(mesh, options).await?;
        choice.engine.set_spare(spare);
        Ok(choice)
    }
    #[cfg(not(all(target_arch = "wasm32", feature = "js")))]
    engine_for(mesh, options).await
}

/// The GPU, or the CPU where the GPU does not take the mesh. With `leaves_cpu`, [`Error::Device`] with the reason.
async fn auto(mesh: &Arc<Mesh>, options: &Options) -> Result<Choice, Error> {
    match open(Backend::Gpu, mesh, options).await {
        Ok(engine) => Ok(Choice { engine, fallback: None, may_change: false }),
        // The CPU would need the same memory, and the same edges to lock.
        Err(error @ (Error::OutOfMemory { .. } | Error::Option { .. })) => Err(error),
        #[cfg(all(target_arch = "wasm32", feature = "js"))]
        Err(error) if options.leaves_cpu => Err(Error::Device { message: without_gpu(error.to_string()) }),
        Err(error) => cpu_after(without_gpu(error.to_string()), mesh, options).await,
    }
}

/// The CPU, which takes every mesh. `why` says why no other engine runs.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) fn cpu_after<'a>(why: String, mesh: &'a Arc<Mesh>, options: &'a Options) -> Answer<'a, Choice> {
    Box::pin(alone(Backend::Cpu, mesh, options, Some(why)))
}

/// The GPU, after it has repeated `iterations` iterations.
///
/// # Errors
/// Those of [`engine_for`] for the GPU.
pub(super) fn gpu_after<'a>(
    iterations: u32,
    mesh: &'a Arc<Mesh>,
    options: &'a Options,
) -> Answer<'a, Box<dyn Engine>> {
    Box::pin(async move {
        let mut engine = open(Backend::Gpu, mesh, options).await?;
        engine.iterate(iterations).await?;
        Ok(engine)
    })
}

/// An engine that the session keeps.
async fn alone(
    backend: Backend,
    mesh: &Arc<Mesh>,
    options: &Options,
    fallback: Option<String>,
) -> Result<Choice, Error> {
    Ok(Choice { engine: open(backend, mesh, options).await?, fallback, may_change: false })
}

/// Boxed, so that the code that starts an engine is compiled only once.
fn open<'a>(backend: Backend, mesh: &'a Arc<Mesh>, options: &'a Options) -> Answer<'a, Box<dyn Engine>> {
    Box::pin(async move {
        let (thresholds, locked) =
            (Thresholds::from(options), named_edges::half_edges(mesh, &options.locked_edges)?);
        let cpu = || {
            memory::check(memory_bounds::bytes(mesh, options))?;
            let threads = Threads::new(options.threads, mesh.triangle_count())?;
            Ok::<_, Error>(Cpu::arranged(mesh.clone(), thresholds, threads))
        };
        let mut engine = match (backend, options.order) {
            (Backend::Gpu, _) => open_gpu::engine(mesh, options, thresholds).await?,
            (Backend::WebGl, _) => webgl(mesh, options).await?,
            (_, Order::Reproducible) => Box::new(cpu()?),
            (_, Order::Any) => Box::new(Lawson::new(cpu()?)),
        };
        if !locked.is_empty() {
            engine.lock(locked).await?;
        }
        if options.track_changes {
            engine.track_changes().await?;
        }
        Ok(engine)
    })
}

#[cfg(all(target_arch = "wasm32", feature = "js"))]
async fn webgl(mesh: &Arc<Mesh>, options: &Options) -> Result<Box<dyn Engine>, Error> {
    Ok(Box::new(Proxy::new(mesh, &options.given).await?))
}

#[cfg(not(all(target_arch = "wasm32", feature = "js")))]
async fn webgl(_mesh: &Arc<Mesh>, _options: &Options) -> Result<Box<dyn Engine>, Error> {
    let message = "WebGL2 runs only in browsers, through the npm package".to_owned();
    Err(Error::BackendUnavailable { backend: crate::EngineKind::WebGl, message })
}
