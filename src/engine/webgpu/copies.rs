//! Copies to a device, and back.

use super::buffer::Buffer;
use super::device::Device;
use super::faults::{Caught, watch};
use super::words::{Words, reserve, vector};
use crate::Error;
use crate::engine::Answer;
#[cfg(not(target_arch = "wasm32"))]
use crate::system::threads::Threads;
use futures_channel::oneshot;
use std::ops::Range;
#[cfg(test)]
use std::sync::atomic::Ordering::Relaxed;
use wgpu::BufferUsages;

/// The most words of one copy to the device, or from it. Longer arrays go in several copies through the same staging
/// memory, which is far faster than new memory. In a browser each copy goes through two processes, and the second begins
/// when the first has finished: shorter copies overlap more.
pub(super) const CHUNK: usize = if cfg!(target_arch = "wasm32") { 1 << 20 } else { 1 << 22 };

/// Copies that the device makes while the host takes one.
const AHEAD: usize = if cfg!(target_arch = "wasm32") { 4 } else { 1 };

/// Words that one thread copies without a break.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const PIECE: usize = 1 << 16;

/// What to read: `words` words of `buffer`, from word `first` on.
pub(super) struct Source<'a> {
    pub(super) buffer: &'a wgpu::Buffer,
    pub(super) first: usize,
    pub(super) words: usize,
}

impl<'a> Source<'a> {
    /// From the start of a buffer.
    pub(super) fn new(buffer: &'a Buffer, words: usize) -> Self {
        Self { buffer, first: 0, words }
    }
}

/// A read that the device has not finished.
pub(super) struct PendingRead<'a> {
    gpu: &'a Device,
    staging: Buffer,
    caught: Caught,
    receiver: oneshot::Receiver<Result<(), wgpu::BufferAsyncError>>,
    ranges: Vec<Range<u64>>,
}

impl<'a> PendingRead<'a> {
    /// Waits for the device.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn finished(self) -> Result<ReadBack<'a>, Error> {
        let Self { gpu, staging, caught, receiver, ranges } = self;
        gpu.judge(caught.await)?;
        #[cfg(not(target_arch = "wasm32"))]
        gpu.wait().map_err(|_| gpu.not_mapped())?;
        if !matches!(receiver.await, Ok(Ok(()))) {
            return Err(gpu.not_mapped());
        }
        gpu.check()?;
        Ok(ReadBack { gpu, staging: Some(staging), ranges })
    }
}

/// Words read back, in a mapped staging buffer. On drop, the device keeps the buffer for the next read.
pub(super) struct ReadBack<'a> {
    pub(super) gpu: &'a Device,
    pub(super) staging: Option<Buffer>,
    /// The byte range of each source in the staging buffer.
    pub(super) ranges: Vec<Range<u64>>,
}

impl Drop for ReadBack<'_> {
    fn drop(&mut self) {
        if let Some(staging) = self.staging.take() {
            staging.unmap();
            self.gpu.kept_for_reads.put(staging);
        }
    }
}

impl ReadBack<'_> {
    /// The words of the source with index `source`.
    ///
    /// # Errors
    /// [`Error::Device`].
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn words(&self, source: usize) -> Result<Vec<u32>, Error> {
        let mut words = Vec::new();
        self.append(source, &mut words).map(|()| words)
    }

    /// Copies the words of a source behind the first `_taken` words, which `result` has.
    ///
    /// # Errors
    /// [`Error::Device`].
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn fill(&self, source: usize, result: &mut Words, _taken: usize) -> Result<(), Error> {
        self.append(source, result)
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn append(&self, source: usize, result: &mut Vec<u32>) -> Result<(), Error> {
        let range = self.ranges[source].clone();
        let Some(staging) = self.staging.as_ref().filter(|_| !range.is_empty()) else { return Ok(()) };
        let view = staging.get_mapped_range(range).map_err(|_| self.gpu.not_mapped())?;
        Threads::default().append(result, bytemuck::cast_slice(&view));
        Ok(())
    }
}

/// A read of a long array, in pieces. The device copies the next pieces while the host takes one.
pub(super) struct LongRead<'a> {
    gpu: &'a Device,
    buffer: wgpu::Buffer,
    rest: Range<usize>,
    /// At most [`AHEAD`], in the order of the words.
    pending: Vec<PendingRead<'a>>,
}

impl LongRead<'_> {
    /// Submits the next pieces.
    fn advance(&mut self) {
        while self.pending.len() < AHEAD && !self.rest.is_empty() {
            let words = self.rest.len().min(CHUNK);
            let source = Source { buffer: &self.buffer, first: self.rest.start, words };
            let nothing = || self.gpu.device.create_command_encoder(&Default::default());
            self.pending.push(self.gpu.submit_and_map(&nothing, &[source]));
            self.rest.start += words;
        }
    }

    /// Waits, and copies the words behind the first `taken` words, which `result` has.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn fill(mut self, result: &mut Words, mut taken: usize) -> Result<(), Error> {
        while !self.pending.is_empty() {
            let piece = self.pending.remove(0).finished().await?;
            self.advance();
            piece.fill(0, result, taken)?;
            taken += CHUNK;
        }
        Ok(())
    }
}

