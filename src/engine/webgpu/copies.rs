//! What goes to a device, and comes back.

use super::buffer::Buffer;
#[cfg(target_arch = "wasm32")]
use super::buffer::MOST_KEPT;
use super::device::Device;
use super::faults::{Word, watch};
use crate::Error;
#[cfg(not(target_arch = "wasm32"))]
use crate::system::threads::Threads;
use futures_channel::oneshot;
use std::ops::Range;
#[cfg(test)]
use std::sync::atomic::Ordering::Relaxed;
use wgpu::BufferUsages;

/// Words that are copied to the device, or from it, at a time: the memory between them is used again, which is far
/// faster than more of it would be.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const CHUNK: usize = 1 << 22;
/// In a browser each time is a wait: as many as the memory between them has that is kept.
#[cfg(target_arch = "wasm32")]
pub(super) const CHUNK: usize = MOST_KEPT as usize / 4;

/// Words that one thread copies at a time.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const PIECE: usize = 1 << 16;

/// Words for whoever has asked for a result.
#[cfg(not(target_arch = "wasm32"))]
pub(super) type Words = Vec<u32>;

/// Room for so many.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn room(words: usize) -> Option<Words> {
    Some(Vec::with_capacity(words))
}

/// What is read: so many words of a buffer, from one of them on.
pub(super) struct Source<'a> {
    pub(super) buffer: &'a Buffer,
    pub(super) first: usize,
    pub(super) words: usize,
}

impl<'a> Source<'a> {
    /// From the start of a buffer.
    pub(super) fn new(buffer: &'a Buffer, words: usize) -> Self {
        Self { buffer, first: 0, words }
    }
}

/// Words that are on their way.
pub(super) struct Coming<'a> {
    gpu: &'a Device,
    staging: Buffer,
    word: Word,
    receiver: oneshot::Receiver<Result<(), wgpu::BufferAsyncError>>,
    places: Vec<Range<u64>>,
}

impl<'a> Coming<'a> {
    /// Waits for them.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn landed(self) -> Result<Landed<'a>, Error> {
        let Self { gpu, staging, word, receiver, places } = self;
        gpu.judge(word.await)?;
        #[cfg(not(target_arch = "wasm32"))]
        gpu.wait().map_err(|_| gpu.not_mapped())?;
        if !matches!(receiver.await, Ok(Ok(()))) {
            return Err(gpu.not_mapped());
        }
        gpu.check()?;
        Ok(Landed { gpu, staging: Some(staging), places })
    }
}

/// Words that have come back, in memory that both sides see, which the next ones get afterwards.
pub(super) struct Landed<'a> {
    pub(super) gpu: &'a Device,
    pub(super) staging: Option<Buffer>,
    /// Where those of each source are, in bytes.
    pub(super) places: Vec<Range<u64>>,
}

impl Drop for Landed<'_> {
    fn drop(&mut self) {
        if let Some(staging) = self.staging.take() {
            staging.unmap();
            self.gpu.read_back.put(staging);
        }
    }
}

impl Landed<'_> {
    /// The words of the source of this index.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) fn words(&self, source: usize) -> Result<Vec<u32>, Error> {
        let mut words = Vec::new();
        self.append(source, &mut words).map(|()| words)
    }

    /// Puts the words of a source into room for them.
    ///
    /// # Errors
    /// [`Error::Device`].
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn fill(&self, source: usize, mut room: Words) -> Result<Words, Error> {
        self.append(source, &mut room).map(|()| room)
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn append(&self, source: usize, result: &mut Vec<u32>) -> Result<(), Error> {
        let place = self.places[source].clone();
        let Some(staging) = self.staging.as_ref().filter(|_| !place.is_empty()) else { return Ok(()) };
        let view = staging.get_mapped_range(place).map_err(|_| self.gpu.not_mapped())?;
        Threads::default().append(result, bytemuck::cast_slice(&view));
        Ok(())
    }
}

