//! Compiles pipelines in parallel in a browser. wgpu creates pipelines one after another with the synchronous call,
//! which blocks. This file first creates the same pipelines with the asynchronous call; the browser then has them in
//! its cache when wgpu asks for them.

use super::browser::GpuDevice;
use super::kernels::{Entry, Plan};
use js_sys::{Array, Object, Promise, Reflect};
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::JsFuture;
use wgpu::{BindingType, BufferBindingType};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(method, catch, js_name = createBindGroupLayout)]
    fn bind_group_layout(this: &GpuDevice, descriptor: &JsValue) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch, js_name = createPipelineLayout)]
    fn pipeline_layout(this: &GpuDevice, descriptor: &JsValue) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch, js_name = createShaderModule)]
    fn shader_module(this: &GpuDevice, descriptor: &JsValue) -> Result<JsValue, JsValue>;
    #[wasm_bindgen(method, catch, js_name = createComputePipelineAsync)]
    fn pipeline(this: &GpuDevice, descriptor: &JsValue) -> Result<Promise, JsValue>;
}

/// The pipelines of `plans`. The browser's cache keeps them as long as the result lives. Errors in them are ignored
/// here: wgpu gets the same errors.
pub(super) async fn compiled(plans: &[Plan], device: &wgpu::Device) -> Option<JsValue> {
    let device = GpuDevice::of(device)?;
    device.push_error_scopes();
    let promises: Result<Vec<_>, _> = plans.iter().map(|plan| promises(plan, &device)).collect();
    // wgpu gets the same errors.
    drop(device.pop_error_scopes());
    let all: Array = promises.ok()?.into_iter().flatten().collect();
    JsFuture::from(Promise::all_settled(&all)).await.ok()
}

fn promises(plan: &Plan, device: &GpuDevice) -> Result<Vec<Promise>, JsValue> {
    let entries = plan.bindings.iter().zip(0u32..).map(|(ty, binding)| layout_entry(*ty, binding));
    let layout = device.bind_group_layout(&object(&[("entries", list(entries))]))?;
    let layout = device.pipeline_layout(&object(&[("bindGroupLayouts", list([layout]))]))?;
    let module = |source: &String| device.shader_module(&object(&[("code", source.into())]));
    let modules = plan.sources.iter().map(module).collect::<Result<Vec<_>, _>>()?;
    let promise = |(source, name, constant): &Entry| {
        let constants = constant.map(|(name, value)| (name, JsValue::from(value)));
        let stage = object(&[
            ("module", modules[*source].clone()),
            ("entryPoint", (*name).into()),
            ("constants", object(constants.as_slice())),
        ]);
        let descriptor = object(&[("layout", layout.clone()), ("compute", stage)]);
        device.pipeline(&descriptor).unwrap_or_else(|error| Promise::reject(&error))
    };
    Ok(plan.entries.iter().map(promise).collect())
}

fn layout_entry(ty: BindingType, binding: u32) -> JsValue {
    let BindingType::Buffer { ty, has_dynamic_offset, .. } = ty else { return JsValue::UNDEFINED };
    let name = match ty {
        BufferBindingType::Uniform => "uniform",
        BufferBindingType::Storage { read_only: true } => "read-only-storage",
        BufferBindingType::Storage { read_only: false } => "storage",
    };
    let buffer = object(&[("type", name.into()), ("hasDynamicOffset", has_dynamic_offset.into())]);
    let visibility = wgpu::ShaderStages::COMPUTE.bits();
    object(&[("binding", binding.into()), ("visibility", visibility.into()), ("buffer", buffer)])
}

/// A plain object.
pub(super) fn object(fields: &[(&str, JsValue)]) -> JsValue {
    let object = Object::new();
    for (name, value) in fields {
        // Setting a field of a new object does not fail.
        let _ = Reflect::set(&object, &(*name).into(), value);
    }
    object.into()
}

fn list(items: impl IntoIterator<Item = JsValue>) -> JsValue {
    items.into_iter().collect::<Array>().into()
}