impl Device {
    /// Reads `words` words from the start of `buffer`.
    ///
    /// # Errors
    /// [`Error::Device`]; [`Error::OutOfMemory`].
    pub(super) fn read(&self, buffer: &wgpu::Buffer, words: usize) -> Answer<'_, Vec<u32>> {
        let read = self.read_array(buffer, words);
        Box::pin(async { read.await.map(vector) })
    }

    /// The same, into an array of the host.
    ///
    /// # Errors
    /// [`Error::Device`]; [`Error::OutOfMemory`].
    pub(super) fn read_array(&self, buffer: &wgpu::Buffer, words: usize) -> Answer<'_, Words> {
        let read = self.begin_read(buffer, 0..words);
        let bytes = 4 * words as u64;
        Box::pin(async move {
            let mut result = reserve(words).ok_or(Error::OutOfMemory { bytes, limit: None })?;
            read.fill(&mut result, 0).await.map(|()| result)
        })
    }

    /// Begins to read some words of `buffer`.
    pub(super) fn begin_read(&self, buffer: &wgpu::Buffer, words: Range<usize>) -> LongRead<'_> {
        let mut read = LongRead { gpu: self, buffer: buffer.clone(), rest: words, pending: Vec::new() };
        read.advance();
        read
    }

    /// Why a buffer is not mapped: the first error of the device. A device of the caller, which is lost, tells of that
    /// in no other way.
    pub(super) fn not_mapped(&self) -> Error {
        self.report("the driver did not map a staging buffer".to_owned())
    }

    /// Submits commands.
    pub(super) fn submit(&self, encoder: wgpu::CommandEncoder) {
        self.queue.submit([encoder.finish()]);
        #[cfg(test)]
        self.asked.submissions.fetch_add(1, Relaxed);
    }

    /// Submits the commands from `record` together with reads of the sources after them, and waits.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn submit_and_read(
        &self,
        record: &dyn Fn() -> wgpu::CommandEncoder,
        sources: &[Source<'_>],
    ) -> Result<ReadBack<'_>, Error> {
        self.submit_and_map(record, sources).finished().await
    }

    /// The same, without the wait.
    pub(super) fn submit_and_map(
        &self,
        record: &dyn Fn() -> wgpu::CommandEncoder,
        sources: &[Source<'_>],
    ) -> PendingRead<'_> {
        let mut end = 0;
        let range = |source: &Source<'_>| {
            // A view begins at a multiple of eight bytes.
            let begin = u64::next_multiple_of(end, 8);
            end = begin + 4 * source.words as u64;
            begin..end
        };
        let ranges: Vec<_> = sources.iter().map(range).collect();
        let (sender, receiver) = oneshot::channel();
        let submit = || {
            let new = || self.staging(end, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
            let staging = self.kept_for_reads.take(end).unwrap_or_else(new);
            let mut encoder = record();
            for (Source { buffer, first, words }, range) in sources.iter().zip(&ranges) {
                let size = 4 * *words as u64;
                encoder.copy_buffer_to_buffer(buffer, 4 * *first as u64, &staging, range.start, size);
            }
            self.submit(encoder);
            staging.map_async(wgpu::MapMode::Read, ..end.max(4), move |result| {
                // The receiver is gone only if the caller has stopped waiting.
                let _ = sender.send(result);
            });
            #[cfg(test)]
            self.asked.maps.fetch_add(1, Relaxed);
            staging
        };
        let (staging, caught) = watch(&self.device, submit);
        PendingRead { gpu: self, staging, caught, receiver, ranges }
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn wait(&self) -> Result<wgpu::PollStatus, wgpu::PollError> {
        self.device.poll(wgpu::PollType::wait_indefinitely())
    }

    /// Natively, waits for all copies to the device.
    pub(super) fn finish_copies(&self) {
        #[cfg(not(target_arch = "wasm32"))]
        {
            self.queue.submit([]);
            // If this fails, the next call that can return an error reports it.
            let _ = self.wait();
        }
    }

    /// Writes words to the start of `buffer`, before the next submission.
    pub(super) fn write(&self, buffer: &Buffer, words: &[u32]) {
        self.write_all(&[(buffer, words)]);
    }

    /// Writes words to the starts of buffers, before the next submission.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn write_all(&self, writes: &[(&Buffer, &[u32])]) {
        writes.iter().for_each(|(buffer, words)| self.write_at(buffer, 0, words));
    }

    /// Writes the arrays of a new mesh to buffers, each from a word on. Returns the faults.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) async fn upload(&self, writes: &[(&Buffer, usize, &[u32])]) -> Vec<Caught> {
        let write = || writes.iter().for_each(|(buffer, first, words)| self.write_at(buffer, *first, words));
        vec![watch(&self.device, write).1]
    }

    /// Writes words to `buffer` from word `first` on, before the next submission.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn write_at(&self, buffer: &Buffer, first: usize, words: &[u32]) {
        for (i, chunk) in words.chunks(CHUNK).enumerate() {
            let offset = 4 * (first + i * CHUNK) as u64;
            self.stage(buffer, offset, chunk);
            if chunk.len() == CHUNK {
                self.finish_copies();
            }
        }
    }

    /// Copies words to staging memory, on several threads. The next submission copies them to `buffer` at byte
    /// `offset`.
    #[cfg(not(target_arch = "wasm32"))]
    fn stage(&self, buffer: &Buffer, offset: u64, words: &[u32]) {
        let size = wgpu::BufferSize::new(size_of_val(words) as u64);
        // Without a view, wgpu has reported the error.
        let Some(mut view) = size.and_then(|size| self.queue.write_buffer_with(buffer, offset, size)) else {
            return;
        };
        let (pieces, mut rest) = view.slice(..).into_chunks::<{ 4 * PIECE }>();
        let (whole, last) = words.as_chunks::<PIECE>();
        rest.copy_from_slice(bytemuck::cast_slice(last));
        let pieces: Vec<_> = whole.iter().zip(pieces).collect();
        Threads::default().map_each(pieces, |(words, copy)| {
            wgpu::WriteOnly::<[u8]>::from(copy).copy_from_slice(bytemuck::cast_slice(words));
        });
    }
}
