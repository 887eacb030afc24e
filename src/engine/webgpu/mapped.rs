//! Copies in a browser, directly between mapped buffers and the memory of the module. wgpu would copy everything twice.

use super::buffer::Buffer;
use super::buffer::MOST_KEPT;
use super::copies::ReadBack;
use super::device::Device;
use super::faults::watch;
use crate::Error;
use js_sys::Uint32Array;
use std::ops::Range;
use wasm_bindgen::prelude::*;
use wgpu::BufferUsages;

/// From so many bytes on, a kept staging buffer is faster than `writeBuffer`.
const FEWEST_STAGED: u64 = 1 << 19;

/// A view of the words in a range of a mapped buffer. Two views of a buffer must not overlap.
fn mapped(buffer: &wgpu::Buffer, bytes: &Range<u64>) -> Option<Uint32Array> {
    if bytes.is_empty() {
        return Some(Uint32Array::new_with_length(0));
    }
    let (first, size) = (bytes.start as f64, (bytes.end - bytes.start) as f64);
    let memory = buffer.as_webgpu()?.get_mapped_range_with_f64_and_f64(first, size).ok()?;
    Some(Uint32Array::new(&memory))
}

/// The array that a result is read into.
pub(super) type Words = Uint32Array;

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
pub(super) fn reserve(words: usize) -> Option<Words> {
    let reserved: Uint32Array = FallibleArray::new(words as f64).ok()?.unchecked_into();
    (0..words as u32).step_by(PAGE).for_each(|word| reserved.set_index(word, 1));
    Some(reserved)
}

impl ReadBack<'_> {
    /// Copies the words of a source into memory from [`reserve`].
    pub(super) fn fill(&self, source: usize, reserved: Words) -> Result<Words, Error> {
        reserved.set(&self.view(source)?.into(), 0);
        Ok(reserved)
    }

    pub(super) fn append(&self, source: usize, result: &mut Vec<u32>) -> Result<(), Error> {
        let mut words = self.view(source)?.to_vec();
        if result.is_empty() {
            *result = words;
        } else {
            result.append(&mut words);
        }
        Ok(())
    }

    /// A view of the words of a source. Call it once per source.
    fn view(&self, source: usize) -> Result<Uint32Array, Error> {
        let view = self.staging.as_ref().and_then(|staging| mapped(staging, &self.ranges[source]));
        view.ok_or_else(|| self.gpu.not_mapped())
    }
}

impl Device {
    /// Writes words to the starts of buffers, through the kept staging buffer if it is mapped. If not, prepares one for
    /// the next call.
    pub(super) fn write_all(&self, writes: &[(&Buffer, &[u32])]) {
        let bytes = writes.iter().map(|(_, words)| size_of_val(*words) as u64).sum();
        let is_staged = (FEWEST_STAGED..=MOST_KEPT).contains(&bytes);
        if is_staged && self.write_staged(bytes, writes).is_some() {
            return;
        }
        writes.iter().for_each(|(buffer, words)| self.write(buffer, words));
        if is_staged {
            let new =
                || self.make_ready(self.staging(bytes, BufferUsages::MAP_WRITE | BufferUsages::COPY_SRC));
            // A failed allocation is ignored: the mesh does not need this buffer.
            drop(watch(&self.device, new));
        }
    }

    /// `None` if no staging buffer is mapped.
    fn write_staged(&self, bytes: u64, writes: &[(&Buffer, &[u32])]) -> Option<()> {
        let staging = self.kept_for_writes.take(bytes)?;
        let view = mapped(&staging, &(0..bytes))?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut first = 0;
        for (buffer, words) in writes {
            let end = first + words.len() as u32;
            view.subarray(first, end).copy_from(words);
            let (offset, size) = (4 * u64::from(first), size_of_val(*words) as u64);
            encoder.copy_buffer_to_buffer(&staging, offset, buffer, 0, size);
            first = end;
        }
        staging.unmap();
        self.submit(encoder);
        self.make_ready(staging);
        Some(())
    }

    /// Maps a staging buffer, and keeps it for the next writes once the device has finished its copies.
    fn make_ready(&self, staging: Buffer) {
        let (buffer, kept) = ((*staging).clone(), self.kept_for_writes.clone());
        buffer.map_async(wgpu::MapMode::Write, .., move |result| {
            if result.is_ok() {
                kept.put(staging);
            }
        });
    }

    /// Copies words to staging memory. The next submission copies them to `buffer` at byte `offset`.
    pub(super) fn stage(&self, buffer: &Buffer, offset: u64, words: &[u32]) {
        self.queue.write_buffer(buffer, offset, bytemuck::cast_slice(words));
    }
}
