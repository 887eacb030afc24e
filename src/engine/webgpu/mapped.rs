//! Copies in a browser, straight between mapped memory and that of the module: wgpu would copy everything once more.

use super::buffer::Buffer;
use super::buffer::MOST_KEPT;
use super::copies::Landed;
use super::device::Device;
use super::faults::watch;
use crate::Error;
use js_sys::Uint32Array;
use std::ops::Range;
use wasm_bindgen::prelude::*;
use wgpu::BufferUsages;

/// Bytes from which on memory that is kept is faster than the browser's own way to write.
const FEWEST_STAGED: u64 = 1 << 19;

/// The words of a buffer that is mapped, where they are. Views of it must have nothing in common.
fn mapped(buffer: &wgpu::Buffer, bytes: &Range<u64>) -> Option<Uint32Array> {
    if bytes.is_empty() {
        return Some(Uint32Array::new_with_length(0));
    }
    let (first, size) = (bytes.start as f64, (bytes.end - bytes.start) as f64);
    let memory = buffer.as_webgpu()?.get_mapped_range_with_f64_and_f64(first, size).ok()?;
    Some(Uint32Array::new(&memory))
}

/// Words for whoever has asked for a result.
pub(super) type Words = Uint32Array;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_name = Uint32Array)]
    type Room;
    #[wasm_bindgen(catch, constructor, js_class = "Uint32Array")]
    fn new(length: f64) -> Result<Room, JsValue>;
}

/// Words of a page of memory, or of a part of it where pages are larger.
const PAGE: usize = 1024;

/// Room for so many, if there is any. The system gives a page of it when it is first written, which takes longer than a
/// copy: it does so now.
pub(super) fn room(words: usize) -> Option<Words> {
    let room: Uint32Array = Room::new(words as f64).ok()?.unchecked_into();
    (0..words as u32).step_by(PAGE).for_each(|word| room.set_index(word, 1));
    Some(room)
}

impl Landed<'_> {
    /// Puts the words of a source into room for them.
    pub(super) fn fill(&self, source: usize, room: Words) -> Result<Words, Error> {
        room.set(&self.view(source)?.into(), 0);
        Ok(room)
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

    /// The words where they are, once for each source.
    fn view(&self, source: usize) -> Result<Uint32Array, Error> {
        let view = self.staging.as_ref().and_then(|staging| mapped(staging, &self.places[source]));
        view.ok_or_else(|| self.gpu.not_mapped())
    }
}

impl Device {
    /// The same through memory that is kept, if that is ready; else it is for the next time.
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
            // Where there is no memory for it, that is not the fault of the mesh.
            drop(watch(&self.device, new));
        }
    }

    /// None where it was not ready.
    fn write_staged(&self, bytes: u64, writes: &[(&Buffer, &[u32])]) -> Option<()> {
        let staging = self.written.take(bytes)?;
        let view = mapped(&staging, &(0..bytes))?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut first = 0;
        for (buffer, words) in writes {
            let end = first + words.len() as u32;
            view.subarray(first, end).copy_from(words);
            let (place, size) = (4 * u64::from(first), size_of_val(*words) as u64);
            encoder.copy_buffer_to_buffer(&staging, place, buffer, 0, size);
            first = end;
        }
        staging.unmap();
        self.submit(encoder);
        self.make_ready(staging);
        Some(())
    }

    /// Maps a buffer for the next copies to the device, which have it once the last ones are done.
    fn make_ready(&self, staging: Buffer) {
        let (buffer, written) = (staging.0.clone(), self.written.clone());
        buffer.map_async(wgpu::MapMode::Write, .., move |result| {
            if result.is_ok() {
                written.put(staging);
            }
        });
    }

    /// Copies words from where they are; the next submission takes them to their place.
    pub(super) fn stage(&self, buffer: &Buffer, place: u64, words: &[u32]) {
        self.queue.write_buffer(buffer, place, bytemuck::cast_slice(words));
    }
}
