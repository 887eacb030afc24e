//! Which engine a session runs on.

use super::room;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use crate::engine::Proxy;
use crate::engine::{Answer, Cpu, Engine, Lawson};
#[cfg(feature = "gpu")]
use crate::engine::{Device, Upload, WebGpu, self_test};
use crate::phases::Thresholds;
use crate::threads::Threads;
use crate::{Backend, Error, Mesh, Options, Order, locks, memory};
use std::sync::Arc;

/// What `Auto` tries, in this order. The last takes every mesh.
#[cfg(target_arch = "wasm32")]
const ORDER: [Backend; 3] = [Backend::Gpu, Backend::WebGl, Backend::Cpu];
#[cfg(not(target_arch = "wasm32"))]
const ORDER: [Backend; 2] = [Backend::Gpu, Backend::Cpu];

/// A mesh of fewer triangles is done on the CPU before a GPU has answered once: see the crossover in README.
const FEWEST_FOR_GPU: usize = 10_000;

/// An engine, and why `Auto` did not take those before it.
type Choice = (Box<dyn Engine>, Option<String>);

/// Whether a session with these options asks for a GPU first, for so many triangles.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn asks_gpu(options: &Options, triangles: usize) -> bool {
    match (options.order, options.backend) {
        (Order::Reproducible, Backend::Auto) => triangles >= FEWEST_FOR_GPU,
        (Order::Reproducible, backend) => backend == Backend::Gpu,
        (Order::Any, _) => false,
    }
}

/// The engine for the options. Boxed, as below.
///
/// # Errors
/// Those of the engine asked for; none for `Auto`.
pub(super) fn engine_for<'a>(mesh: &'a Arc<Mesh>, options: &'a Options) -> Answer<'a, Choice> {
    Box::pin(async move {
        match (options.order, options.backend) {
            (Order::Any, Backend::Gpu | Backend::WebGl) => {
                let message = "`any` is sequential and runs on the cpu only".to_owned();
                Err(Error::Option { option: "order", message })
            }
            (Order::Any, _) => Ok((open(Backend::Cpu, mesh, options).await?, None)),
            (Order::Reproducible, Backend::Auto) if mesh.triangle_count() < FEWEST_FOR_GPU => {
                let why =
                    format!("a mesh of fewer than {FEWEST_FOR_GPU} triangles is done sooner on the cpu");
                Ok((open(Backend::Cpu, mesh, options).await?, Some(why)))
            }
            (Order::Reproducible, Backend::Auto) => {
                #[cfg(all(target_arch = "wasm32", feature = "js"))]
                let backends = &ORDER[..ORDER.len() - usize::from(options.leaves_cpu)];
                #[cfg(not(all(target_arch = "wasm32", feature = "js")))]
                let backends = &ORDER;
                first_of(backends, Vec::new(), mesh, options).await
            }
            (Order::Reproducible, backend) => Ok((open(backend, mesh, options).await?, None)),
        }
    })
}

/// The engine that `Auto` takes where the one named `failed` has failed with `why`.
///
/// # Errors
/// As [`engine_for`].
pub(super) fn engine_after<'a>(
    failed: &str,
    why: String,
    mesh: &'a Arc<Mesh>,
    options: &'a Options,
) -> Answer<'a, Choice> {
    let names = |backend: &Backend| match backend {
        Backend::Gpu => "gpu",
        Backend::WebGl => "webgl2",
        Backend::Auto | Backend::Cpu => "cpu",
    };
    let place = ORDER.iter().position(|backend| names(backend) == failed).unwrap_or(0);
    first_of(&ORDER[place + 1..], vec![why], mesh, options)
}

/// The first engine that takes the mesh. Boxed, as below.
fn first_of<'a>(
    backends: &'a [Backend],
    mut reasons: Vec<String>,
    mesh: &'a Arc<Mesh>,
    options: &'a Options,
) -> Answer<'a, Choice> {
    Box::pin(async move {
        for &backend in backends {
            match open(backend, mesh, options).await {
                Ok(engine) => return Ok((engine, (!reasons.is_empty()).then(|| reasons.join("; ")))),
                // It is the mesh that is too large.
                Err(error @ Error::OutOfMemory { .. }) => return Err(error),
                Err(error) => reasons.push(error.to_string()),
            }
        }
        Err(Error::Device { message: reasons.join("; ") })
    })
}

/// Boxed, so that what an engine does to begin is compiled into one place only.
fn open<'a>(backend: Backend, mesh: &'a Arc<Mesh>, options: &'a Options) -> Answer<'a, Box<dyn Engine>> {
    Box::pin(async move {
        let thresholds = Thresholds::from(options);
        let cpu = || {
            memory::check(room::bytes(mesh, options))?;
            let threads = Threads::new(options.threads, mesh.triangle_count())?;
            Ok::<_, Error>(Cpu::new(mesh.clone(), thresholds, threads))
        };
        let mut engine = match (backend, options.order) {
            (Backend::Gpu, _) => gpu(mesh, options, thresholds).await?,
            (Backend::WebGl, _) => webgl(mesh, options, thresholds).await?,
            (_, Order::Reproducible) => Box::new(cpu()?),
            (_, Order::Any) => Box::new(Lawson::new(cpu()?)),
        };
        if !options.locked_edges.is_empty() {
            engine.lock(locks::half_edges(mesh, &options.locked_edges)?).await?;
        }
        Ok(engine)
    })
}

#[cfg(feature = "gpu")]
async fn gpu(mesh: &Arc<Mesh>, options: &Options, thresholds: Thresholds) -> Result<Box<dyn Engine>, Error> {
    let upload = Upload::new("gpu", mesh.clone(), thresholds)?;
    let form = Some(upload.form());
    // `Auto` leaves a GPU alone that the processor plays.
    let takes_software = options.backend == Backend::Gpu;
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    let device = match &options.device {
        Some(given) => Device::adopted(given, takes_software, form).await?,
        None => Device::shared(takes_software, form).await?,
    };
    #[cfg(not(all(target_arch = "wasm32", feature = "js")))]
    let device = Device::shared(takes_software, form).await?;
    let make = |upload: Upload| -> Answer<'static, Box<dyn Engine>> {
        let device = device.clone();
        Box::pin(async move { Ok(Box::new(WebGpu::new(device, upload).await?) as Box<dyn Engine>) })
    };
    self_test(&device.tested, "gpu", upload.form(), &make).await?;
    make(upload).await
}

#[cfg(not(feature = "gpu"))]
async fn gpu(
    _mesh: &Arc<Mesh>,
    _options: &Options,
    _thresholds: Thresholds,
) -> Result<Box<dyn Engine>, Error> {
    let message = "this build has no GPU engine (feature `gpu`)".to_owned();
    Err(Error::BackendUnavailable { backend: "gpu", message })
}

#[cfg(all(target_arch = "wasm32", feature = "js"))]
async fn webgl(
    mesh: &Arc<Mesh>,
    options: &Options,
    thresholds: Thresholds,
) -> Result<Box<dyn Engine>, Error> {
    Ok(Box::new(Proxy::new(mesh, thresholds, options.backend == Backend::WebGl).await?))
}

#[cfg(not(all(target_arch = "wasm32", feature = "js")))]
async fn webgl(
    _mesh: &Arc<Mesh>,
    _options: &Options,
    _thresholds: Thresholds,
) -> Result<Box<dyn Engine>, Error> {
    let message = "WebGL2 is there in browsers only, through the npm package".to_owned();
    Err(Error::BackendUnavailable { backend: "webgl2", message })
}
