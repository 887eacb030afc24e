//! The WebGL2 engine. It is in a WebAssembly module of its own (feature `js-webgl2`). The module of the other engines
//! (feature `js`) calls it through a proxy.

#[cfg(feature = "js-webgl2")]
mod context;
#[cfg(feature = "js-webgl2")]
mod errors;
#[cfg(feature = "js-webgl2")]
mod iteration;
#[cfg(feature = "js")]
mod module_proxy;
#[cfg(feature = "js-webgl2")]
mod moving;
mod question;
#[cfg(feature = "js-webgl2")]
mod start;
#[cfg(feature = "js-webgl2")]
mod texture;
#[cfg(feature = "js-webgl2")]
mod untangle;

#[cfg(feature = "js-webgl2")]
pub(crate) use context::set_shader_loader;
#[cfg(feature = "js-webgl2")]
pub(crate) use iteration::WebGl;
#[cfg(feature = "js")]
pub use module_proxy::WebGl2Module;
#[cfg(feature = "js")]
pub(crate) use module_proxy::{Proxy, set_webgl2};
#[cfg(feature = "js-webgl2")]
pub(crate) use question::Question;
