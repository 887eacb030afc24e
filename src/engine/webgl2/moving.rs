//! Updates: the host writes new positions, untangles, and the passes of the iterations follow at once. Nobody waits for
//! them.

use super::iteration::{COUNTS, FANS, SELECTIONS, VERDICTS, WebGl, in_fours};
use super::texture::Pair;
use crate::engine::gpu::upload::{deviation_words, may_leave_edges};
use crate::engine::{Answer, Engine};
use crate::phases::state::BLOCKED;
use crate::{Dimension, Error, NONE, Positions};

const TOTALS: u32 = 9;

// Words of the parameters, as in `shaders/webgl2/state.wgsl`.
const ITERATION: usize = 2;
const DEVIATION: usize = 24;
const FIRST: usize = 28;
pub(super) const UPDATE: usize = 29;
const LEAVES: usize = 30;

// Columns of the history after a count.
const CENSUS: u32 = 0;
const MORE: u32 = 1;
const AREAS: u32 = 2;

impl WebGl {
    /// The program that finds the triangles whose area is not positive.
    pub(super) fn areas_program(&self) -> &'static str {
        match (self.form.dimension, self.form.is_fixed) {
            (Dimension::Two, false) => "areas2",
            (Dimension::Two, true) => "areas2_fixed",
            (Dimension::Three, false) => "areas3",
            (Dimension::Three, true) => "areas3_fixed",
        }
    }

    /// Counts for [`Areas::of_counts`](crate::mesh::areas::Areas::of_counts), between two updates and after a run.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`], [`Error::Device`].
    pub(crate) async fn count_areas(&mut self) -> Result<Vec<u32>, Error> {
        if self.winding.is_strict {
            return Ok(vec![0; 3]);
        }
        self.context.compile(&[self.areas_program()]).await?;
        self.write_params();
        self.count_by(self.areas_program(), 0)?;
        self.context.copy(&self.history, 1)?.await
    }

    /// Counts by a program, which gives four counts for each triangle, into a column of the history.
    pub(super) fn count_by(&mut self, program: &'static str, column: u32) -> Result<(), Error> {
        let more = [(VERDICTS, &self.verdicts.front), (FANS, &self.fans.front)];
        let inputs = [&self.mesh()[..], &more].concat();
        // The back texture is free between two iterations.
        self.context.pass(program, &inputs, &self.triangles.back, None)?;
        self.context.pass("sum", &[(COUNTS, &self.triangles.back)], &self.sums[0], None)?;
        self.passes += 2;
        self.sum_up(column)
    }

    /// Compiles the programs of the updates.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`], [`Error::Device`].
    pub(super) async fn settle_updates(&mut self) -> Result<(), Error> {
        if !self.moving.is_settled {
            self.context.compile(&["more", "change", "total", self.areas_program()]).await?;
            self.moving.is_settled = true;
        }
        Ok(())
    }

    /// Begins to keep the update in which each triangle last changed.
    pub(super) fn begin_changes(&mut self) -> Result<(), Error> {
        self.moving.changes = Some(self.context.texture(self.selections.size, 4)?);
        Ok(())
    }

    pub(super) async fn read_changes(&self) -> Result<Vec<u32>, Error> {
        let Some(changes) = &self.moving.changes else { return Ok(Vec::new()) };
        let words = self.context.copy(changes, self.count)?.await?;
        Ok(words.chunks_exact(4).take(self.count).map(|texel| texel[0]).collect())
    }

    /// Submits the passes for the present positions, and iterations after them. `positions` replaces them first. If it
    /// `untangles` a mesh in the plane, it waits for one number.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] if the programs read fixed-point numbers, or for 64-bit floats; [`Error::Device`].
    pub(super) fn submit_update(
        &mut self,
        positions: Option<&Positions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), Error> {
        match (positions, self.form.is_fixed) {
            (None, false) => {}
            (Some(Positions::F32(numbers)), false) => {
                self.params[LEAVES] = may_leave_edges(numbers, self.thresholds.deviation).into();
                self.positions.write(in_texels(bytemuck::cast_slice(numbers), self.form.dimension))?;
            }
            _ => {
                let message = "an update takes 32-bit floats that span few bits".to_owned();
                return Err(Error::BackendLimit { backend: self.backend(), message });
            }
        }
        if self.params[UPDATE] == 0 {
            self.params[ITERATION] = 0;
        }
        let first = self.params[ITERATION];
        self.params[FIRST] = first;
        self.params[UPDATE] = self.params[UPDATE].wrapping_add(1).max(1);
        let deviation = deviation_words(self.thresholds.deviation.into(), None);
        self.params[DEVIATION..DEVIATION + 4].copy_from_slice(&deviation);
        if untangles && self.form.dimension == Dimension::Two {
            self.untangle()?;
        }
        // As after the start, the first iteration tests every triangle.
        self.bests.front.fill(BLOCKED);
        self.selections.fill(NONE);
        self.history.fill(0);
        self.flag_creases()?;
        for column in 0..iterations {
            self.params[ITERATION] = first.wrapping_add(column);
            self.encode_iteration(column)?;
            if let Some(changes) = &self.moving.changes {
                self.context.pass("change", &[(SELECTIONS, &self.selections)], changes, None)?;
                self.passes += 1;
            }
        }
        self.params[ITERATION] = first.wrapping_add(iterations);
        let Pair { front, back } = &self.moving.totals;
        self.context.pass("total", &[(COUNTS, &self.history), (TOTALS, front)], back, None)?;
        self.passes += 1;
        self.moving.totals.swap();
        Ok(())
    }

    /// Counts, after all updates so far. The counts are copied at once, so updates may follow before the answer is
    /// there. The answer has the words of [`Moved::of_counts`].
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(crate) fn count_moved(&mut self) -> Result<Answer<'static, Vec<u32>>, Error> {
        self.judge()?;
        let programs = [(CENSUS, "census"), (MORE, "more"), (AREAS, self.areas_program())];
        for (column, program) in programs {
            self.count_by(program, column)?;
        }
        let counts = self.context.copy(&self.history, programs.len())?;
        let totals = self.context.copy(&self.moving.totals.front, 1)?;
        Ok(Box::pin(async move {
            let mut words = counts.await?;
            words.truncate(4 * AREAS as usize + 3);
            words.extend_from_slice(&totals.await?[..2]);
            Ok(words)
        }))
    }

    /// The bits of the present positions, of an engine that has had an update.
    pub(crate) async fn read_positions(&self) -> Result<Vec<u32>, Error> {
        let (count, stride) = (self.params[1] as usize, self.form.dimension.stride());
        let words = self.context.copy(&self.positions, count)?.await?;
        Ok(words.chunks_exact(4).take(count).flat_map(|texel| &texel[..stride]).copied().collect())
    }
}

/// Coordinates as texels of the positions.
pub(super) fn in_texels(words: &[u32], dimension: Dimension) -> Vec<u32> {
    match dimension {
        Dimension::Two => words.chunks_exact(2).flat_map(|p| [p[0], p[1], 0, 0]).collect(),
        Dimension::Three => in_fours(words, |_| 0),
    }
}
