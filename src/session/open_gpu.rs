//! The GPU as sessions see it: whether it is ready, and an engine on it.

use super::cost::Job;
use crate::engine::{Answer, Device, DeviceHandle, Engine, Form, GivenDevice, Upload, WebGpu, self_test};
use crate::phases::Thresholds;
use crate::{Backend, Dimension, EngineKind, Error, Mesh, Options};
use std::sync::Arc;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use {
    crate::Order,
    crate::system::{in_turn::in_turn, threads::Threads},
    js_sys::{Float32Array, Promise, Uint32Array},
    std::cell::RefCell,
    wasm_bindgen::{JsCast, JsValue},
};

/// The form of a mesh: the set of shaders that it needs. At upload, a mesh of 32-bit floats that span too many bits
/// gets the fixed-point form instead.
fn form_of(dimension: Dimension, is_double: bool, options: &Options) -> Form {
    Form::new(dimension, is_double, options.max_deviation)
}

/// Whether a job can start on the GPU at once.
pub(super) fn is_ready(job: Job, is_double: bool, options: &Options) -> bool {
    let form = form_of(job.dimension, is_double, options);
    let takes_software = options.backend == Backend::Gpu;
    Device::known(options.given_device()).is_some_and(|device| device.is_ready(form, takes_software))
}

/// Sends the arrays of a mesh to the GPU, if its session begins there at once. They are not checked yet. Returns the
/// device; whoever makes the session drops what the session has not taken.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(crate) fn send(
    dimension: Dimension,
    indices: &Uint32Array,
    positions: &JsValue,
    options: &Options,
) -> Option<DeviceHandle> {
    let floats = positions.dyn_ref::<Float32Array>();
    let form = form_of(dimension, floats.is_none(), options);
    let takes_software = options.backend == Backend::Gpu;
    let ready = |device: &DeviceHandle| device.is_ready(form, takes_software);
    let device = Device::known(options.given_device()).filter(ready)?;
    let triangles = indices.length() as usize / 3;
    let threads = Threads::count_for(options.threads, triangles);
    let is_for_gpu = match (options.order, options.backend) {
        (Order::Reproducible, Backend::Auto) => {
            options.leaves_cpu || Job { triangles, dimension, threads }.is_for_gpu()
        }
        (Order::Reproducible, Backend::Gpu) => true,
        _ => false,
    };
    if !is_for_gpu {
        return None;
    }
    let words = |floats: &Float32Array| {
        Uint32Array::new_with_byte_offset_and_length(&floats.buffer(), floats.byte_offset(), floats.length())
    };
    device.send(indices, floats.map(words).as_ref());
    Some(device)
}

/// Why a job that suits a GPU does not wait until one is ready. A browser prepares the GPU meanwhile.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(super) fn why_not_ready(job: Job, is_double: bool, options: &Options) -> String {
    let form = form_of(job.dimension, is_double, options);
    let (given, is_given) = (options.device.clone(), options.device.is_some());
    let ahead = Device::ahead(is_given, async move { tested(given.as_ref(), false, form).await.map(drop) });
    ahead.map_or_else(super::fallback::without_gpu, |()| {
        "the gpu was not ready; it starts up during this run".to_owned()
    })
}

/// Natively nothing prepares the GPU: the process may end at any time, and drivers do not expect that while they
/// compile.
#[cfg(not(all(target_arch = "wasm32", feature = "js")))]
pub(super) fn why_not_ready(job: Job, _: bool, _: &Options) -> String {
    format!("the cpu finishes {} triangles before the gpu is ready", job.triangles)
}

/// An engine on the GPU, which has passed the self-test.
///
/// # Errors
/// [`Error::BackendUnavailable`], [`Error::BackendLimit`], [`Error::Device`].
pub(super) async fn engine(
    mesh: &Arc<Mesh>,
    options: &Options,
    thresholds: Thresholds,
) -> Result<Box<dyn Engine>, Error> {
    // `Auto` never takes a software GPU.
    let takes_software = options.backend == Backend::Gpu;
    let form = form_of(mesh.dimension(), mesh.positions().is_double(), options);
    let mut device = tested(options.given_device(), takes_software, form).await?;
    let mut upload = Upload::new(EngineKind::Gpu, mesh.clone(), thresholds)?;
    upload.gives_adjacency = options.adjacency;
    if upload.form() != form {
        device = tested(options.given_device(), takes_software, upload.form()).await?;
    }
    Ok(Box::new(WebGpu::new(device, upload).await?))
}

/// The device, after the self-test for a form.
#[cfg(not(all(target_arch = "wasm32", feature = "js")))]
async fn tested(
    given: Option<&GivenDevice>,
    takes_software: bool,
    form: Form,
) -> Result<DeviceHandle, Error> {
    prepared(given, takes_software, form).await
}

/// The device, after the self-test for a form. Sessions of a page often begin at the same time: one opens the device
/// and compiles the kernels, and the others wait for it.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
async fn tested(
    given: Option<&GivenDevice>,
    takes_software: bool,
    form: Form,
) -> Result<DeviceHandle, Error> {
    thread_local! {
        static RUNNING: RefCell<Option<Promise>> = const { RefCell::new(None) };
    }
    let is_ready = || Device::known(given).is_some_and(|device| device.is_ready(form, takes_software));
    let given = given.cloned();
    in_turn(&RUNNING, is_ready, async move { prepared(given.as_ref(), takes_software, form).await }).await
}

/// Opens the device and compiles the kernels for a form, unless that was done, and runs the self-test.
async fn prepared(
    given: Option<&GivenDevice>,
    takes_software: bool,
    form: Form,
) -> Result<DeviceHandle, Error> {
    let device = Device::for_session(given, takes_software, form).await?;
    test(&device, form).await?;
    Ok(device)
}

/// Runs the self-test, unless the device has passed it for this form.
async fn test(device: &DeviceHandle, form: Form) -> Result<(), Error> {
    let make = |upload: Upload| -> Answer<'static, Box<dyn Engine>> {
        let device = device.clone();
        Box::pin(async move { Ok(Box::new(WebGpu::new(device, upload).await?) as Box<dyn Engine>) })
    };
    self_test(&device.tested, EngineKind::Gpu, form, &make).await
}
