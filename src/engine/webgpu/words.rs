//! The array that a result is read into.

#[cfg(not(target_arch = "wasm32"))]
use crate::system::{memory, threads::Threads};
#[cfg(target_arch = "wasm32")]
use js_sys::Uint32Array;
#[cfg(not(target_arch = "wasm32"))]
use std::hint::black_box;
#[cfg(not(target_arch = "wasm32"))]
use std::num::NonZero;
use std::pin::Pin;
#[cfg(not(target_arch = "wasm32"))]
use std::thread::{Builder, available_parallelism};
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

/// Copies words of the program or of the module to `result` from word `first` on.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn put(result: &mut Words, first: usize, words: &[u32]) {
    Threads::default().put(result, first, words);
}

#[cfg(target_arch = "wasm32")]
pub(super) fn put(result: &mut Words, first: usize, words: &[u32]) {
    result.subarray(first as u32, (first + words.len()) as u32).copy_from(words);
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
const PAGE: usize = 1024;

/// Memory for `words` words, if available. The system allocates each page at its first write, which takes longer than a
/// copy. So this call writes to each page, while the GPU works.
#[cfg(target_arch = "wasm32")]
pub(super) fn reserve(words: usize) -> Option<Words> {
    let reserved: Uint32Array = FallibleArray::new(words as f64).ok()?.unchecked_into();
    (0..words as u32).step_by(PAGE).for_each(|word| reserved.set_index(word, 1));
    Some(reserved)
}

/// Memory for a result that is read later, if available.
pub(super) type Reserved = Pin<Box<dyn Future<Output = Option<Words>>>>;

/// From so many words on, memory is reserved before it is needed: with fewer, the threads cost more than they save. In
/// debug builds it is small, so that small meshes test it.
#[cfg(not(target_arch = "wasm32"))]
const FEWEST_AHEAD: usize = if cfg!(debug_assertions) { 1000 } else { 1 << 24 };

/// Begins to reserve memory. The system allocates each page at its first write, which takes longer than a copy. So
/// threads write to each page while the GPU works. They are not those of the pool: all of these may wait for a GPU.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn reserve_ahead(words: usize) -> Reserved {
    let touch = move || memory::check(4 * words as u64).ok().map(|()| touched(words));
    let thread = if words < FEWEST_AHEAD { None } else { Builder::new().spawn(touch).ok() };
    Box::pin(async { thread?.join().ok()? })
}

/// Zeros, after a write to each page.
#[cfg(not(target_arch = "wasm32"))]
fn touched(words: usize) -> Words {
    let mut result = vec![0; words];
    let piece = words.div_ceil(available_parallelism().map_or(1, NonZero::get)).max(FEWEST_AHEAD / 16);
    let touch = |piece: &mut [u32]| piece.iter_mut().step_by(PAGE).for_each(|word| *word = black_box(0));
    std::thread::scope(|scope| {
        for piece in result.chunks_mut(piece) {
            // Without a thread, the pages of the piece wait for the copy.
            let _ = Builder::new().spawn_scoped(scope, move || touch(piece));
        }
    });
    result
}

#[cfg(target_arch = "wasm32")]
pub(super) fn reserve_ahead(words: usize) -> Reserved {
    Box::pin(std::future::ready(reserve(words)))
}

/// The memory that another thread makes: a promise of a `Uint32Array`, or of nothing.
#[cfg(all(target_arch = "wasm32", feature = "js"))]
pub(super) fn promised(promise: js_sys::Object, words: usize) -> Reserved {
    let promise: js_sys::Promise = promise.unchecked_into();
    Box::pin(async move {
        let made = wasm_bindgen_futures::JsFuture::from(promise).await.ok()?.dyn_into::<Words>().ok();
        made.filter(|made| made.length() as usize == words)
    })
}
