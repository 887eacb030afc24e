//! A device that the page has made, as wgpu has it.

use super::browser::{GpuDevice, Told, navigator};
use js_sys::{Array, Object, Promise, Reflect};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::JsFuture;

impl GpuDevice {
    /// Whether the browser says that the processor plays the GPU.
    pub(super) fn is_software(&self) -> bool {
        self.adapter_info().and_then(|info| info.is_fallback_adapter()) == Some(true)
    }

    /// Why the device was lost, if it was.
    pub(super) async fn loss(&self) -> Option<String> {
        // Of promises that are settled, the first wins.
        let entrants = Array::of2(&self.lost(), &Promise::resolve(&JsValue::NULL));
        let loss = JsFuture::from(Promise::race(&entrants)).await.ok()?;
        loss.is_object().then(|| loss.unchecked_into::<Told>().message())
    }

    /// The device as wgpu has it. wgpu takes a device from an adapter, and an adapter from `navigator.gpu`, so
    /// for the one call that reads it something else stands there, whose adapter hands this device out.
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
            return Err("wgpu cannot be given a device: navigator.gpu cannot be replaced".to_owned());
        }
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        // What was just made configurable can be removed or put back.
        let _ = match own.dyn_into::<Object>() {
            Ok(own) => Reflect::define_property(&navigator, &"gpu".into(), &own),
            Err(_) => Reflect::delete_property(&navigator, &"gpu".into()),
        };
        let adapter =
            instance.request_adapter(&Default::default()).await.map_err(|error| error.to_string())?;
        adapter.request_device(&Default::default()).await.map_err(|error| error.to_string())
    }
}
