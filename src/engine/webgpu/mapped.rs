//! Copies in a browser, directly between mapped buffers and the memory of the module. wgpu would copy everything twice.

use super::buffer::Buffer;
use super::copies::{self, CHUNK, ReadBack};
use super::device::Device;
use super::faults::{Caught, watch};
use super::words::{self, vector};
use crate::Error;
use futures_channel::oneshot;
use js_sys::Uint32Array;
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

fn bytes_of(words: usize) -> u64 {
    4 * words as u64
}

impl ReadBack<'_> {
    /// Copies the words of a source behind the first `taken` words, which `result` has.
    pub(super) fn fill(&self, source: usize, result: &mut words::Words, taken: usize) -> Result<(), Error> {
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

/// Words in the memory of the module, or in an array of the page.
pub(super) enum Words<'a> {
    Module(&'a [u32]),
    #[cfg(feature = "js")]
    Page(&'a Uint32Array),
}

impl Words<'_> {
    fn len(&self) -> usize {
        match self {
            Self::Module(words) => words.len(),
            #[cfg(feature = "js")]
            Self::Page(words) => words.length() as usize,
        }
    }

    /// Copies a range of the words to a view of the same length.
    fn copy(&self, range: &Range<usize>, view: &Uint32Array) {
        match self {
            Self::Module(words) => view.copy_from(&words[range.clone()]),
            #[cfg(feature = "js")]
            Self::Page(words) => view.set(&words.subarray(range.start as u32, range.end as u32), 0),
        }
    }
}

/// Words for a buffer, from a word of it on.
pub(super) type Write<'a> = (&'a Buffer, usize, Words<'a>);

fn of_module<'a>(writes: &[copies::Write<'a>]) -> Vec<Write<'a>> {
    writes.iter().map(|&(buffer, first, words)| (buffer, first, Words::Module(words))).collect()
}

/// A range of the words of a write.
pub(super) type Piece<'a> = (&'a Write<'a>, Range<usize>);

/// Pieces that go through one staging buffer, and their bytes.
pub(super) type Group<'a> = (Vec<Piece<'a>>, u64);

pub(super) fn groups<'a>(writes: &'a [Write<'a>]) -> Vec<Group<'a>> {
    let mut groups: Vec<Group<'a>> = Vec::new();
    for write in writes {
        let length = write.2.len();
        for start in (0..length).step_by(CHUNK) {
            let range = start..length.min(start + CHUNK);
            let size = 4 * range.len() as u64;
            match groups.last_mut().filter(|(_, bytes)| bytes + size <= 4 * CHUNK as u64) {
                Some((pieces, bytes)) => {
                    pieces.push((write, range));
                    *bytes += size;
                }
                None => groups.push((vec![(write, range)], size)),
            }
        }
    }
    groups
}

impl Device {
    /// Writes words before the next submission. Does not wait: what the mapped staging buffers cannot take goes through
    /// `writeBuffer`.
    pub(super) fn write_all(&self, writes: &[copies::Write<'_>]) {
        for group in groups(&of_module(writes)) {
            if !self.stage(&group) {
                self.write_slowly(&group);
                if group.1 >= FEWEST_STAGED {
                    self.add_staging(group.1);
                }
            }
        }
    }

    /// Writes the arrays of a new mesh. Returns the faults. Waits for staging buffers, at most [`MOST_STAGED`]: new memory
    /// takes far longer than the copy.
    pub(super) async fn upload(&self, writes: &[copies::Write<'_>]) -> Vec<Caught> {
        let writes = of_module(writes);
        let groups = groups(&writes);
        let largest = groups.iter().map(|group| group.1).max().unwrap_or_default();
        if largest >= FEWEST_STAGED {
            let present = self.kept_for_writes.count() + self.busy_for_writes.count();
            (present..groups.len().min(MOST_STAGED)).for_each(|_| self.add_staging(largest));
        }
        let mut faults = Vec::new();
        for group in groups {
            let mut may_wait = group.1 >= FEWEST_STAGED;
            loop {
                let write = || {
                    let is_staged = self.stage(&group);
                    if !is_staged && !may_wait {
                        self.write_slowly(&group);
                    }
                    is_staged || !may_wait
                };
                let (is_written, caught) = watch(&self.device, write);
                faults.push(caught);
                if is_written {
                    break;
                }
                may_wait = self.busy_for_writes.wait().await;
            }
        }
        faults
    }

    /// Writes a group through a kept staging buffer, if one is mapped. Returns whether one was.
    pub(super) fn stage(&self, (pieces, bytes): &Group<'_>) -> bool {
        let kept = if *bytes >= FEWEST_STAGED { self.kept_for_writes.take(*bytes) } else { None };
        let mapped = kept.and_then(|kept| mapped(&kept, &(0..*bytes)).map(|view| (kept, view)));
        let Some((staging, view)) = mapped else { return false };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut from = 0;
        for ((buffer, first, words), range) in pieces {
            let to = from + range.len() as u32;
            words.copy(range, &view.subarray(from, to));
            let [source, place, size] = [from as usize, first + range.start, range.len()].map(bytes_of);
            encoder.copy_buffer_to_buffer(&staging, source, buffer, place, size);
            from = to;
        }
        staging.unmap();
        self.submit(encoder.finish());
        self.make_ready(staging);
        true
    }

    /// Writes a group through memory of the browser, which is new each time.
    fn write_slowly(&self, (pieces, _): &Group<'_>) {
        for ((buffer, first, words), range) in pieces {
            match words {
                Words::Module(words) => {
                    let words = bytemuck::cast_slice(&words[range.clone()]);
                    self.queue.write_buffer(buffer, bytes_of(first + range.start), words);
                }
                // Arrays of the page are only staged.
                #[cfg(feature = "js")]
                Words::Page(_) => {}
            }
        }
    }

    /// Makes a staging buffer for later writes. A failed allocation is ignored: the mesh does not need this buffer.
    fn add_staging(&self, bytes: u64) {
        let new = || self.make_ready(self.staging(bytes, BufferUsages::MAP_WRITE | BufferUsages::COPY_SRC));
        drop(watch(&self.device, new));
    }

    /// Maps a staging buffer, and keeps it for later writes once the device has finished its copies.
    fn make_ready(&self, staging: Buffer) {
        let (buffer, kept) = ((*staging).clone(), self.kept_for_writes.clone());
        let (sender, receiver) = oneshot::channel();
        self.busy_for_writes.add(receiver);
        buffer.map_async(wgpu::MapMode::Write, .., move |result| {
            if result.is_ok() {
                kept.put(staging);
            }
            // Few wait for it.
            let _ = sender.send(());
        });
    }
}
