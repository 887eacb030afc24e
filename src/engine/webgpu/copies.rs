//! Copies to a device, and back.

use super::buffer::Buffer;
use super::device::Device;
use super::faults::{Caught, watch};
#[cfg(not(target_arch = "wasm32"))]
use super::words::put;
use super::words::{Reserved, Words, reserve, vector};
use crate::Error;
use crate::engine::Answer;
#[cfg(not(target_arch = "wasm32"))]
use crate::system::threads::Threads;
use futures_channel::oneshot;
use std::future::ready;
use std::ops::Range;
#[cfg(test)]
use std::sync::atomic::Ordering::Relaxed;
#[cfg(not(target_arch = "wasm32"))]
use std::time::{Duration, Instant};
use wgpu::BufferUsages;

/// The most words of one copy to the device, or from it. Longer arrays go in several copies through the same staging
/// memory, which is far faster than new memory. In a browser each copy goes through two processes, and the second begins
/// when the first has finished: shorter copies overlap more.
pub(super) const CHUNK: usize = if cfg!(target_arch = "wasm32") { 1 << 20 } else { 1 << 22 };

/// Natively, the fewest words that begin to travel to the device before the host copies the next.
#[cfg(not(target_arch = "wasm32"))]
const FEWEST_SUBMITTED: usize = 1 << 18;

/// Copies that the device makes while the host takes one.
const AHEAD: usize = if cfg!(target_arch = "wasm32") { 4 } else { 2 };

/// How long the host polls the device before it sleeps. Many submissions end sooner than a thread wakes up.
#[cfg(not(target_arch = "wasm32"))]
const AWAKE: Duration = Duration::from_micros(300);

/// Words that one thread copies without a break.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const PIECE: usize = 1 << 16;

/// Words for a buffer, from a word of it on.
pub(super) type Write<'a> = (&'a Buffer, usize, &'a [u32]);

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

/// The answer to a request to map a buffer.
type Mapped = Result<(), wgpu::BufferAsyncError>;

/// A read that the device has not finished.
pub(super) struct PendingRead {
    staging: Buffer,
    caught: Caught,
    receiver: oneshot::Receiver<Mapped>,
    submission: wgpu::SubmissionIndex,
    ranges: Vec<Range<u64>>,
}

impl PendingRead {
    /// The faults of the submission, for others to wait for.
    pub(super) fn take_caught(&mut self) -> Caught {
        std::mem::replace(&mut self.caught, Box::pin(ready(None)))
    }

    /// The words of the first source, or none if it has failed; the read itself, if it has not ended.
    pub(super) fn ended(mut self, gpu: &Device) -> Result<Option<Vec<u32>>, Self> {
        match self.receiver.try_recv() {
            Ok(None) => Err(self),
            Ok(Some(Ok(()))) => {
                let back = ReadBack { gpu, staging: Some(self.staging), ranges: self.ranges };
                Ok(back.words(0).ok())
            }
            _ => Ok(None),
        }
    }

    /// Waits for the device.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn finished(mut self, gpu: &Device) -> Result<ReadBack<'_>, Error> {
        gpu.judge(self.caught.await)?;
        let mapped = match gpu.wait(self.submission, &mut self.receiver)? {
            Some(mapped) => Ok(mapped),
            None => self.receiver.await,
        };
        if !matches!(mapped, Ok(Ok(()))) {
            return Err(gpu.not_mapped());
        }
        gpu.check()?;
        Ok(ReadBack { gpu, staging: Some(self.staging), ranges: self.ranges })
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
        self.fill(source, &mut words, 0).map(|()| words)
    }

    /// Copies the words of a source behind the first `taken` words, which `result` has.
    ///
    /// # Errors
    /// [`Error::Device`].
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn fill(&self, source: usize, result: &mut Words, taken: usize) -> Result<(), Error> {
        let range = self.ranges[source].clone();
        let Some(staging) = self.staging.as_ref().filter(|_| !range.is_empty()) else { return Ok(()) };
        let view = staging.get_mapped_range(range).map_err(|_| self.gpu.not_mapped())?;
        put(result, taken, bytemuck::cast_slice(&view));
        Ok(())
    }
}

/// A read of a long array, in pieces. The device copies the next pieces while the host takes one.
pub(super) struct LongRead<'a> {
    gpu: &'a Device,
    buffer: wgpu::Buffer,
    rest: Range<usize>,
    /// At most [`AHEAD`], in the order of the words.
    pending: Vec<PendingRead>,
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
            let piece = self.pending.remove(0).finished(self.gpu).await?;
            self.advance();
            piece.fill(0, result, taken)?;
            taken += CHUNK;
        }
        Ok(())
    }
}

/// Memory for words: the reserved memory, or other.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(super) async fn memory_for(words: usize, reserved: Option<Reserved>) -> Result<Words, Error> {
    let memory = match reserved {
        Some(reserved) => reserved.await,
        None => None,
    };
    memory.or_else(|| reserve(words)).ok_or(Error::OutOfMemory { bytes: 4 * words as u64, limit: None })
}

