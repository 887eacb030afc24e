//! Runs iterations, and reads results in the same submission.

use super::WebGpu;
use super::adjacency::COUNTERS;
use super::buffer::Buffer;
use super::buffers::Buffers;
use super::copies::{CHUNK, PendingRead, Source, memory_for};
use super::device::MOST_WORKGROUPS;
use super::history::{AREAS, BATCH, COUNTS, ENTRIES, ENTRY_WORDS, HISTORY_WORDS, SHORT_TAIL, TAIL};
use super::kernels::Kernel;
use super::known::Known;
use super::programs::SLICE;
use super::steps::Step;
use super::walks;
use super::words::{Reserved, Words, put, reserve_ahead};
use crate::Error;
use crate::engine::{Answer, Census};
use crate::mesh::areas::Areas;

/// Dispatches of the tail: it may pause once for exact arithmetic.
const TAIL_DISPATCHES: u32 = 3;
pub(super) const IS_NATIVE: bool = cfg!(not(target_arch = "wasm32"));
/// The most workgroups of exact arithmetic: enough for a large GPU. On drivers that end loops too early, each workgroup
/// decides one slice.
const MOST_DECIDING: u32 = 1024;
/// A software GPU takes long to begin a workgroup with barriers.
const MOST_OF_SOFTWARE: u32 = 16;
/// So many keep the indices in `decide.wgsl` below 2^32, and suffice for 16 million triangles.
const MOST_SLICES: u32 = 1 << 21;
/// Dispatches of the counts.
const COUNT_DISPATCHES: u64 = 4;

impl WebGpu {
    pub(super) async fn run(&mut self, count: u32) -> Result<Vec<u32>, Error> {
        #[cfg(feature = "baseline")]
        if super::baseline::is_on() {
            return self.run_selecting_on_cpu(count).await;
        }
        let mut flips = Vec::new();
        // The first word of the state: the flips of the last iteration.
        while self.state[0] > 0 && (flips.len() as u32) < count {
            let may_wait = self.unsettled.is_some();
            let ran = self.submit_iterations(count - flips.len() as u32).await?;
            if ran.is_empty() && !may_wait {
                return Err(Error::Device { message: "the device ran no iteration".to_owned() });
            }
            flips.extend(ran);
            if flips.last() == Some(&0) {
                flips.pop();
                break;
            }
        }
        Ok(flips)
    }

    /// Submits up to `count` iterations at once. Returns the flips of those that ran; the last number may be zero.
    /// Returns an empty list if the device needed fans or windings from the host before it could run; the host has then
    /// added them.
    async fn submit_iterations(&mut self, count: u32) -> Result<Vec<u32>, Error> {
        self.known = Known::default();
        let batch = count.min(self.longest_batch());
        self.params.tail = batch;
        let longest = if self.gpu.ends_loops_early { SHORT_TAIL } else { TAIL };
        let tail = self.kernels.tail.get();
        self.params.tail_iterations = if tail.is_some() { (count - batch).min(longest) } else { 0 };
        self.dispatches += u64::from(4 * batch + TAIL_DISPATCHES * self.params.tail_iterations.min(1));
        self.dispatches += self.walk_dispatches();
        // The counts of a run's end follow at once, so that nobody has to wait for them later.
        let ends = !self.waits || (IS_NATIVE && count > 1 && self.ends_within(batch));
        if ends {
            self.dispatches += COUNT_DISPATCHES;
        }
        let iterate = |pass: &mut wgpu::ComputePass| self.record_iterations(pass, batch, tail);
        let record = || {
            if self.unsettled.is_none() {
                self.begin_history();
            }
            let mut encoder = self.encode(&iterate);
            self.record_walks(&mut encoder);
            if !self.waits {
                self.encode_counts(&mut encoder, &|pass| self.record_counts(pass));
            }
            encoder
        };
        let triangles = 3 * self.params.triangles as usize;
        let mut sources = vec![
            Source::new(&self.buffers.history, HISTORY_WORDS),
            Source::new(&self.counters, COUNTERS + 1),
        ];
        // Most runs end in their first submission, so the triangles are read with it, unless they stay.
        let is_run = self.params.first == 0 && count > 1 && !self.stays;
        let has_triangles = !self.waits && is_run;
        let first = triangles.min(CHUNK);
        if has_triangles {
            sources.push(Source::new(&self.buffers.triangles, first));
        }
        let gpu = self.gpu.clone();
        let pending = gpu.submit_and_map(&record, &sources);
        let counting = (self.waits && ends).then(|| self.begin_counts(&|pass| self.record_counts(pass)));
        let rest = if has_triangles { first..triangles } else { 0..0 };
        let rest = gpu.begin_read(&self.buffers.triangles, rest);
        if is_run {
            self.reserved.get_or_insert_with(|| reserve_ahead(triangles));
        }
        self.check_allocation().await?;
        let read = pending.finished(&gpu).await?;
        let history = read.words(0)?;
        if let Some(mesh) = self.unsettled.clone() {
            let counters = read.words(1)?;
            if self.settle_by(&mesh, &counters).await? {
                return Ok(Vec::new());
            }
        }
        self.known.counting = counting;
        if !self.waits {
            self.known.counts = Some(counts_of(&history));
        }
        if has_triangles && let Ok(mut triangles) = memory_for(triangles, self.reserved.take()).await {
            read.fill(2, &mut triangles, 0)?;
            rest.fill(&mut triangles, first).await?;
            self.known.triangles = Some(triangles);
        }
        if IS_NATIVE && count >= BATCH {
            self.gpu.batches.learn(self.form, &self.params, &history);
        }
        Ok(self.take_over(&history))
    }

