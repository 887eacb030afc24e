//! The phases as fragment programs over integer textures, for browsers without WebGPU.
//!
//! Every phase is one or more passes. A pass that renews a texture reads the front of a pair and writes the back. The
//! host reads the flips after each batch of iterations.

use super::context::Context;
use super::texture::{Pair, Texture};
use crate::engine::gpu::upload::Form;
use crate::engine::{Answer, Census, EdgeCounts, Engine, Moved, positions_of};
use crate::mesh::areas::Areas;
use crate::mesh::half_edge;
use crate::mesh::winding::Winding;
use crate::phases::Thresholds;
use crate::{Dimension, EngineKind, Error, Mesh, NONE, Positions};
use std::rc::Rc;
use std::sync::Arc;
use web_sys::WebGl2RenderingContext as Gl;

/// Iterations of one batch. Those after the end of a run flip nothing and only cost time.
pub(super) const BATCH: u32 = 16;
/// Words of the parameters.
pub(super) const PARAMS: usize = 32;

// Texture units, as in `shaders/webgl2/state.wgsl`.
const POSITIONS: u32 = 0;
const TRIANGLES: u32 = 1;
pub(super) const TWINS: u32 = 2;
const BESTS: u32 = 3;
pub(super) const SELECTIONS: u32 = 4;
pub(super) const FANS: u32 = 5;
pub(super) const VERDICTS: u32 = 6;
pub(super) const COUNTS: u32 = 7;

/// A mesh in textures.
pub(crate) struct WebGl {
    pub(super) context: Rc<Context>,
    pub(super) thresholds: Thresholds,
    pub(super) form: Form,
    pub(super) count: usize,
    pub(super) counts: EdgeCounts,
    pub(super) params: [u32; PARAMS],
    pub(super) positions: Texture,
    pub(super) triangles: Pair,
    pub(super) twins: Pair,
    pub(super) verdicts: Pair,
    pub(super) bests: Pair,
    pub(super) selections: Texture,
    pub(super) fans: Pair,
    /// Sums of counts. Each texture is an eighth as wide and as high as the one before. The last one is one block.
    pub(super) sums: Vec<Texture>,
    /// For each iteration of a batch or an update, twice its flips, because both triangles of a flip count it; or a
    /// census.
    pub(super) history: Texture,
    pub(super) has_locks: bool,
    /// Known to be strict only before the first update.
    pub(super) winding: Winding,
    pub(super) moving: Moving,
    pub(super) passes: u64,
}

/// What updates need, and nothing else.
pub(super) struct Moving {
    /// One texel: the flips of all updates.
    pub(super) totals: Pair,
    /// For each triangle the update in which it last changed, if somebody asks for it. Of four words per texel, because
    /// browsers read others slowly.
    pub(super) changes: Option<Texture>,
    /// Whether the programs of the updates are compiled.
    pub(super) is_settled: bool,
}

impl Moving {
    pub(super) fn new(totals: Pair) -> Self {
        Self { totals, changes: None, is_settled: false }
    }
}

impl WebGl {
    /// The inputs of every pass that reads the mesh.
    pub(super) fn mesh(&self) -> [(u32, &Texture); 3] {
        [(POSITIONS, &self.positions), (TRIANGLES, &self.triangles.front), (TWINS, &self.twins.front)]
    }

    /// Computes the verdicts on all present edges, without the test for duplicates.
    pub(super) fn judge(&mut self) -> Result<(), Error> {
        self.write_params();
        let before = [(SELECTIONS, &self.selections), (VERDICTS, &self.verdicts.front)];
        self.context.pass(
            deciders(self.form)[0],
            &[&self.mesh()[..], &before].concat(),
            &self.verdicts.back,
            None,
        )?;
        self.verdicts.swap();
        self.passes += 1;
        Ok(())
    }

    pub(super) fn write_params(&self) {
        let gl = &self.context.gl;
        gl.bind_buffer(Gl::UNIFORM_BUFFER, Some(&self.context.params));
        let words = js_sys::Uint32Array::from(self.params.as_slice());
        gl.buffer_data_with_array_buffer_view(Gl::UNIFORM_BUFFER, &words, Gl::DYNAMIC_DRAW);
    }

    /// Encodes the passes of one iteration. Twice its flips goes to a column of the history.
    pub(super) fn encode_iteration(&mut self, column: u32) -> Result<(), Error> {
        self.judge()?;
        let (context, mesh) = (&self.context, self.mesh());
        let with = |more: &[(u32, &Texture)], program, target: &Texture| {
            context.pass(program, &[&mesh, more].concat(), target, None)
        };
        let fans = (FANS, &self.fans.front);
        let before = [(BESTS, &self.bests.front), (SELECTIONS, &self.selections)];
        with(&[&before[..], &[(VERDICTS, &self.verdicts.front), fans]].concat(), "label", &self.bests.back)?;
        with(&[fans, (BESTS, &self.bests.back)], "select", &self.selections)?;
        let selections = (SELECTIONS, &self.selections);
        with(&[selections], "flip", &self.triangles.back)?;
        with(&[selections], "update", &self.twins.back)?;
        let has_fans = self.params[4] > 0;
        if has_fans {
            with(&[selections, fans], "anchor", &self.fans.back)?;
            self.fans.swap();
        }
        self.bests.swap();
        self.triangles.swap();
        self.twins.swap();
        self.context.pass("flips", &[(SELECTIONS, &self.selections)], &self.sums[0], None)?;
        self.passes += 5 + u64::from(has_fans);
        self.sum_up(column)
    }

