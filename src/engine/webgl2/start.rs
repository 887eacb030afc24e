//! The start of the WebGL2 engine: the host builds the adjacency and writes the mesh into textures.

use super::context::Context;
use super::errors::refuse;
use super::iteration::{BATCH, Moving, PARAMS, TWINS, VERDICTS, WebGl, deciders, in_fours};
use super::moving::in_texels;
use crate::engine::gpu::cosine::Cosine;
use crate::engine::gpu::probe::SHORT_STAR;
use crate::engine::gpu::upload::Upload;
use crate::engine::{Answer, EdgeCounts, Engine, MOST_ITERATIONS, self_test};
use crate::mesh::embedded::Embedded;
use crate::mesh::half_edge;
use crate::mesh::star::Fans;
use crate::phases::Thresholds;
use crate::phases::state::BLOCKED;
use crate::system::in_turn::in_turn;
use crate::system::threads::Threads;
use crate::{Adjacency, EngineKind, Error, Mesh, NONE};
use js_sys::Promise;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

/// Side of the square of texels that one fragment sums; the same in `passes.wgsl`.
const BLOCK: u32 = 8;
/// The height of a texture with at most this many rows is rounded up to a power of two. Mesa compiles a program again
/// for each new height.
const SMALL_HEIGHT: usize = 256;

impl WebGl {
    /// Makes an engine on the shared context, after the self-test.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] if there is no context, or if it fails the self-test; those of [`WebGl::new`].
    pub(crate) async fn open(mesh: Arc<Mesh>, thresholds: Thresholds) -> Result<Self, Error> {
        thread_local! {
            static RUNNING: RefCell<Option<Promise>> = const { RefCell::new(None) };
        }
        // Sessions of a page often begin at the same time: one opens the context and compiles the programs.
        let context = in_turn(&RUNNING, || Context::known().is_some(), Context::shared()).await?;
        let upload = Upload::new(EngineKind::WebGl, mesh, thresholds)?;
        let form = upload.form();
        let (is_tested, tested) = (context.clone(), context.clone());
        let test = async move {
            let make = |upload: Upload| -> Answer<'static, Box<dyn Engine>> {
                let context = tested.clone();
                Box::pin(async move { Ok(Box::new(Self::new(context, upload).await?) as Box<dyn Engine>) })
            };
            self_test(&tested.tested, EngineKind::WebGl, form, &make).await
        };
        in_turn(&RUNNING, || is_tested.tested.has_passed(form), test).await?;
        Self::new(context, upload).await
    }

    /// Builds the adjacency and uploads the mesh.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] for a mesh that is too large for the context; [`Error::BackendUnavailable`] if the
    /// compiler refuses the programs; [`Error::Device`].
    pub(super) async fn new(context: Rc<Context>, upload: Upload) -> Result<Self, Error> {
        let mesh = &upload.mesh;
        let form = upload.form();
        let common = &["label", "select", "flip", "update", "anchor", "census", "flips", "sum"];
        let more: &[_] = if form.has_deviation { &["more"] } else { &[] };
        context.compile(&[deciders(form), common, more].concat()).await?;

        let adjacency = Adjacency::new(mesh);
        let (winding, _) =
            Embedded::with_winding(mesh, &adjacency.twins, None, &mut None, &Threads::default());
        let fans = Fans::new(mesh.vertex_count(), mesh.triangles(), &adjacency.twins);
        if context.ends_loops_early.get() {
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
            history: context.texture((MOST_ITERATIONS.max(BATCH), 1), 4)?,
            has_locks: false,
            winding,
            moving: Moving::new(context.pair((1, 1), 4)?),
            passes: 0,
            context,
        };
        result.write(&upload, &adjacency.twins, fans)?;
        result.flag_creases()?;
        Ok(result)
    }

    fn write(&mut self, upload: &Upload, twins: &[u32], fans: Fans) -> Result<(), Error> {
        self.positions.write(in_texels(upload.words(), self.form.dimension))?;
        self.write_triangles(upload.mesh.triangles())?;
        self.twins.front.write(in_fours(twins, |_| NONE))?;
        self.fans.front.write(fans.table)?;
        // With these values, the first iteration tests every triangle.
        self.bests.front.fill(BLOCKED);
        self.selections.fill(NONE);
        Ok(())
    }

    pub(super) fn write_triangles(&self, triangles: &[u32]) -> Result<(), Error> {
        let is_clockwise = |t: usize| u32::from(self.winding.is_clockwise(t as u32));
        self.triangles.front.write(in_fours(triangles, is_clockwise))
    }

    pub(super) fn flag_creases(&mut self) -> Result<(), Error> {
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

    /// `locked`: the locked half-edges, if `mesh` has other triangles than the engine.
    pub(crate) async fn move_vertices(
        &mut self,
        mesh: Arc<Mesh>,
        locked: Option<Vec<u32>>,
    ) -> Result<(), Error> {
        let upload = Upload::new(self.backend(), mesh, self.thresholds)?;
        let mut moved = Self::new(self.context.clone(), upload).await?;
        let locked = match locked {
            None if self.has_locks => half_edge::locked(&self.read_threes(&self.twins.front).await?),
            locked => locked.unwrap_or_default(),
        };
        if !locked.is_empty() {
            moved.flag_locked(locked).await?;
        }
        if self.moving.changes.is_some() {
            moved.begin_changes()?;
        }
        moved.passes += self.passes;
        *self = moved;
        Ok(())
    }
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
    params[24..28].copy_from_slice(&upload.deviation);
    params
}
