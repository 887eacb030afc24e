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
#[cfg(feature = "js-point-session")]
pub mod point_session;
#[cfg(any(feature = "js-points", feature = "js-point-session"))]
mod point_values;
#[cfg(feature = "js-points")]
pub mod points;
#[cfg(feature = "js-session")]
pub mod session;
#[cfg(any(feature = "js-threads", feature = "js-points-threads"))]
pub mod threads;
#[cfg(feature = "js-untangle")]
pub mod untangle;
mod values;
#[cfg(all(feature = "js-points", not(feature = "js-points-threads")))]
pub mod voronoi;
#[cfg(feature = "js-webgl2")]
pub mod webgl2;
