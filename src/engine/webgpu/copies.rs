//! What goes to a device, and comes back.

use super::device::{Buffer, Device};
use super::faults::{Word, watch};
use crate::Error;
use crate::threads::Threads;
use futures_channel::oneshot;
use wgpu::BufferUsages;

/// Words that are copied to the device, or from it, at a time: the memory between them is used again, which is far
/// faster than more of it would be.
pub(super) const CHUNK: usize = 1 << 22;

/// Words that one thread copies at a time.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const PIECE: usize = 1 << 16;

impl Device {
    /// Reads `words` words from the start of `buffer`.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn read(&self, buffer: &Buffer, words: usize) -> Result<Vec<u32>, Error> {
        let nothing = || self.device.create_command_encoder(&Default::default());
        self.submit_and_read(&nothing, buffer, words).await
    }

    /// Submits the commands that `record` makes, and reads `words` words from the start of `buffer` behind them.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn submit_and_read(
        &self,
        record: &dyn Fn() -> wgpu::CommandEncoder,
        buffer: &Buffer,
        words: usize,
    ) -> Result<Vec<u32>, Error> {
        let mut result = Vec::with_capacity(words);
        let mut record = Some(record);
        // A first chunk there is always, for the sake of the commands.
        while record.is_some() || result.len() < words {
            let first = result.len();
            let chunk = (words - first).min(CHUNK);
            let (sender, receiver) = oneshot::channel();
            let submit = || {
                let staging = Buffer(self.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("read-back"),
                    size: 4 * chunk.max(1) as u64,
                    usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                }));
                let mut encoder = match record.take() {
                    Some(record) => record(),
                    None => self.device.create_command_encoder(&Default::default()),
                };
                encoder.copy_buffer_to_buffer(buffer, 4 * first as u64, &staging, 0, 4 * chunk as u64);
                self.queue.submit([encoder.finish()]);
                staging.map_async(wgpu::MapMode::Read, .., move |result| {
                    // The receiver is gone only if the caller has given up waiting.
                    let _ = sender.send(result);
                });
                staging
            };
            let (staging, word) = watch(&self.device, submit);
            self.read_back(staging, word, receiver, &mut result).await?;
            result.truncate(first + chunk);
        }
        Ok(result)
    }

    /// Appends the words of a buffer to `result`.
    async fn read_back(
        &self,
        staging: Buffer,
        word: Word,
        receiver: oneshot::Receiver<Result<(), wgpu::BufferAsyncError>>,
        result: &mut Vec<u32>,
    ) -> Result<(), Error> {
        self.judge(word.await)?;
        let failed = |error: &dyn std::fmt::Display| {
            self.check().err().unwrap_or_else(|| Error::Device { message: error.to_string() })
        };
        #[cfg(not(target_arch = "wasm32"))]
        self.wait().map_err(|error| failed(&error))?;
        receiver.await.map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        self.check()?;
        let view = staging.get_mapped_range(..).map_err(|error| failed(&error))?;
        match bytemuck::try_cast_slice(&view) {
            Ok(words) => Threads::default().append(result, words),
            // The browser's view need not be aligned.
            Err(_) => result.extend(bytemuck::pod_collect_to_vec::<u8, u32>(&view)),
        }
        Ok(())
    }

    #[cfg(not(target_arch = "wasm32"))]
    fn wait(&self) -> Result<wgpu::PollStatus, wgpu::PollError> {
        self.device.poll(wgpu::PollType::wait_indefinitely())
    }

    /// Writes words to the start of `buffer`, before the next submission.
    pub(super) fn write(&self, buffer: &Buffer, words: &[u32]) {
        for (i, chunk) in words.chunks(CHUNK).enumerate() {
            let place = 4 * (i * CHUNK) as u64;
            self.stage(buffer, place, chunk);
            #[cfg(not(target_arch = "wasm32"))]
            if chunk.len() == CHUNK {
                self.queue.submit([]);
                // A failure is told by the next call that can fail.
                let _ = self.wait();
            }
        }
    }

    /// Copies words from where they are; the next submission takes them to their place.
    #[cfg(target_arch = "wasm32")]
    fn stage(&self, buffer: &Buffer, place: u64, words: &[u32]) {
        self.queue.write_buffer(buffer, place, bytemuck::cast_slice(words));
    }

    /// The same by several threads.
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
