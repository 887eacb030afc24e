//! Which engine a session runs on.

use crate::engine::{Cpu, Engine, Lawson};
#[cfg(feature = "gpu")]
use crate::engine::{Device, WebGpu};
use crate::predicates::cos_degrees;
use crate::{Backend, Error, Mesh, Options, Order};
use std::sync::Arc;

/// The engine for the options, and why `Auto` did not take the GPU.
pub(super) async fn engine_for(
    mesh: &Arc<Mesh>,
    options: &Options,
) -> Result<(Box<dyn Engine>, Option<String>), Error> {
    let cos = cos_degrees(options.max_normal_angle);
    let cpu = || Cpu::new(mesh.clone(), cos);
    match (options.order, options.backend) {
        (Order::Any, Backend::Gpu) => {
            let message = "`any` is sequential and runs on the cpu only".to_owned();
            Err(Error::Option { option: "order", message })
        }
        (Order::Any, _) => Ok((Box::new(Lawson::new(cpu())), None)),
        (Order::Reproducible, Backend::Cpu) => Ok((Box::new(cpu()), None)),
        (Order::Reproducible, Backend::Gpu) => Ok((gpu(mesh, options, cos).await?, None)),
        (Order::Reproducible, Backend::Auto) => match gpu(mesh, options, cos).await {
            Ok(engine) => Ok((engine, None)),
            Err(error) => Ok((Box::new(cpu()), Some(error.to_string()))),
        },
    }
}

#[cfg(feature = "gpu")]
async fn gpu(mesh: &Arc<Mesh>, options: &Options, cos: f64) -> Result<Box<dyn Engine>, Error> {
    // `Auto` leaves a GPU alone that the processor plays.
    let takes_software = options.backend == Backend::Gpu;
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    if let Some(given) = &options.device {
        let device = Device::adopted(given, takes_software).await?;
        return Ok(Box::new(WebGpu::new(device, mesh, cos).await?));
    }
    Ok(Box::new(WebGpu::new(Device::shared(takes_software).await?, mesh, cos).await?))
}

#[cfg(not(feature = "gpu"))]
async fn gpu(_mesh: &Arc<Mesh>, _options: &Options, _cos: f64) -> Result<Box<dyn Engine>, Error> {
    let message = "this build has no GPU engine (feature `gpu`)".to_owned();
    Err(Error::BackendUnavailable { backend: "gpu", message })
}
