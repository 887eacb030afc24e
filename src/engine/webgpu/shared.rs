//! The device that sessions share, and devices that the page has made.

use super::device::Device;
use super::faults::unavailable;
use crate::Error;
use crate::engine::gpu::upload::Form;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use crate::system::promise::promise;
use std::sync::Mutex;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use wasm_bindgen::JsValue;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use wasm_bindgen_futures::JsFuture;

/// A device that the page or the program has made.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(crate) use super::browser::GpuDevice as GivenDevice;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use super::own_device::GpuDevice as GivenDevice;

/// Without the JavaScript interface nobody can give a device in a browser.
#[cfg(all(target_arch = "wasm32", not(feature = "js")))]
pub(crate) type GivenDevice = std::convert::Infallible;

/// The devices that sessions share.
struct Shared {
    /// The device that this code has opened.
    opened: Option<Handle>,
    /// Whether the adapter found last is a software GPU.
    is_software: bool,
    /// Whether a device is being prepared for later sessions.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    is_preparing: bool,
    /// Why the last preparation failed.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    refusal: Option<String>,
    /// Devices of the caller: those in use, and the last one also when it is idle, to keep its kernels.
    #[cfg(any(not(target_arch = "wasm32"), feature = "js"))]
    adopted: Vec<Handle>,
}

impl Shared {
    const fn new() -> Self {
        Self {
            opened: None,
            is_software: false,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            is_preparing: false,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            refusal: None,
            #[cfg(any(not(target_arch = "wasm32"), feature = "js"))]
            adopted: Vec::new(),
        }
    }

    #[cfg(any(not(target_arch = "wasm32"), feature = "js"))]
    fn drop_idle(&mut self) {
        self.adopted.retain(|device| Handle::strong_count(device) > 1);
    }
}

/// A shared device. Natively, threads share it too.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) type Handle = std::sync::Arc<Device>;

#[cfg(not(target_arch = "wasm32"))]
static SHARED: Mutex<Shared> = Mutex::new(Shared::new());

/// A shared device. In a browser it belongs to one thread.
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

/// Whether the caller has given this device.
#[cfg(not(target_arch = "wasm32"))]
fn is_of(given: &GivenDevice, device: &Device) -> bool {
    device.given.as_ref() == Some(given)
}

/// Whether the page has made this device, or has it from a session.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
fn is_of(given: &GivenDevice, device: &Device) -> bool {
    given.is_of(&device.device)
}

/// Called when a device is lost: frees its memory now, not at the next session.
fn on_loss() {
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    with_shared(Shared::drop_idle);
}

impl Device {
    /// The device for a session, with the kernels for meshes of a form: the given device, or else the shared one.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] if there is no device, or only a software GPU without `takes_software`, or if its
    /// compiler refuses the kernels; [`Error::Device`] if it fails at once, or if the given device is lost.
    pub(crate) async fn for_session(
        given: Option<&GivenDevice>,
        takes_software: bool,
        form: Form,
    ) -> Result<Handle, Error> {
        #[cfg(any(not(target_arch = "wasm32"), feature = "js"))]
        if let Some(given) = given {
            return Self::adopted(given, takes_software, form).await;
        }
        #[cfg(not(any(not(target_arch = "wasm32"), feature = "js")))]
        let _ = given;
        Self::shared(takes_software, Some(form)).await
    }

    /// The device for a session, if it is open and has not failed.
    pub(crate) fn known(given: Option<&GivenDevice>) -> Option<Handle> {
        #[cfg(any(not(target_arch = "wasm32"), feature = "js"))]
        if let Some(given) = given {
            return with_shared(|shared| {
                let is_given = |device: &&Handle| is_of(given, device);
                let mut devices = shared.adopted.iter().chain(&shared.opened).filter(is_given);
                devices.find(|device| device.check().is_ok()).cloned()
            });
        }
        #[cfg(not(any(not(target_arch = "wasm32"), feature = "js")))]
        let _ = given;
        with_shared(|shared| shared.opened.clone()).filter(|device| device.check().is_ok())
    }

