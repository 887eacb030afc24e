//! Gives wgpu a device that the page has made.

use super::browser::{GpuDevice, HasMessage, navigator};
use js_sys::{Array, Object, Promise, Reflect};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::JsFuture;

impl GpuDevice {
    /// Whether it is a software GPU, as far as the browser tells.
    pub(super) fn is_software(&self) -> bool {
        self.adapter_info().and_then(|info| info.is_fallback_adapter()) == Some(true)
    }

    /// Why the device was lost, if it was.
    pub(super) async fn loss(&self) -> Option<String> {
        // If both promises are settled, the race takes the first.
        let entrants = Array::of2(&self.lost(), &Promise::resolve(&JsValue::NULL));
        let loss = JsFuture::from(Promise::race(&entrants)).await.ok()?;
        loss.is_object().then(|| loss.unchecked_into::<HasMessage>().message())
    }

    /// The device as a wgpu device. wgpu gets devices only from an adapter, and adapters only from `navigator.gpu`. So
    /// this call replaces `navigator.gpu`, while wgpu reads it, by an object whose adapter returns this device.
    pub(super) async fn adopt(&self) -> Result<(wgpu::Device, wgpu::Queue), String> {
        let device = self.clone();
        let request_device = Closure::<dyn Fn() -> Promise<Self>>::new(move || Promise::resolve(&device));
        let adapter = Object::new();
        let gpu = Object::new();
        let set = |object: &Object, name: &str, value: &JsValue| {
            // Setting a field of a new object does not fail.
            let _ = Reflect::set(object, &name.into(), value);
        };
        set(&adapter, "requestDevice", request_device.as_ref());
        let request_adapter = Closure::<dyn Fn() -> Promise<Object>>::new(move || Promise::resolve(&adapter));
        set(&gpu, "requestAdapter", request_adapter.as_ref());

        let navigator = navigator().ok_or("this is neither a window nor a worker")?;
        let own = Object::get_own_property_descriptor(&navigator, &"gpu".into());
        let stand_in = Object::new();
        set(&stand_in, "value", &gpu);
        set(&stand_in, "configurable", &true.into());
        if Reflect::define_property(&navigator, &"gpu".into(), &stand_in) != Ok(true) {
            return Err("the device cannot be handed to wgpu: navigator.gpu cannot be replaced".to_owned());
        }
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        // The property was made configurable above, so this succeeds.
        let _ = match own.dyn_into::<Object>() {
            Ok(own) => Reflect::define_property(&navigator, &"gpu".into(), &own),
            Err(_) => Reflect::delete_property(&navigator, &"gpu".into()),
        };
        let adapter = instance
            .request_adapter(&Default::default())
            .await
            .map_err(|_| "wgpu does not take the device")?;
        adapter.request_device(&Default::default()).await.map_err(|error| error.to_string())
    }
}
