//! The array that a result is read into.

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

/// Memory for a result, now or later.
pub(super) enum Reserved {
    Here(Option<Words>),
    /// A promise of a `Uint32Array`, or of nothing.
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    Promised(js_sys::Object),
}

impl Reserved {
    /// Memory for `_words` words, if available.
    pub(super) async fn words(self, _words: usize) -> Option<Words> {
        match self {
            Self::Here(reserved) => reserved,
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            Self::Promised(promise) => {
                let promise: js_sys::Promise = promise.unchecked_into();
                let made = wasm_bindgen_futures::JsFuture::from(promise).await.ok();
                let made = made.and_then(|made| made.dyn_into::<Words>().ok());
                made.filter(|made| made.length() as usize == _words).or_else(|| reserve(_words))
            }
        }
    }
}
