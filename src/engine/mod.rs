//! Engines run the phases. All engines give the same triangles after every iteration.
//!
//! `webgpu` and `webgl2` run the shaders, `gpu` has what both need, `cpu` runs the phases on the CPU, and `interface`
//! has the trait that a session calls. `docs/architecture.md` has the order of these rooms.

mod cpu;
#[cfg(feature = "gpu")]
mod gpu;
mod interface;
#[cfg(all(test, feature = "gpu"))]
mod tests;
#[cfg(all(target_arch = "wasm32", any(feature = "js", feature = "js-webgl2")))]
mod webgl2;
#[cfg(feature = "gpu")]
mod webgpu;

pub(crate) use cpu::{Cpu, Lawson};
#[cfg(feature = "gpu")]
pub(crate) use gpu::{Form, Upload, self_test};
#[cfg(all(not(target_arch = "wasm32"), feature = "gpu"))]
pub use interface::GpuBuffers;
#[cfg(feature = "gpu")]
use interface::positions_of;
pub(crate) use interface::{Answer, Census, EdgeCounts, Engine, MOST_ITERATIONS, Moved};
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub use webgl2::WebGl2Module;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(crate) use webgl2::{Proxy, set_webgl2};
#[cfg(all(target_arch = "wasm32", feature = "js-webgl2"))]
pub(crate) use webgl2::{Question, WebGl, set_shader_loader};
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub use webgpu::GpuDevice;
#[cfg(all(not(target_arch = "wasm32"), feature = "gpu"))]
pub use webgpu::GpuDevice;
#[cfg(feature = "baseline")]
pub use webgpu::baseline::select_on_cpu;
#[cfg(feature = "gpu")]
pub(crate) use webgpu::{Device, GivenDevice, Handle as DeviceHandle, WebGpu};
