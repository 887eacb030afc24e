//! The array that a result is read into.

#[cfg(not(target_arch = "wasm32"))]
use crate::system::threads::Threads;
#[cfg(target_arch = "wasm32")]
use js_sys::Uint32Array;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen::prelude::*;

#[cfg(not(target_arch = "wasm32"))]
pub(super) type Words = Vec<u32>;

/// In a browser it is an array of the page, so that nothing goes through the memory of the module.
#[cfg(target_arch = "wasm32")]
pub(super) type Words = Uint32Array;

/// The words, in the memory of the program or of the module.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn vector(words: Words) -> Vec<u32> {
    words
}

#[cfg(target_arch = "wasm32")]
pub(super) fn vector(words: Words) -> Vec<u32> {
    words.to_vec()
}

/// A copy of words of the program or of the module.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn copied(words: &[u32]) -> Words {
    Threads::default().copied(words)
}

#[cfg(target_arch = "wasm32")]
pub(super) fn copied(words: &[u32]) -> Words {
    words.into()
}

/// Memory for `words` words, if available.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn reserve(words: usize) -> Option<Words> {
    let mut reserved = Vec::new();
    reserved.try_reserve_exact(words).ok().map(|()| reserved)
}

#[cfg(target_arch = "wasm32")]
#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_name = Uint32Array)]
    type FallibleArray;
    #[wasm_bindgen(catch, constructor, js_class = "Uint32Array")]
    fn new(length: f64) -> Result<FallibleArray, JsValue>;
}

/// Words of a memory page. Pages may be larger.
#[cfg(target_arch = "wasm32")]
const PAGE: usize = 1024;

/// Memory for `words` words, if available. The system allocates each page at its first write, which takes longer than a
/// copy. So this call writes to each page, while the GPU works.
#[cfg(target_arch = "wasm32")]
pub(super) fn reserve(words: usize) -> Option<Words> {
    let reserved: Uint32Array = FallibleArray::new(words as f64).ok()?.unchecked_into();
    (0..words as u32).step_by(PAGE).for_each(|word| reserved.set_index(word, 1));
    Some(reserved)
}