impl Device {
    /// Reads `words` words from the start of `buffer`.
    ///
    /// # Errors
    /// [`Error::Device`]; [`Error::OutOfMemory`].
    pub(super) fn read(&self, buffer: &wgpu::Buffer, words: usize) -> Answer<'_, Vec<u32>> {
        let read = self.read_array(buffer, words, None);
        Box::pin(async { read.await.map(vector) })
    }

    /// The same, into an array of the host, in the reserved memory if there is any.
    ///
    /// # Errors
    /// [`Error::Device`]; [`Error::OutOfMemory`].
    pub(super) fn read_array(
        &self,
        buffer: &wgpu::Buffer,
        words: usize,
        reserved: Option<Reserved>,
    ) -> Answer<'_, Words> {
        let read = self.begin_read(buffer, 0..words);
        Box::pin(async move {
            let mut result = memory_for(words, reserved).await?;
            read.fill(&mut result, 0).await.map(|()| result)
        })
    }

    /// Begins to read some words of `buffer`.
    pub(super) fn begin_read(&self, buffer: &wgpu::Buffer, words: Range<usize>) -> LongRead<'_> {
        let mut read = LongRead { gpu: self, buffer: buffer.clone(), rest: words, pending: Vec::new() };
        read.advance();
        read
    }

    /// As [`Device::check`], also for a device of the caller.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn check_loss(&self) -> Result<(), Error> {
        #[cfg(not(target_arch = "wasm32"))]
        if self.given.is_some() {
            let descriptor = wgpu::BufferDescriptor {
                label: Some("check"),
                size: 4,
                usage: BufferUsages::MAP_WRITE,
                mapped_at_creation: true,
            };
            let map = || Buffer::new(self.device.create_buffer(&descriptor)).get_mapped_range(..).is_ok();
            if !self.checked(map).await? {
                return Err(self.not_mapped());
            }
        }
        self.check()
    }

    /// Why a buffer is not mapped: the first error of the device. A device of the caller, which is lost, tells of that
    /// in no other way.
    pub(super) fn not_mapped(&self) -> Error {
        self.report("the driver did not map a staging buffer".to_owned())
    }

    /// Submits commands.
    pub(super) fn submit(&self, commands: wgpu::CommandBuffer) -> wgpu::SubmissionIndex {
        #[cfg(test)]
        self.asked.submissions.fetch_add(1, Relaxed);
        self.queue.submit([commands])
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
        self.submit_and_map(record, sources).finished(self).await
    }

    /// The same, without the wait.
    pub(super) fn submit_and_map(
        &self,
        record: &dyn Fn() -> wgpu::CommandEncoder,
        sources: &[Source<'_>],
    ) -> PendingRead {
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
            let submission = self.submit(encoder.finish());
            staging.map_async(wgpu::MapMode::Read, ..end.max(4), move |result| {
                // The receiver is gone only if the caller has stopped waiting.
                let _ = sender.send(result);
            });
            #[cfg(test)]
            self.asked.maps.fetch_add(1, Relaxed);
            (staging, submission)
        };
        let ((staging, submission), caught) = watch(&self.device, submit);
        PendingRead { staging, caught, receiver, submission, ranges }
    }

    /// Natively, waits for the answer to a request to map a buffer, made after a submission. If another thread that polls
    /// the device is about to answer, the result is `None`.
    ///
    /// # Errors
    /// [`Error::Device`].
    #[cfg(not(target_arch = "wasm32"))]
    fn wait(
        &self,
        submission: wgpu::SubmissionIndex,
        receiver: &mut oneshot::Receiver<Mapped>,
    ) -> Result<Option<Mapped>, Error> {
        let mut mapped = None;
        let mut is_done = |_| {
            mapped = receiver.try_recv().ok().flatten();
            mapped.is_some()
        };
        if !self.poll_awake(&mut is_done) {
            is_done(self.finish(submission).map_err(|_| self.not_mapped())?);
        }
        Ok(mapped)
    }

    #[cfg(target_arch = "wasm32")]
    fn wait(
        &self,
        _: wgpu::SubmissionIndex,
        _: &mut oneshot::Receiver<Mapped>,
    ) -> Result<Option<Mapped>, Error> {
        Ok(None)
    }

    /// Polls the device for a short time without sleeping, until `is_done`. Returns whether it is.
    #[cfg(not(target_arch = "wasm32"))]
    fn poll_awake(&self, mut is_done: impl FnMut(wgpu::PollStatus) -> bool) -> bool {
        let begin = Instant::now();
        while begin.elapsed() < AWAKE {
            if self.device.poll(wgpu::PollType::Poll).is_ok_and(&mut is_done) {
                return true;
            }
            std::hint::spin_loop();
        }
        false
    }

    /// Waits for a submission.
    #[cfg(not(target_arch = "wasm32"))]
    fn finish(&self, submission: wgpu::SubmissionIndex) -> Result<wgpu::PollStatus, wgpu::PollError> {
        self.device.poll(wgpu::PollType::Wait { submission_index: Some(submission), timeout: None })
    }

    /// Waits for copies to the device. If this fails, the next call that can return an error reports it.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn finish_copies(&self, submission: wgpu::SubmissionIndex) {
        if !self.poll_awake(|status| status.is_queue_empty()) {
            let _ = self.finish(submission);
        }
    }

    /// Writes words to the start of `buffer`, before the next submission.
    pub(super) fn write(&self, buffer: &Buffer, words: &[u32]) {
        self.write_all(&[(buffer, 0, words)]);
    }

    /// Writes the arrays of a new mesh. Returns the faults.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) async fn upload(&self, writes: &[Write<'_>]) -> Vec<Caught> {
        vec![watch(&self.device, || self.write_all(writes)).1]
    }

    /// Writes words before the next submission, in chunks. While the last chunk travels to the device, the host copies
    /// the next one to other staging memory.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn write_all(&self, writes: &[Write<'_>]) {
        let mut travelling = None;
        for (buffer, first, words) in writes {
            for (i, chunk) in words.chunks(CHUNK).enumerate() {
                self.stage(buffer, 4 * (first + i * CHUNK) as u64, chunk);
                if chunk.len() >= FEWEST_SUBMITTED
                    && let Some(before) = travelling.replace(self.queue.submit([]))
                {
                    // The next call that can return an error reports a failure.
                    let _ = self.finish(before);
                }
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
