//! One device for all sessions, or one that the page has made.

#[cfg(all(target_arch = "wasm32", feature = "js"))]
use super::browser::GpuDevice;
use super::device::Device;
use super::faults::unavailable;
use crate::Error;
use crate::engine::upload::Form;
use std::sync::Mutex;

/// The devices that sessions share.
struct Shared {
    /// The one that was opened here.
    opened: Option<Handle>,
    /// Whether the adapter that was found last is software: the processor plays the GPU.
    is_software: bool,
    /// Those of the page: in use, and the last one also when it is idle, for the sake of its kernels.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    adopted: Vec<Handle>,
}

impl Shared {
    const fn new() -> Self {
        Self {
            opened: None,
            is_software: false,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            adopted: Vec::new(),
        }
    }

    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    fn let_idle_go(&mut self) {
        self.adopted.retain(|device| Handle::strong_count(device) > 1);
    }
}

/// Sessions share a device, and on a computer threads do.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) type Handle = std::sync::Arc<Device>;

#[cfg(not(target_arch = "wasm32"))]
static SHARED: Mutex<Shared> = Mutex::new(Shared::new());

/// In a browser a device belongs to its thread.
#[cfg(target_arch = "wasm32")]
pub(crate) type Handle = std::rc::Rc<Device>;

#[cfg(target_arch = "wasm32")]
thread_local! {
    static SHARED: Mutex<Shared> = const { Mutex::new(Shared::new()) };
}

fn with_shared<T>(f: impl FnOnce(&mut Shared) -> T) -> T {
    let locked =
        |shared: &Mutex<Shared>| f(&mut shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner()));
    #[cfg(not(target_arch = "wasm32"))]
    return locked(&SHARED);
    #[cfg(target_arch = "wasm32")]
    return SHARED.with(locked);
}

fn refuse_software(is_software: bool, takes_software: bool) -> Result<(), Error> {
    if is_software && !takes_software {
        return Err(unavailable("the adapter is software, slower than the cpu engine".to_owned()));
    }
    Ok(())
}

/// For the time after the loss of a device: without it, its memory would wait for the next session.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(super) fn let_idle_go() {
    with_shared(Shared::let_idle_go);
}

impl Device {
    /// The shared device; opened at the first call, and again after a failure, with the kernels for meshes of a form.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] where there is none, or a software one that is not taken, or its compiler
    /// refuses the kernels; [`Error::Device`] where it fails at once.
    pub(crate) async fn shared(takes_software: bool, form: Option<Form>) -> Result<Handle, Error> {
        let (opened, is_software) = with_shared(|shared| (shared.opened.clone(), shared.is_software));
        // Known from the last time: no adapter has to be found to refuse it.
        refuse_software(is_software, takes_software)?;
        if let Some(device) = opened.filter(|device| device.check().is_ok()) {
            return Ok(device);
        }
        let (adapter, is_software) = Self::find_adapter().await?;
        with_shared(|shared| shared.is_software = is_software);
        refuse_software(is_software, takes_software)?;
        let device = Handle::new(Self::open(adapter, is_software, form).await?);
        with_shared(|shared| shared.opened = Some(device.clone()));
        Ok(device)
    }

    /// Takes the shared device from the sessions to come; it is closed with the last that has it.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn taken() -> Option<Handle> {
        with_shared(|shared| shared.opened.take())
    }

    /// The device that the page has made. It is never destroyed here, and nothing of it is set.
    ///
    /// # Errors
    /// [`Error::Device`] if it is lost; else as [`Device::shared`].
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub(crate) async fn adopted(
        given: &GpuDevice,
        takes_software: bool,
        form: Option<Form>,
    ) -> Result<Handle, Error> {
        if let Some(why) = given.loss().await {
            return Err(Error::Device { message: format!("the device given is lost: {why}") });
        }
        let is_software = given.is_software();
        refuse_software(is_software, takes_software)?;
        let known = with_shared(|shared| {
            let is_given = |device: &&Handle| GpuDevice::of(&device.device).as_ref() == Some(given);
            let mut devices = shared.adopted.iter().chain(&shared.opened);
            let known = devices.find(|device| is_given(device) && device.check().is_ok()).cloned();
            shared.let_idle_go();
            known
        });
        if let Some(device) = known {
            return Ok(device);
        }
        let (device, queue) = given.adopt().await.map_err(unavailable)?;
        let device =
            Handle::new(Self::compile(device, queue, given.adapter_name(), is_software, form).await?);
        with_shared(|shared| shared.adopted.push(device.clone()));
        Ok(device)
    }
}