    /// The most iterations with a dispatch for each phase in the next submission. A run gets as many as the last one of
    /// its kind needed, and if it needs more, a second submission. In a browser that would take too long.
    fn longest_batch(&self) -> u32 {
        if IS_NATIVE && self.params.first == 0 {
            self.gpu.batches.first(self.form, self.params.triangles)
        } else {
            BATCH
        }
    }

    /// Whether the run will probably end in a submission with this batch, as the last run of its kind did.
    fn ends_within(&self, batch: u32) -> bool {
        self.gpu.batches.needed(self.form, self.params.triangles) <= self.params.first + batch
    }

    /// Reads a buffer that has one word per half-edge.
    pub(super) fn read(
        &mut self,
        of: fn(&Buffers) -> &Buffer,
        reserved: Option<Reserved>,
    ) -> Answer<'_, Words> {
        Box::pin(async move {
            self.check_allocation().await?;
            let words = 3 * self.params.triangles as usize;
            self.gpu.read_array(of(&self.buffers), words, reserved).await
        })
    }

    /// The triangles, read from the device unless the last submission has read them. Natively, those of the input if no
    /// edge has flipped.
    pub(super) fn known_triangles(&mut self) -> Answer<'_, Words> {
        if let Some(triangles) = self.known.triangles.take() {
            return Box::pin(std::future::ready(Ok(triangles)));
        }
        let reserved = self.reserved.take();
        if IS_NATIVE && let Some(input) = self.input.clone() {
            return Box::pin(async move {
                self.check_allocation().await?;
                self.gpu.check_loss().await?;
                let mut result = memory_for(input.triangles().len(), reserved).await?;
                put(&mut result, 0, input.triangles());
                Ok(result)
            });
        }
        self.read(|buffers| &buffers.triangles, reserved)
    }

    /// Counts the edges and the areas, unless that was done.
    pub(super) async fn count(&mut self) -> Result<(Census, Areas), Error> {
        self.settle().await?;
        if let Some(counts) = self.known.counts {
            return Ok(counts);
        }
        let counting = self.known.counting.take().unwrap_or_else(|| {
            self.dispatches += COUNT_DISPATCHES;
            self.begin_counts(&|pass| self.record_counts(pass))
        });
        let counts = counts_of(&counting.finished(&self.gpu).await?.words(0)?);
        self.known.counts = Some(counts);
        Ok(counts)
    }

    /// Submits kernels that count.
    pub(super) fn begin_counts(&self, record: &dyn Fn(&mut wgpu::ComputePass)) -> PendingRead {
        let commands = || {
            self.write_params();
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            self.encode_counts(&mut encoder, record);
            encoder
        };
        self.gpu.submit_and_map(&commands, &[Source::new(&self.buffers.history, COUNTS)])
    }

    /// Writes the state as the first entry of the history, and zeros after it.
    pub(super) fn begin_history(&self) {
        let mut history = [0u32; HISTORY_WORDS];
        history[ENTRIES..ENTRIES + ENTRY_WORDS].copy_from_slice(&self.state);
        self.gpu.queue.write_buffer(&self.buffers.history, 0, bytemuck::cast_slice(&history));
    }

    /// Submits commands that continue the history, and reads it.
    #[cfg(any(test, feature = "baseline"))]
    pub(super) async fn read_history(
        &self,
        record: &dyn Fn(&mut wgpu::ComputePass),
    ) -> Result<Vec<u32>, Error> {
        let commands = || {
            self.begin_history();
            self.encode(record)
        };
        let history = Source::new(&self.buffers.history, HISTORY_WORDS);
        self.gpu.submit_and_read(&commands, &[history]).await?.words(0)
    }

    /// Takes over the last state in the history, and returns the flips of the iterations that ran.
    pub(super) fn take_over(&mut self, history: &[u32]) -> Vec<u32> {
        let entries = history[ENTRIES..].chunks_exact(ENTRY_WORDS).skip(1);
        let ran: Vec<&[u32]> = entries.take_while(|entry| entry[3] == 1).collect();
        if IS_NATIVE && ran.iter().any(|entry| entry[0] > 0) {
            self.input = None;
        }
        if let Some(last) = ran.last() {
            self.state.copy_from_slice(last);
        }
        self.params.first += ran.len() as u32;
        ran.iter().map(|entry| entry[0]).collect()
    }

    /// Encodes one compute pass, with the present parameters and the first step bound.
    pub(super) fn encode(&self, record: &dyn Fn(&mut wgpu::ComputePass)) -> wgpu::CommandEncoder {
        self.write_params();
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        self.encode_pass(&mut encoder, record);
        encoder
    }

    pub(super) fn encode_pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        record: &dyn Fn(&mut wgpu::ComputePass),
    ) {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_bind_group(0, &self.bindings, &[0]);
        record(&mut pass);
    }

    pub(super) fn write_params(&self) {
        let (offset, bytes) = self.params.of_host();
        self.gpu.queue.write_buffer(&self.buffers.uniform, offset, bytes);
    }

    pub(super) fn at_step(&self, pass: &mut wgpu::ComputePass, step: Step) {
        pass.set_bind_group(0, &self.bindings, &[step.offset()]);
    }

    /// Dispatches a kernel for `triangles` triangles.
    pub(super) fn dispatch(&self, pass: &mut wgpu::ComputePass, kernel: Kernel, triangles: u32) {
        pass.set_pipeline(&self.kernels.pipelines[kernel as usize]);
        if kernel != Kernel::Decide {
            return pass.dispatch_workgroups(self.gpu.workgroups(triangles), 1, 1);
        }
        let most = match (self.gpu.ends_loops_early, self.gpu.is_software) {
            (true, _) => MOST_SLICES,
            (false, true) => MOST_OF_SOFTWARE,
            (false, false) => MOST_DECIDING,
        };
        let groups = triangles.div_ceil(SLICE).clamp(1, most);
        pass.dispatch_workgroups(groups.min(MOST_WORKGROUPS), groups.div_ceil(MOST_WORKGROUPS), 1);
    }

    pub(super) fn record_iterations(
        &self,
        pass: &mut wgpu::ComputePass,
        batch: u32,
        tail: Option<&wgpu::ComputePipeline>,
    ) {
        for index in 0..batch {
            self.at_step(pass, Step::Iterate(index));
            for kernel in Kernel::ITERATION {
                self.dispatch(pass, kernel, self.params.triangles);
            }
        }
        if let Some(tail) = tail.filter(|_| self.params.tail_iterations > 0) {
            let dispatch = |pass: &mut wgpu::ComputePass| {
                pass.set_pipeline(tail);
                pass.dispatch_workgroups(1, 1, 1);
            };
            dispatch(pass);
            self.at_step(pass, Step::Resume);
            self.dispatch(pass, Kernel::Decide, self.params.tail_length);
            dispatch(pass);
        }
    }

    /// Records the kernels that write the adjacency of the present triangles, if somebody asks for it.
    pub(super) fn record_walks(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(walks) = &self.walks {
            let counts = [3 * self.params.triangles, self.params.vertices];
            walks.record(&self.gpu, counts, encoder);
        }
    }

    /// How many dispatches that are.
    pub(super) fn walk_dispatches(&self) -> u64 {
        self.walks.as_ref().map_or(0, |_| walks::DISPATCHES)
    }

    /// Encodes kernels that count, with zeros before them.
    pub(super) fn encode_counts(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        record: &dyn Fn(&mut wgpu::ComputePass),
    ) {
        encoder.clear_buffer(&self.buffers.history, 0, Some(4 * COUNTS as u64));
        self.encode_pass(encoder, record);
    }

    pub(super) fn record_counts(&self, pass: &mut wgpu::ComputePass) {
        for (step, kernel) in
            [(Step::Census, Kernel::Census), (Step::Census, Kernel::Decide), (Step::Resume, Kernel::Census)]
        {
            self.at_step(pass, step);
            self.dispatch(pass, kernel, self.params.triangles);
        }
        self.dispatch(pass, Kernel::Areas, self.params.triangles);
    }
}

fn counts_of(history: &[u32]) -> (Census, Areas) {
    (Census::of_counts(history), Areas::of_counts(&history[AREAS..]))
}
