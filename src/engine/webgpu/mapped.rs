//! Copies in a browser, directly between mapped buffers and the memory of the module. wgpu would copy everything twice.

use super::buffer::Buffer;
use super::copies::{CHUNK, ReadBack};
use super::device::Device;
use super::faults::watch;
use super::words::{Words, vector};
use crate::Error;
use js_sys::Uint32Array;
use std::ops::Range;
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

impl ReadBack<'_> {
    /// Copies the words of a source behind the first `taken` words, which `result` has.
    pub(super) fn fill(&self, source: usize, result: &mut Words, taken: usize) -> Result<(), Error> {
        result.set(&self.view(source)?.into(), taken as u32);
        Ok(())
    }

    /// The words of the source with index `source`.
    pub(super) fn words(&self, source: usize) -> Result<Vec<u32>, Error> {
        self.view(source).map(vector)
    }

    /// A view of the words of a source. Call it once per source.
    fn view(&self, source: usize) -> Result<Uint32Array, Error> {
        let view = self.staging.as_ref().and_then(|staging| mapped(staging, &self.ranges[source]));
        view.ok_or_else(|| self.gpu.not_mapped())
    }
}

/// Words for a buffer, from byte `offset` on.
struct Piece<'a> {
    buffer: &'a Buffer,
    offset: u64,
    words: &'a [u32],
}

impl Device {
    /// Writes words to the starts of buffers, before the next submission.
    pub(super) fn write_all(&self, writes: &[(&Buffer, &[u32])]) {
        let (mut pieces, mut bytes) = (Vec::new(), 0);
        for (buffer, words) in writes {
            for (i, words) in words.chunks(CHUNK).enumerate() {
                let (offset, size) = (4 * (i * CHUNK) as u64, size_of_val(words) as u64);
                if bytes + size > 4 * CHUNK as u64 {
                    self.stage(&pieces, bytes);
                    pieces.clear();
                    bytes = 0;
                }
                pieces.push(Piece { buffer, offset, words });
                bytes += size;
            }
        }
        self.stage(&pieces, bytes);
    }

    /// Writes `bytes` bytes in pieces, through a kept staging buffer if one is mapped. If not, prepares one for a later
    /// call.
    fn stage(&self, pieces: &[Piece<'_>], bytes: u64) {
        let is_staged = bytes >= FEWEST_STAGED;
        let kept = if is_staged { self.kept_for_writes.take(bytes) } else { None };
        if let Some((staging, view)) =
            kept.and_then(|kept| mapped(&kept, &(0..bytes)).map(|view| (kept, view)))
        {
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let mut first = 0;
            for Piece { buffer, offset, words } in pieces {
                let end = first + words.len() as u32;
                view.subarray(first, end).copy_from(words);
                let (from, size) = (4 * u64::from(first), size_of_val(*words) as u64);
                encoder.copy_buffer_to_buffer(&staging, from, buffer, *offset, size);
                first = end;
            }
            staging.unmap();
            self.submit(encoder.finish());
            return self.make_ready(staging);
        }
        for Piece { buffer, offset, words } in pieces {
            self.queue.write_buffer(buffer, *offset, bytemuck::cast_slice(words));
        }
        if is_staged {
            let new =
                || self.make_ready(self.staging(bytes, BufferUsages::MAP_WRITE | BufferUsages::COPY_SRC));
            // A failed allocation is ignored: the mesh does not need this buffer.
            drop(watch(&self.device, new));
        }
    }

    /// Maps a staging buffer, and keeps it for later writes once the device has finished its copies.
    fn make_ready(&self, staging: Buffer) {
        let (buffer, kept) = ((*staging).clone(), self.kept_for_writes.clone());
        buffer.map_async(wgpu::MapMode::Write, .., move |result| {
            if result.is_ok() {
                kept.put(staging);
            }
        });
    }
}
