//! The phases as fragment programs over integer textures, for browsers without WebGPU.
//!
//! Every phase is a pass over all triangles. It reads one texture of a pair and writes the other. The host builds the
//! adjacency, and reads the flips after each batch of iterations.

use super::context::Context;
use super::errors::refuse;
use super::texture::{Pair, Texture};
use crate::engine::gpu::cosine::Cosine;
use crate::engine::gpu::probe::SHORT_STAR;
use crate::engine::gpu::upload::{Form, Upload};
use crate::engine::{Answer, Census, EdgeCounts, Engine, self_test};
use crate::mesh::embedded::Embedded;
use crate::mesh::half_edge;
use crate::mesh::star::Fans;
use crate::mesh::winding::Winding;
use crate::phases::Thresholds;
use crate::phases::state::BLOCKED;
use crate::system::threads::Threads;
use crate::{Adjacency, Dimension, EngineKind, Error, Mesh, NONE};
use std::rc::Rc;
use std::sync::Arc;
use web_sys::WebGl2RenderingContext as Gl;

/// Iterations of one batch. Those after the end of a run flip nothing and only cost time.
const BATCH: u32 = 16;
/// Side of the square of texels that one fragment sums; the same in `passes.wgsl`.
const BLOCK: u32 = 8;
/// The height of a texture with at most so many rows is rounded up to a power of two. Mesa compiles a program again for
/// other heights.
const SMALL_HEIGHT: usize = 256;
/// Words of the parameters.
const PARAMS: usize = 28;

// Texture units, as in `shaders/webgl2/state.wgsl`.
const POSITIONS: u32 = 0;
const TRIANGLES: u32 = 1;
const TWINS: u32 = 2;
const BESTS: u32 = 3;
const SELECTIONS: u32 = 4;
const FANS: u32 = 5;
const VERDICTS: u32 = 6;
const COUNTS: u32 = 7;

/// A mesh in textures.
pub(crate) struct WebGl {
    context: Rc<Context>,
    thresholds: Thresholds,
    form: Form,
    count: usize,
    counts: EdgeCounts,
    params: [u32; PARAMS],
    positions: Texture,
    triangles: Pair,
    twins: Pair,
    verdicts: Pair,
    bests: Pair,
    selections: Texture,
    fans: Pair,
    /// Each is an eighth as wide and as high as the one before. The last one is one block.
    sums: Vec<Texture>,
    /// Twice the flips of each iteration of a batch; or a census.
    history: Texture,
    has_locks: bool,
    passes: u64,
}