    /// The shared device, with the kernels for meshes of a form. Opened at the first call, and again after a failure.
    ///
    /// # Errors
    /// As [`Device::for_session`].
    pub(crate) async fn shared(takes_software: bool, form: Option<Form>) -> Result<Handle, Error> {
        // Known from the last call, so a software GPU is refused without another search.
        refuse_software(with_shared(|shared| shared.is_software), takes_software)?;
        if let Some(device) = Self::known(None) {
            return Ok(device);
        }
        let (adapter, is_software) = Self::find_adapter().await?;
        with_shared(|shared| shared.is_software = is_software);
        refuse_software(is_software, takes_software)?;
        let device = Handle::new(Self::open(adapter, is_software, form, on_loss).await?);
        with_shared(|shared| shared.opened = Some(device.clone()));
        Ok(device)
    }

    /// Starts `prepare` in the background, unless a preparation is running. It prepares the shared device or, with
    /// `is_given`, a device of the page.
    ///
    /// # Errors
    /// Why there is no device, or why the last preparation failed; this call then tries again.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub(crate) fn ahead(
        is_given: bool,
        prepare: impl Future<Output = Result<(), Error>> + 'static,
    ) -> Result<(), String> {
        let is_software = !is_given && with_shared(|shared| shared.is_software);
        Self::look_for_webgpu()
            .and_then(|()| refuse_software(is_software, false))
            .map_err(|error| error.to_string())?;
        if !with_shared(|shared| std::mem::replace(&mut shared.is_preparing, true)) {
            let prepared = promise(async {
                prepare.await.map(|()| JsValue::UNDEFINED).map_err(|error| error.to_string().into())
            });
            // A promise of its own, because an exception in `prepare` would also end this code.
            let _ = promise(async move {
                let thrown = JsFuture::from(prepared).await.err();
                let refusal = thrown.map(|thrown| thrown.as_string().unwrap_or(format!("{thrown:?}")));
                with_shared(|shared| (shared.is_preparing, shared.refusal) = (false, refusal));
                Ok(JsValue::UNDEFINED)
            });
        }
        with_shared(|shared| shared.refusal.clone()).map_or(Ok(()), Err)
    }

    /// Takes the shared device, and devices of the caller that no session holds, away from later sessions. A device
    /// closes when its last handle goes.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn taken() -> Vec<Handle> {
        with_shared(|shared| {
            let idle = shared.adopted.extract_if(.., |device| Handle::strong_count(device) == 1);
            idle.chain(shared.opened.take()).collect()
        })
    }

    /// The device that the caller has made. This code never destroys it and changes none of its settings.
    ///
    /// # Errors
    /// As [`Device::for_session`].
    #[cfg(any(not(target_arch = "wasm32"), feature = "js"))]
    async fn adopted(given: &GivenDevice, takes_software: bool, form: Form) -> Result<Handle, Error> {
        if let Some(why) = given.loss().await {
            return Err(Error::Device { message: format!("the device given is lost: {why}") });
        }
        let is_software = given.is_software();
        refuse_software(is_software, takes_software)?;
        let known = Self::known(Some(given));
        with_shared(Shared::drop_idle);
        if let Some(device) = known {
            return Ok(device);
        }
        let (device, queue) = given.adopt().await.map_err(unavailable)?;
        // In a browser, the handler is that of a device of wgpu, which nobody else has.
        let on_loss = cfg!(target_arch = "wasm32").then_some(on_loss as fn());
        let compiling = Self::compile(device, queue, given.adapter_name(), is_software, Some(form), on_loss);
        let device = compiling.await?;
        #[cfg(not(target_arch = "wasm32"))]
        let device = device.of_caller(given);
        let device = Handle::new(device);
        with_shared(|shared| shared.adopted.push(device.clone()));
        Ok(device)
    }
}

#[cfg(test)]
impl Device {
    /// A device that is not shared.
    pub(crate) async fn own() -> Result<Handle, Error> {
        let (adapter, is_software) = Self::find_adapter().await?;
        Ok(Handle::new(Self::open(adapter, is_software, None, on_loss).await?))
    }
}