    /// Sums the counts in `sums[0]` into a column of the history.
    pub(super) fn sum_up(&mut self, column: u32) -> Result<(), Error> {
        for pair in self.sums.windows(2) {
            self.context.pass("sum", &[(COUNTS, &pair[0])], &pair[1], None)?;
        }
        self.passes += self.sums.len() as u64;
        let last = &self.sums[self.sums.len() - 1];
        self.context.pass("sum", &[(COUNTS, last)], &self.history, Some(column))
    }

    async fn run(&mut self, count: u32) -> Result<Vec<u32>, Error> {
        let mut flips = Vec::new();
        while (flips.len() as u32) < count {
            let batch = (count - flips.len() as u32).min(BATCH);
            let first = self.params[2];
            for column in 0..batch {
                self.params[2] = first + column;
                self.encode_iteration(column)?;
            }
            let history = self.context.copy(&self.history, batch as usize)?.await?;
            let ran = history.chunks_exact(4).map(|texel| texel[0] / 2).take_while(|&n| n > 0);
            let before = flips.len();
            flips.extend(ran);
            let ran = (flips.len() - before) as u32;
            self.params[2] = first + ran;
            if ran < batch {
                break;
            }
        }
        Ok(flips)
    }

    /// Counts for [`Census::of_counts`].
    pub(crate) async fn census_counts(&mut self) -> Result<Vec<u32>, Error> {
        self.judge()?;
        // A texel has four counts.
        let has_more = self.has_locks || self.form.has_deviation;
        let programs = &["census", "more"][..1 + usize::from(has_more)];
        for (column, program) in (0..).zip(programs) {
            self.count_by(program, column)?;
        }
        self.context.copy(&self.history, programs.len())?.await
    }

    pub(super) async fn flag_locked(&mut self, half_edges: Vec<u32>) -> Result<(), Error> {
        self.context.compile(&["more"]).await?;
        let mut twins = self.read_threes(&self.twins.front).await?;
        half_edge::lock(&mut twins, &half_edges);
        self.has_locks = true;
        self.twins.front.write(in_fours(&twins, |_| NONE))
    }

    /// Reads the first three words of each triangle's texel.
    pub(super) async fn read_threes(&self, texture: &Texture) -> Result<Vec<u32>, Error> {
        let words = self.context.copy(texture, self.count)?.await?;
        Ok(words.chunks_exact(4).take(self.count).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect())
    }
}

/// The programs with the exact tests for a form: the verdict on edges; in space also the creases.
pub(super) fn deciders(form: Form) -> &'static [&'static str] {
    match (form.dimension, form.is_fixed) {
        (Dimension::Two, false) => &["verdict2"],
        (Dimension::Two, true) => &["verdict2_fixed"],
        (Dimension::Three, false) if form.has_deviation => &["verdict3_deviation", "crease", "flag"],
        (Dimension::Three, false) => &["verdict3", "crease", "flag"],
        (Dimension::Three, true) if form.has_deviation => {
            &["verdict3_fixed_deviation", "crease_fixed", "flag"]
        }
        (Dimension::Three, true) => &["verdict3_fixed", "crease_fixed", "flag"],
    }
}

/// Texels of three words each and a fourth from `fourth`.
pub(super) fn in_fours(words: &[u32], fourth: impl Fn(usize) -> u32) -> Vec<u32> {
    words.chunks_exact(3).enumerate().flat_map(|(i, w)| [w[0], w[1], w[2], fourth(i)]).collect()
}

impl Engine for WebGl {
    fn batch(&self) -> u32 {
        BATCH
    }

    fn lock(&mut self, half_edges: Vec<u32>) -> Answer<'_, ()> {
        Box::pin(self.flag_locked(half_edges))
    }

    fn iterate(&mut self, count: u32) -> Answer<'_, Vec<u32>> {
        Box::pin(self.run(count))
    }

    fn census(&mut self) -> Answer<'_, Census> {
        Box::pin(async { Ok(Census::of_counts(&self.census_counts().await?)) })
    }

    fn areas(&mut self) -> Answer<'_, Areas> {
        Box::pin(async { Ok(Areas::of_counts(&self.count_areas().await?)) })
    }

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.read_threes(&self.triangles.front))
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.read_threes(&self.twins.front))
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>, twins: Option<Vec<u32>>) -> Answer<'_, ()> {
        Box::pin(self.move_vertices(mesh, twins.map(|twins| half_edge::locked(&twins))))
    }

    fn settle(&mut self) -> Answer<'_, ()> {
        Box::pin(self.settle_updates())
    }

    fn update(
        &mut self,
        positions: Option<Positions>,
        iterations: u32,
        untangles: bool,
    ) -> Result<(), Error> {
        self.submit_update(positions.as_ref(), iterations, untangles)
    }

    fn moved(&mut self) -> Answer<'static, Moved> {
        let counted = self.count_moved();
        Box::pin(async { Ok(Moved::of_counts(&counted?.await?)) })
    }

    fn track_changes(&mut self) -> Answer<'_, ()> {
        Box::pin(std::future::ready(self.begin_changes()))
    }

    fn changes(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.read_changes())
    }

    fn positions(&mut self) -> Answer<'_, Positions> {
        Box::pin(async { Ok(positions_of(self.read_positions().await?)) })
    }

    fn edge_counts(&self) -> EdgeCounts {
        self.counts
    }

    fn backend(&self) -> EngineKind {
        EngineKind::WebGl
    }

    fn adapter(&self) -> Option<String> {
        Some(self.context.adapter.clone())
    }

    fn dispatches(&self) -> u64 {
        self.passes
    }
}