impl Device {
    /// Reads `words` words from the start of `buffer`.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn read(&self, buffer: &Buffer, words: usize) -> Result<Vec<u32>, Error> {
        let mut result = Vec::new();
        if words > CHUNK {
            result.reserve_exact(words);
        }
        while result.len() < words {
            let first = result.len();
            let source = Source { buffer, first, words: (words - first).min(CHUNK) };
            let nothing = || self.device.create_command_encoder(&Default::default());
            self.submit_and_read(&nothing, &[source]).await?.append(0, &mut result)?;
        }
        Ok(result)
    }

    /// Why memory is not mapped: mostly the device has said so.
    pub(super) fn not_mapped(&self) -> Error {
        let message = || "memory could not be mapped".to_owned();
        self.check().err().unwrap_or_else(|| Error::Device { message: message() })
    }

    /// Submits commands.
    pub(super) fn submit(&self, encoder: wgpu::CommandEncoder) {
        self.queue.submit([encoder.finish()]);
        #[cfg(test)]
        self.asked.submissions.fetch_add(1, Relaxed);
    }

    /// Submits the commands that `record` makes, and reads the sources behind them: all of it at once.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn submit_and_read(
        &self,
        record: &dyn Fn() -> wgpu::CommandEncoder,
        sources: &[Source<'_>],
    ) -> Result<Landed<'_>, Error> {
        self.submit_and_map(record, sources).landed().await
    }

    /// The same, without a wait.
    pub(super) fn submit_and_map(
        &self,
        record: &dyn Fn() -> wgpu::CommandEncoder,
        sources: &[Source<'_>],
    ) -> Coming<'_> {
        let mut end = 0;
        let place = |source: &Source<'_>| {
            // A view begins at a multiple of eight bytes.
            let begin = u64::next_multiple_of(end, 8);
            end = begin + 4 * source.words as u64;
            begin..end
        };
        let places: Vec<_> = sources.iter().map(place).collect();
        let (sender, receiver) = oneshot::channel();
        let submit = || {
            let new = || self.staging(end, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
            let staging = self.read_back.take(end).unwrap_or_else(new);
            let mut encoder = record();
            for (Source { buffer, first, words }, place) in sources.iter().zip(&places) {
                let size = 4 * *words as u64;
                encoder.copy_buffer_to_buffer(buffer, 4 * *first as u64, &staging, place.start, size);
            }
            self.submit(encoder);
            staging.map_async(wgpu::MapMode::Read, ..end.max(4), move |result| {
                // The receiver is gone only if the caller has given up waiting.
                let _ = sender.send(result);
            });
            #[cfg(test)]
            self.asked.maps.fetch_add(1, Relaxed);
            staging
        };
        let (staging, word) = watch(&self.device, submit);
        Coming { gpu: self, staging, word, receiver, places }
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn wait(&self) -> Result<wgpu::PollStatus, wgpu::PollError> {
        self.device.poll(wgpu::PollType::wait_indefinitely())
    }

    /// Waits for the copies of all that was written, where that can be waited for.
    pub(super) fn finish_copies(&self) {
        #[cfg(not(target_arch = "wasm32"))]
        {
            self.queue.submit([]);
            // A failure is told by the next call that can fail.
            let _ = self.wait();
        }
    }

    /// Writes words to the starts of buffers, before the next submission.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn write_all(&self, writes: &[(&Buffer, &[u32])]) {
        writes.iter().for_each(|(buffer, words)| self.write(buffer, words));
    }

    /// Writes words to the start of `buffer`, before the next submission.
    pub(super) fn write(&self, buffer: &Buffer, words: &[u32]) {
        for (i, chunk) in words.chunks(CHUNK).enumerate() {
            let place = 4 * (i * CHUNK) as u64;
            self.stage(buffer, place, chunk);
            if chunk.len() == CHUNK {
                self.finish_copies();
            }
        }
    }

    /// Copies words by several threads; the next submission takes them to their place.
    #[cfg(not(target_arch = "wasm32"))]
    fn stage(&self, buffer: &Buffer, place: u64, words: &[u32]) {
        let size = wgpu::BufferSize::new(size_of_val(words) as u64);
        // Where there is none, wgpu has told the error.
        let Some(mut view) = size.and_then(|size| self.queue.write_buffer_with(buffer, place, size)) else {
            return;
        };
        let (pieces, mut rest) = view.slice(..).into_chunks::<{ 4 * PIECE }>();
        let (whole, others) = words.as_chunks::<PIECE>();
        rest.copy_from_slice(bytemuck::cast_slice(others));
        let pieces: Vec<_> = whole.iter().zip(pieces).collect();
        Threads::default().map_each(pieces, |(words, copy)| {
            wgpu::WriteOnly::<[u8]>::from(copy).copy_from_slice(bytemuck::cast_slice(words));
        });
    }
}
