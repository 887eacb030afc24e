//! Pipelines compiled at the same time in a browser. wgpu creates one after the other, and a browser that creates one without
//! a promise compiles it at once, while nothing else happens. Those that have come by a promise it knows: wgpu is given the
//! same ones.

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

/// The pipelines of plans, which the browser forgets when they go. What is wrong with them, it will say again.
pub(super) async fn compiled(plans: &[Plan], device: &wgpu::Device) -> Option<JsValue> {
    let device = GpuDevice::of(device)?;
    device.push_error_scopes();
    let promises: Result<Vec<_>, _> = plans.iter().map(|plan| promises(plan, &device)).collect();
    // Errors are told when wgpu does the same.
    drop(device.pop_error_scopes());
    let all: Array = promises.ok()?.into_iter().flatten().collect();
    JsFuture::from(Promise::all_settled(&all)).await.ok()
}

fn promises(plan: &Plan, device: &GpuDevice) -> Result<Vec<Promise>, JsValue> {
    let places = plan.bindings.iter().zip(0u32..).map(|(ty, binding)| layout_entry(*ty, binding));
    let layout = device.bind_group_layout(&object(&[("entries", list(places))]))?;
    let layout = device.pipeline_layout(&object(&[("bindGroupLayouts", list([layout]))]))?;
    let module = |source: &String| device.shader_module(&object(&[("code", source.into())]));
    let modules = plan.sources.iter().map(module).collect::<Result<Vec<_>, _>>()?;
    let promise = |(place, name, constant): &Entry| {
        let constants = constant.map(|(name, value)| (name, JsValue::from(value)));
        let stage = object(&[
            ("module", modules[*place].clone()),
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

fn object(fields: &[(&str, JsValue)]) -> JsValue {
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
