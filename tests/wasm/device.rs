//! Sessions on a device that the page, or the worker, has made.

use edgeflip::js::{JsOptions, JsPositions, JsSession};
use edgeflip::{Backend, Mesh, Options, Session, families::by_name};
use js_sys::{Float32Array, Object, Reflect, Uint32Array};
use wasm_bindgen::convert::TryFromJsValue;
use wasm_bindgen::prelude::*;
use wasm_bindgen_test::wasm_bindgen_test;

#[wasm_bindgen(inline_js = r#"
// Opens a device with default limits. It counts its shader modules, and keeps the messages of uncaptured errors.
export async function open() {
  const device = await (await navigator.gpu.requestAdapter()).requestDevice();
  Object.assign(device, { shaders: 0, seen: [], made: 0 });
  device.handler = (event) => { event.preventDefault(); device.seen.push(event.error.message); };
  device.onuncapturederror = device.handler;
  device.createShaderModule = (descriptor) => {
    device.shaders++;
    return GPUDevice.prototype.createShaderModule.call(device, descriptor);
  };
  return device;
}
// Makes errors of the page's own: one now, and one in every later task until `stop`.
export function err(device) {
  const make = () => { device.made++; device.createBuffer({ size: 4, usage: 0 }); };
  make();
  device.timer = setInterval(make, 0);
}
export async function stop(device) {
  clearInterval(device.timer);
  await device.queue.onSubmittedWorkDone();
  return device.seen.length === device.made && device.onuncapturederror === device.handler;
}
export const shaders = (device) => device.shaders;
// Waits until all modules are made, those of the tail last. The modules of the other kernels count twice: once when
// they are compiled ahead, and once when wgpu makes them.
export async function allShaders(device) {
  while (device.shaders < 12) await new Promise((resolve) => setTimeout(resolve, 10));
  return device.shaders;
}
export const seen = (device) => device.seen.length;
// With `spoiled`, later buffers lack the usage that a binding needs. Without it, they have that usage again.
export function spoilBuffers(device, spoiled) {
  delete device.createBuffer;
  if (spoiled) device.createBuffer = (descriptor) =>
    GPUDevice.prototype.createBuffer.call(device, { ...descriptor, usage: descriptor.usage & ~GPUBufferUsage.STORAGE });
}
// The content of a buffer, copied by commands of the page.
export async function words(device, buffer) {
  const staging = device.createBuffer({ size: buffer.size, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(buffer, 0, staging, 0, buffer.size);
  device.queue.submit([encoder.finish()]);
  await staging.mapAsync(GPUMapMode.READ);
  return new Uint32Array(staging.getMappedRange().slice());
}
export function destroy(device) { device.destroy(); }
// Makes the device look like hardware, so that `auto` accepts it.
export function passForHardware(device) {
  const info = { vendor: 'none', architecture: '', description: '', isFallbackAdapter: false };
  Object.defineProperty(device, 'adapterInfo', { value: info });
}
export const navigatorIsItself = () => !Object.hasOwn(navigator, 'gpu') && navigator.gpu instanceof GPU;
// How many devices were requested since the first call.
let asked;
export function devicesAskedFor() {
  if (asked === undefined) {
    asked = 0;
    const { requestDevice } = GPUAdapter.prototype;
    GPUAdapter.prototype.requestDevice = function (...args) { asked++; return requestDevice.apply(this, args); };
  }
  return asked;
}
"#)]
extern "C" {
    async fn open() -> JsValue;
    fn err(device: &JsValue);
    async fn stop(device: &JsValue) -> JsValue;
    fn shaders(device: &JsValue) -> u32;
    fn seen(device: &JsValue) -> u32;
    #[wasm_bindgen(js_name = allShaders)]
    async fn all_shaders(device: &JsValue) -> JsValue;
    #[wasm_bindgen(js_name = spoilBuffers)]
    fn spoil_buffers(device: &JsValue, spoiled: bool);
    async fn words(device: &JsValue, buffer: &JsValue) -> JsValue;
    fn destroy(device: &JsValue);
    #[wasm_bindgen(js_name = passForHardware)]
    fn pass_for_hardware(device: &JsValue);
    #[wasm_bindgen(js_name = navigatorIsItself)]
    fn navigator_is_itself() -> bool;
    #[wasm_bindgen(js_name = devicesAskedFor)]
    pub fn devices_asked_for() -> u32;
}

pub fn options_object(fields: &[(&str, JsValue)]) -> JsOptions {
    let object = Object::new();
    for (name, value) in fields {
        Reflect::set(&object, &(*name).into(), value).unwrap();
    }
    object.unchecked_into()
}

pub fn positions_array(mesh: &Mesh) -> JsPositions {
    Float32Array::from(mesh.positions().to_f32().as_slice()).unchecked_into()
}

pub fn code_of(error: &JsValue) -> String {
    Reflect::get(error, &"code".into()).unwrap().as_string().unwrap()
}

/// An object that a session shares, by its name in `SessionBuffers`.
pub fn shared(session: &JsSession, name: &str) -> JsValue {
    Reflect::get(&session.gpu(), &name.into()).unwrap()
}

pub fn class_of(value: &JsValue) -> String {
    Object::from(value.clone()).constructor().name().into()
}

/// Opens a session as the npm package does.
pub async fn session_of(mesh: &Mesh, options: &[(&str, JsValue)]) -> Result<JsSession, JsValue> {
    let (positions, indices) = (positions_array(mesh), Uint32Array::from(mesh.triangles()));
    let dimension = mesh.dimension().stride() as u32;
    let session = JsSession::create(positions, &indices, dimension, options_object(options), false)?.await?;
    JsSession::try_from_js_value(session)
}

async fn create(mesh: &Mesh, backend: &str, device: &JsValue) -> Result<JsSession, JsValue> {
    session_of(mesh, &[("backend", backend.into()), ("device", device.clone())]).await
}

async fn triangles_of(session: &JsSession) -> Vec<u32> {
    Uint32Array::from(session.triangles().await.unwrap()).to_vec()
}

/// The result of the CPU for the mesh.
async fn expected(mesh: &Mesh) -> Vec<u32> {
    let options = Options { backend: Backend::Cpu, ..Options::default() };
    let mut session = Session::new(mesh.clone(), options).await.unwrap();
    while session.advance().await.unwrap() {}
    session.triangles().await.unwrap()
}

#[wasm_bindgen_test]
async fn a_session_runs_on_the_device_of_the_page() {
    let mesh = by_name("random 10").unwrap();
    let device = open().await;
    err(&device);
    let session = create(&mesh, "webgpu", &device).await.unwrap();
    assert!(navigator_is_itself());
    assert_eq!((session.backend().as_str(), shared(&session, "device")), ("webgpu", device.clone()));
    while session.step().await.unwrap().is_truthy() {}
    let triangles = expected(&mesh).await;
    assert_eq!(triangles_of(&session).await, triangles);
    let buffer = shared(&session, "indices");
    assert_eq!(Uint32Array::from(words(&device, &buffer).await).to_vec(), triangles);

    // The vertices move, the buffers stay.
    let positions: Vec<f32> =
        mesh.positions().to_f32().iter().zip(0..).map(|(x, i)| x * (1 + i % 2 * 7) as f32).collect();
    let moved = Mesh::new(mesh.dimension(), positions, triangles).unwrap();
    session.set_positions(positions_array(&moved)).await.unwrap();
    while session.advance().await.unwrap().is_truthy() {}
    assert_eq!(triangles_of(&session).await, expected(&moved).await);
    assert_eq!(shared(&session, "indices"), buffer);
    let (in_order, alone) = (session.iterations() > 0, stop(&device).await);
    assert!(in_order && alone.is_truthy(), "each error of the page has reached the page, and nothing else");

    // Another session finds the kernels compiled, even after the first session is freed.
    assert_eq!(all_shaders(&device).await, 12);
    drop(session);
    let session = create(&mesh, "webgpu", &device).await.unwrap();
    assert_eq!(shaders(&device), 12);
    let copy = words(&device, &shared(&session, "indices")).await;
    assert_eq!(Uint32Array::from(copy).to_vec(), mesh.triangles());

    // The page does not see errors of our own calls.
    let before = seen(&device);
    spoil_buffers(&device, true);
    let spoiled = create(&mesh, "webgpu", &device).await.unwrap();
    assert_eq!(code_of(&spoiled.step().await.unwrap_err()), "device-failed");
    spoil_buffers(&device, false);
    assert_eq!(seen(&device), before);
    assert_eq!(code_of(&session.step().await.unwrap_err()), "device-failed");
    let session = create(&mesh, "webgpu", &device).await.unwrap();
    assert!(session.step().await.unwrap().is_truthy());

    // A lost device is an error, during a run and before one.
    destroy(&device);
    for error in [session.step().await.err(), create(&mesh, "webgpu", &device).await.err()] {
        assert_eq!(code_of(&error.unwrap()), "device-failed");
    }
}

#[wasm_bindgen_test]
async fn auto_leaves_a_device_that_is_software_or_lost() {
    let mesh = by_name("random 150").unwrap();
    let device = open().await;
    let session = create(&mesh, "auto", &device).await.unwrap();
    // `webdriver.json` has Chromium take SwiftShader.
    assert_eq!((session.backend().as_str(), shaders(&device)), ("cpu", 0));
    assert!(session.step().await.unwrap().is_truthy());

    pass_for_hardware(&device);
    // An explicit session prepares the device; `auto` never waits for that.
    drop(create(&mesh, "webgpu", &device).await.unwrap());
    let session = create(&mesh, "auto", &device).await.unwrap();
    assert_eq!(session.backend(), "webgpu");
    session.step().await.unwrap();
    let triangles = triangles_of(&session).await;
    let positions: Vec<f32> =
        mesh.positions().to_f32().iter().zip(0..).map(|(x, i)| x * (1 + i % 2 * 7) as f32).collect();
    let moved = Mesh::new(mesh.dimension(), positions, triangles).unwrap();
    session.set_positions(positions_array(&moved)).await.unwrap();
    session.step().await.unwrap();
    destroy(&device);
    while session.advance().await.unwrap().is_truthy() {}
    assert_eq!(session.backend(), "cpu");
    assert_eq!(triangles_of(&session).await, expected(&moved).await);
    assert_eq!(create(&mesh, "auto", &device).await.unwrap().backend(), "cpu");
}
