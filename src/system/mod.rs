//! What the machine provides: memory, threads, and promises of a browser.

#[cfg(all(target_arch = "wasm32", any(feature = "js", feature = "js-webgl2")))]
pub(crate) mod in_turn;
pub(crate) mod memory;
#[cfg(all(target_arch = "wasm32", any(feature = "js-session", feature = "js-webgl2")))]
pub(crate) mod promise;
pub(crate) mod threads;
