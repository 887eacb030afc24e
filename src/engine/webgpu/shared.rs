//! One device for all sessions, or one that the page has made.

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

/// A device of the page.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(crate) use super::browser::GpuDevice as GivenDevice;

/// Elsewhere nobody can give one.
#[cfg(not(all(target_arch = "wasm32", feature = "js")))]
pub(crate) type GivenDevice = std::convert::Infallible;

/// The devices that sessions share.
struct Shared {
    /// The one that was opened here.
    opened: Option<Handle>,
    /// Whether the adapter that was found last is software: the processor plays the GPU.
    is_software: bool,
    /// Whether one is made ready for sessions to come, and why the last one was not.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    is_preparing: bool,
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    refusal: Option<String>,
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
            is_preparing: false,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            refusal: None,
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

/// After the loss of a device. Without it, its memory would wait for the next session.
fn on_loss() {
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    with_shared(Shared::let_idle_go);
}

impl Device {
    /// The device for a session, with the kernels for meshes of a form: the one given, else the one that sessions share.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] where there is none, or a software one that is not taken, or its compiler
    /// refuses the kernels; [`Error::Device`] where it fails at once, or the one given is lost.
    pub(crate) async fn for_session(
        given: Option<&GivenDevice>,
        takes_software: bool,
        form: Form,
    ) -> Result<Handle, Error> {
        #[cfg(all(target_arch = "wasm32", feature = "js"))]
        if let Some(given) = given {
            return Self::adopted(given, takes_software, form).await;
        }
        #[cfg(not(all(target_arch = "wasm32", feature = "js")))]
        let _ = given;
        Self::shared(takes_software, Some(form)).await
    }

    /// The device for a session, if it is open and nothing has failed.
    pub(crate) fn known(given: Option<&GivenDevice>) -> Option<Handle> {
        #[cfg(all(target_arch = "wasm32", feature = "js"))]
        if let Some(given) = given {
            return with_shared(|shared| {
                let is_given = |device: &&Handle| GivenDevice::of(&device.device).as_ref() == Some(given);
                let mut devices = shared.adopted.iter().chain(&shared.opened).filter(is_given);
                devices.find(|device| device.check().is_ok()).cloned()
            });
        }
        #[cfg(not(all(target_arch = "wasm32", feature = "js")))]
        let _ = given;
        with_shared(|shared| shared.opened.clone()).filter(|device| device.check().is_ok())
    }

    /// The shared device; opened at the first call, and again after a failure, with the kernels for meshes of a form.
    ///
    /// # Errors
    /// As [`Device::for_session`].
    pub(crate) async fn shared(takes_software: bool, form: Option<Form>) -> Result<Handle, Error> {
        // Known from the last time: no adapter has to be found to refuse it.
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

    /// Has `prepare` make a device ready behind whatever else goes on, unless that goes on already: the shared one, or one that
    /// was given.
    ///
    /// # Errors
    /// Why there is none, or why the last one was not made ready; then it is tried again.
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
            // On its own, since an exception in `prepare` ends it where it is.
            let _ = promise(async move {
                let thrown = JsFuture::from(prepared).await.err();
                let refusal = thrown.map(|thrown| thrown.as_string().unwrap_or(format!("{thrown:?}")));
                with_shared(|shared| (shared.is_preparing, shared.refusal) = (false, refusal));
                Ok(JsValue::UNDEFINED)
            });
        }
        with_shared(|shared| shared.refusal.clone()).map_or(Ok(()), Err)
    }

    /// Takes the shared device from the sessions to come; it is closed with the last that has it.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn taken() -> Option<Handle> {
        with_shared(|shared| shared.opened.take())
    }

    /// The device that the page has made. It is never destroyed here, and nothing of it is set.
    ///
    /// # Errors
    /// As [`Device::for_session`].
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    async fn adopted(given: &GivenDevice, takes_software: bool, form: Form) -> Result<Handle, Error> {
        if let Some(why) = given.loss().await {
            return Err(Error::Device { message: format!("the device given is lost: {why}") });
        }
        let is_software = given.is_software();
        refuse_software(is_software, takes_software)?;
        let known = Self::known(Some(given));
        with_shared(Shared::let_idle_go);
        if let Some(device) = known {
            return Ok(device);
        }
        let (device, queue) = given.adopt().await.map_err(unavailable)?;
        let device = Handle::new(
            Self::compile(device, queue, given.adapter_name(), is_software, Some(form), on_loss).await?,
        );
        with_shared(|shared| shared.adopted.push(device.clone()));
        Ok(device)
    }
}

#[cfg(test)]
impl Device {
    /// One that nobody else has.
    pub(crate) async fn own() -> Result<Handle, Error> {
        let (adapter, is_software) = Self::find_adapter().await?;
        Ok(Handle::new(Self::open(adapter, is_software, None, on_loss).await?))
    }
}
