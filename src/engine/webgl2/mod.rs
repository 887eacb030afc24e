//! The WebGL2 engine. It has a WebAssembly module of its own (feature `js-webgl2`); the module of the other engines (feature
//! `js`) has a proxy of it.

#[cfg(feature = "js-webgl2")]
mod context;
#[cfg(feature = "js-webgl2")]
mod errors;
#[cfg(feature = "js-webgl2")]
mod iteration;
#[cfg(feature = "js")]
mod proxy;
#[cfg(feature = "js-webgl2")]
mod texture;

#[cfg(feature = "js-webgl2")]
pub(crate) use context::set_shader_loader;
#[cfg(feature = "js-webgl2")]
pub(crate) use iteration::WebGl;
#[cfg(feature = "js")]
pub use proxy::WebGl2Module;
#[cfg(feature = "js")]
pub(crate) use proxy::{Proxy, set_webgl2};
