//! Updates: the vertices move, and the device flips again, in one submission that nobody waits for.

use super::WebGpu;
use super::faults::{refuse, watch};
use super::history::{COUNTS, ENTRIES, FLIPPED};
use super::kernels::Kernel;
use crate::engine::gpu::upload::deviation_words;
use crate::engine::{Answer, Moved, positions_of};
use crate::{Error, Positions};
use wgpu::BufferUsages;

/// A multiple of this number of words is an offset that every device accepts for a binding.
const OFFSET_WORDS: u32 = 64;

fn bytes(words: usize) -> u64 {
    4 * words as u64
}

impl WebGpu {
    /// Submits the preparation for the present positions, and iterations after it. `positions` replaces them first.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] if the shaders read fixed-point numbers, or for 64-bit floats; [`Error::Device`].
    pub(super) fn submit_update(
        &mut self,
        positions: Option<Positions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), Error> {
        self.gpu.check()?;
        let numbers = match (&positions, self.form.is_fixed) {
            (None, false) => None,
            (Some(Positions::F32(numbers)), false) => Some(numbers),
            _ => return refuse("an update takes 32-bit floats that span few bits".to_owned()),
        };
        if self.unsettled.is_some() {
            return refuse("an update begins only after the start of the session has ended".to_owned());
        }
        // Who draws from the device does not read the triangles: no memory waits for them.
        (self.known, self.input, self.reserved) = (super::Known::default(), None, None);
        if self.params.update == 0 {
            self.params.first = 0;
        }
        self.params.update = self.params.update.wrapping_add(1).max(1);
        self.params.winding = self.winding;
        self.params.deviation = deviation_words(self.thresholds.deviation.into(), None);
        self.params.untangles = untangles.into();
        let caught = self.submit_frame(&|this| {
            if let Some(numbers) = numbers {
                this.gpu.write(&this.buffers.positions, bytemuck::cast_slice(numbers));
            }
            let mut encoder = this.gpu.device.create_command_encoder(&Default::default());
            this.record_preparation(&mut encoder);
            this.encode_pass(&mut encoder, &|pass| {
                this.record_iterations(pass, iterations, None);
            });
            this.record_walks(&mut encoder);
            encoder
        });
        self.gpu.keep_watch(caught);
        self.params.first = self.params.first.wrapping_add(iterations);
        self.dispatches += (Kernel::preparation(self.form.dimension).len() + 4 * iterations as usize) as u64;
        self.dispatches += self.walk_dispatches();
        Ok(())
    }

    /// Counts on the device, after all updates so far. The counts are copied at once, so updates may follow before the
    /// answer is there.
    pub(super) fn count_moved(&mut self) -> Answer<'static, Moved> {
        let gpu = self.gpu.clone();
        let (snapshot, caught) = watch(&gpu.device, || {
            let snapshot = gpu.buffer("counters", ENTRIES, BufferUsages::empty());
            let history = &self.buffers.history;
            self.write_params();
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            self.encode_counts(&mut encoder, &|pass| self.record_counts(pass));
            encoder.copy_buffer_to_buffer(history, 0, &snapshot, 0, bytes(ENTRIES));
            gpu.submit(encoder.finish());
            snapshot
        });
        Box::pin(async move {
            // The device has told the faults of earlier updates by then.
            gpu.judge(caught.await)?;
            let words = gpu.read(&snapshot, ENTRIES).await?;
            Ok(Moved::of_counts(&[&words[..COUNTS], &words[FLIPPED..]].concat()))
        })
    }

    /// The changes begin at an offset that every device accepts for a binding.
    pub(super) async fn begin_changes(&mut self) -> Result<(), Error> {
        // The table of the fans, if there is one, comes first.
        self.settle().await?;
        // Never 0, which stands for no changes.
        let first = (self.topology_words + 1).next_multiple_of(OFFSET_WORDS);
        let length = first - self.topology_words + self.params.triangles;
        self.append_to_topology(&vec![0; length as usize]).await?;
        self.params.changes = first;
        Ok(())
    }

    /// The offset of the changes in the topology, in bytes, if they are tracked.
    pub(super) fn changes_offset(&self) -> Option<u64> {
        let offset = u64::from(self.params.changes);
        (offset > 0).then_some(4 * offset)
    }

    pub(super) async fn read_changes(&mut self) -> Result<Vec<u32>, Error> {
        if self.params.changes == 0 {
            return Ok(Vec::new());
        }
        let mut words = self.gpu.read(&self.buffers.topology, self.topology_words as usize).await?;
        let mut changes = words.split_off(self.params.changes as usize);
        changes.truncate(self.params.triangles as usize);
        Ok(changes)
    }

    pub(super) async fn read_positions(&mut self) -> Result<Positions, Error> {
        let count = self.params.vertices as usize * self.form.dimension.stride();
        let words =
            self.gpu.read(self.buffers.floats.as_ref().unwrap_or(&self.buffers.positions), count).await?;
        Ok(positions_of(words))
    }
}
