//! The exports of wasm-bindgen for the npm package. The TypeScript in `src/js/` calls them; no other room of the crate
//! imports this one.

#[cfg(feature = "js-audit")]
pub mod audit;
#[cfg(feature = "js-files")]
pub mod files;
#[cfg(feature = "js")]
pub mod gpu;
#[cfg(feature = "js-session")]
mod objects;
#[cfg(any(feature = "js-session", feature = "js-webgl2", feature = "js-audit"))]
mod options;
#[cfg(feature = "js-points")]
pub mod points;
#[cfg(feature = "js-session")]
pub mod session;
#[cfg(feature = "js-threads")]
pub mod threads;
#[cfg(feature = "js-untangle")]
pub mod untangle;
mod values;
#[cfg(feature = "js-points")]
pub mod voronoi;
#[cfg(feature = "js-webgl2")]
pub mod webgl2;