impl WebGl {
    /// Makes an engine on the shared context, after the self-test.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] if there is no context, or if it fails the self-test; those of [`WebGl::new`].
    pub(crate) async fn open(mesh: Arc<Mesh>, thresholds: Thresholds) -> Result<Self, Error> {
        let context = Context::shared().await?;
        let upload = Upload::new(EngineKind::WebGl, mesh, thresholds)?;
        let make = |upload: Upload| -> Answer<'static, Box<dyn Engine>> {
            let context = context.clone();
            Box::pin(async move { Ok(Box::new(Self::new(context, upload).await?) as Box<dyn Engine>) })
        };
        self_test(&context.tested, EngineKind::WebGl, upload.form(), &make).await?;
        Self::new(context, upload).await
    }

    /// Builds the adjacency and uploads the mesh.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] for a mesh that is too large for the context; [`Error::BackendUnavailable`] if the
    /// compiler refuses the programs; [`Error::Device`].
    async fn new(context: Rc<Context>, upload: Upload) -> Result<Self, Error> {
        let mesh = &upload.mesh;
        let form = upload.form();
        let common = &["label", "select", "flip", "update", "anchor", "census", "flips", "sum"];
        let more: &[_] = if form.has_deviation { &["more"] } else { &[] };
        context.compile(&[deciders(form), common, more].concat()).await?;

        let adjacency = Adjacency::new(mesh);
        let (winding, _) = Embedded::with_winding(mesh, &adjacency.twins, &Threads::default());
        let fans = Fans::new(mesh.vertex_count(), mesh.triangles(), &adjacency.twins);
        if context.ends_loops_early {
            refuse_large_star(&context, mesh)?;
        }
        let count = mesh.triangle_count();
        let bits = context.width_bits(count);
        let size = |texels: usize| size_of(&context, texels, bits);
        let whole = size(count)?;
        let pair = |size, words| context.pair(size, words);
        let mut sums = Vec::new();
        let mut side = whole;
        while sums.is_empty() || side.0 > BLOCK || side.1 > BLOCK {
            side = (side.0.div_ceil(BLOCK), side.1.div_ceil(BLOCK));
            sums.push(context.texture(side, 4)?);
        }
        let mut result = Self {
            thresholds: upload.thresholds,
            form,
            count,
            counts: EdgeCounts::from(&adjacency),
            params: params(&upload, bits, fans.table.len()),
            positions: context.texture(size(upload.words().len() / form.dimension.stride())?, 4)?,
            triangles: pair(whole, 4)?,
            twins: pair(whole, 4)?,
            verdicts: pair(size(3 * count)?, 1)?,
            bests: pair(whole, 1)?,
            selections: context.texture(whole, 1)?,
            fans: pair(size(fans.table.len())?, 1)?,
            sums,
            history: context.texture((BATCH, 1), 4)?,
            has_locks: false,
            passes: 0,
            context,
        };
        result.write(&upload, &adjacency.twins, &winding, fans)?;
        result.flag_creases()?;
        Ok(result)
    }

    fn write(&mut self, upload: &Upload, twins: &[u32], winding: &Winding, fans: Fans) -> Result<(), Error> {
        let stride = self.form.dimension.stride();
        let point = |p: &[u32]| [p[0], p[1], if stride == 3 { p[2] } else { 0 }, 0];
        self.positions.write(upload.words().chunks_exact(stride).flat_map(point).collect())?;
        let is_clockwise = |t: usize| u32::from(winding.is_clockwise(t as u32));
        self.triangles.front.write(in_fours(upload.mesh.triangles(), is_clockwise))?;
        self.twins.front.write(in_fours(twins, |_| NONE))?;
        self.fans.front.write(fans.table)?;
        // With these values, the first iteration tests every triangle.
        self.bests.front.write(vec![BLOCKED; self.count])?;
        self.selections.write(vec![NONE; self.count])
    }

    fn flag_creases(&mut self) -> Result<(), Error> {
        if let [_, crease, flag] = deciders(self.form) {
            self.write_params();
            self.context.pass(crease, &self.mesh(), &self.verdicts.back, None)?;
            let over = (VERDICTS, &self.verdicts.back);
            self.context.pass(flag, &[(TWINS, &self.twins.front), over], &self.twins.back, None)?;
            self.passes += 2;
            self.twins.swap();
        }
        Ok(())
    }

    /// The inputs of every pass that reads the mesh.
    fn mesh(&self) -> [(u32, &Texture); 3] {
        [(POSITIONS, &self.positions), (TRIANGLES, &self.triangles.front), (TWINS, &self.twins.front)]
    }

    /// Computes the verdicts on all present edges, without the test for duplicates.
    fn judge(&mut self) -> Result<(), Error> {
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

    fn write_params(&self) {
        let gl = &self.context.gl;
        gl.bind_buffer(Gl::UNIFORM_BUFFER, Some(&self.context.params));
        let words = js_sys::Uint32Array::from(self.params.as_slice());
        gl.buffer_data_with_array_buffer_view(Gl::UNIFORM_BUFFER, &words, Gl::DYNAMIC_DRAW);
    }

    /// Encodes the passes of one iteration. Twice its flips goes to a column of the history.
    fn encode_iteration(&mut self, column: u32) -> Result<(), Error> {
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
    fn sum_up(&mut self, column: u32) -> Result<(), Error> {
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
            let history = self.context.read(&self.history, batch as usize).await?;
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
            let more = [(VERDICTS, &self.verdicts.front), (FANS, &self.fans.front)];
            // The back texture is free between two iterations.
            self.context.pass(program, &[&self.mesh()[..], &more].concat(), &self.triangles.back, None)?;
            self.context.pass("sum", &[(COUNTS, &self.triangles.back)], &self.sums[0], None)?;
            self.passes += 2;
            self.sum_up(column)?;
        }
        self.context.read(&self.history, programs.len()).await
    }

    async fn flag_locked(&mut self, half_edges: Vec<u32>) -> Result<(), Error> {
        self.context.compile(&["more"]).await?;
        let mut twins = self.read_threes(&self.twins.front).await?;
        half_edge::lock(&mut twins, &half_edges);
        self.has_locks = true;
        self.twins.front.write(in_fours(&twins, |_| NONE))
    }

    /// Reads the first three words of each triangle's texel.
    async fn read_threes(&self, texture: &Texture) -> Result<Vec<u32>, Error> {
        let words = self.context.read(texture, self.count).await?;
        Ok(words.chunks_exact(4).take(self.count).flat_map(|texel| [texel[0], texel[1], texel[2]]).collect())
    }

    async fn move_vertices(&mut self, mesh: Arc<Mesh>) -> Result<(), Error> {
        let upload = Upload::new(self.backend(), mesh, self.thresholds)?;
        let mut moved = Self::new(self.context.clone(), upload).await?;
        if self.has_locks {
            let twins = self.read_threes(&self.twins.front).await?;
            moved.flag_locked(half_edge::locked(&twins)).await?;
        }
        moved.passes += self.passes;
        *self = moved;
        Ok(())
    }
}

