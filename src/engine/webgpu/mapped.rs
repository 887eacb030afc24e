//! Copies in a browser, directly between mapped buffers and the memory of the module. wgpu would copy everything twice.

use super::buffer::Buffer;
use super::copies::{CHUNK, ReadBack};
use super::device::Device;
use super::faults::{Caught, watch};
use super::words::{Words, vector};
use crate::Error;
use futures_channel::oneshot;
use js_sys::Uint32Array;
use std::collections::VecDeque;
use std::ops::Range;
use wgpu::BufferUsages;

/// From so many bytes on, a kept staging buffer is faster than `writeBuffer`.
const FEWEST_STAGED: u64 = 1 << 19;

/// The most staging buffers that the upload of a mesh makes.
const MOST_STAGED: usize = 8;

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

/// Pieces that go through one staging buffer, and their bytes.
type Group<'a> = (Vec<Piece<'a>>, u64);

/// Writes to the starts of buffers, in groups.
fn groups<'a>(writes: &[(&'a Buffer, &'a [u32])]) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'a>> = Vec::new();
    for &(buffer, words) in writes {
        for (i, words) in words.chunks(CHUNK).enumerate() {
            let (offset, size) = (4 * (i * CHUNK) as u64, size_of_val(words) as u64);
            let piece = Piece { buffer, offset, words };
            match groups.last_mut().filter(|(_, bytes)| bytes + size <= 4 * CHUNK as u64) {
                Some((pieces, bytes)) => {
                    pieces.push(piece);
                    *bytes += size;
                }
                None => groups.push((vec![piece], size)),
            }
        }
    }
    groups
}

/// Tells whether a staging buffer is mapped.
type Ready = oneshot::Receiver<bool>;

impl Device {
    /// Writes words to the starts of buffers, before the next submission. Does not wait: what the mapped staging buffers
    /// cannot take goes through `writeBuffer`.
    pub(super) fn write_all(&self, writes: &[(&Buffer, &[u32])]) {
        for group in groups(writes) {
            if self.stage(&group).is_none() {
                self.write_slowly(&group);
                if group.1 >= FEWEST_STAGED {
                    drop(self.new_staging(group.1));
                }
            }
        }
    }

    /// The same for the arrays of a new mesh. Returns the faults. Waits for staging buffers, at most [`MOST_STAGED`]:
    /// new memory takes far longer than the copy.
    pub(super) async fn upload(&self, writes: &[(&Buffer, &[u32])]) -> Vec<Caught> {
        let groups = groups(writes);
        let largest = groups.iter().map(|group| group.1).max().unwrap_or_default();
        let mut busy = VecDeque::new();
        if largest >= FEWEST_STAGED {
            let wanted = groups.len().min(MOST_STAGED);
            busy.extend((self.kept_for_writes.count()..wanted).map(|_| self.new_staging(largest)));
        }
        let mut faults = Vec::new();
        for group in groups {
            loop {
                let (staged, caught) = watch(&self.device, || self.stage(&group));
                faults.push(caught);
                if let Some(ready) = staged {
                    busy.push_back(ready);
                    break;
                }
                // A buffer that is not mapped in the end is not waited for again.
                let Some(ready) = busy.pop_front().filter(|_| group.1 >= FEWEST_STAGED) else {
                    faults.push(watch(&self.device, || self.write_slowly(&group)).1);
                    break;
                };
                let _ = ready.await;
            }
        }
        faults
    }

    /// Writes a group through a kept staging buffer, if one is mapped. Tells when the buffer is mapped again.
    fn stage(&self, (pieces, bytes): &Group<'_>) -> Option<Ready> {
        if *bytes < FEWEST_STAGED {
            return None;
        }
        let staging = self.kept_for_writes.take(*bytes)?;
        let view = mapped(&staging, &(0..*bytes))?;
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
        self.submit(encoder);
        Some(self.make_ready(staging))
    }

    /// Writes a group through memory of the browser, which is new each time.
    fn write_slowly(&self, (pieces, _): &Group<'_>) {
        for Piece { buffer, offset, words } in pieces {
            self.queue.write_buffer(buffer, *offset, bytemuck::cast_slice(words));
        }
    }

    /// A new staging buffer for later writes. A failed allocation is ignored: the mesh does not need this buffer.
    fn new_staging(&self, bytes: u64) -> Ready {
        let new = || self.make_ready(self.staging(bytes, BufferUsages::MAP_WRITE | BufferUsages::COPY_SRC));
        watch(&self.device, new).0
    }

    /// Maps a staging buffer, and keeps it for later writes once the device has finished its copies.
    fn make_ready(&self, staging: Buffer) -> Ready {
        let (buffer, kept) = ((*staging).clone(), self.kept_for_writes.clone());
        let (sender, ready) = oneshot::channel();
        buffer.map_async(wgpu::MapMode::Write, .., move |result| {
            if result.is_ok() {
                kept.put(staging);
            }
            // Few callers wait for it.
            let _ = sender.send(result.is_ok());
        });
        ready
    }
}