/// The programs with the exact tests for a form: the verdict on edges; in space also the creases.
fn deciders(form: Form) -> &'static [&'static str] {
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
fn in_fours(words: &[u32], fourth: impl Fn(usize) -> u32) -> Vec<u32> {
    words.chunks_exact(3).enumerate().flat_map(|(i, w)| [w[0], w[1], w[2], fourth(i)]).collect()
}

/// Width and height of a texture for `texels` texels. It is never empty.
fn size_of(context: &Context, texels: usize, bits: u32) -> Result<(u32, u32), Error> {
    let rows = texels.div_ceil(1 << bits).max(1);
    let rows = if rows <= SMALL_HEIGHT { rows.next_power_of_two() } else { rows };
    if rows > context.largest_side as usize {
        let side = context.largest_side;
        return refuse(format!(
            "it takes a texture of {} by {rows} texels; {} allows sides of at most {side}",
            1u32 << bits,
            context.adapter
        ));
    }
    Ok((1 << bits, rows as u32))
}

fn refuse_large_star(context: &Context, mesh: &Mesh) -> Result<(), Error> {
    let mut corners = vec![0u32; mesh.vertex_count()];
    for &v in mesh.triangles() {
        corners[v as usize] += 1;
    }
    match corners.into_iter().max() {
        Some(most) if most > SHORT_STAR => {
            let adapter = &context.adapter;
            refuse(format!(
                "a vertex has {most} triangles; {adapter} allows {SHORT_STAR}, as it ends loops early"
            ))
        }
        _ => Ok(()),
    }
}

/// The parameters, in the layout of `shaders/webgl2/state.wgsl`.
fn params(upload: &Upload, bits: u32, fans: usize) -> [u32; PARAMS] {
    let (mesh, cosine) = (&upload.mesh, Cosine::new(upload.thresholds.cos));
    let mut params = [0; PARAMS];
    params[0] = mesh.triangle_count() as u32;
    params[1] = mesh.vertex_count() as u32;
    params[3] = bits;
    params[4] = fans as u32;
    params[5] = u32::from(cosine.is_of_any_angle);
    params[6] = cosine.sign as u32;
    params[7] = cosine.rounded.to_bits();
    for (word, digit) in params[8..].iter_mut().zip(cosine.mantissa.into_iter().chain(cosine.power)) {
        *word = digit as u32;
    }
    params[24..].copy_from_slice(&upload.deviation);
    params
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

    fn triangles(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.read_threes(&self.triangles.front))
    }

    fn twins(&mut self) -> Answer<'_, Vec<u32>> {
        Box::pin(self.read_threes(&self.twins.front))
    }

    fn set_positions(&mut self, mesh: Arc<Mesh>) -> Answer<'_, ()> {
        Box::pin(self.move_vertices(mesh))
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
