//! The WebGL2 context, and the programs compiled for it.

use super::errors::{lost, unavailable};
use super::texture::{Pair, Texture};
use crate::Error;
use crate::engine::Answer;
use crate::engine::gpu::probe::ends_loops_early;
use crate::engine::gpu::self_test::Tested;
use js_sys::{Function, Object, Promise, Reflect, Uint32Array};
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use wasm_bindgen::prelude::*;
use wasm_bindgen_futures::JsFuture;
use web_sys::{HtmlCanvasElement, OffscreenCanvas, WebGl2RenderingContext as Gl, WebGlBuffer, WebGlProgram};

/// The most bits of the width of a texture. Wider rows have no advantage.
const MOST_WIDTH_BITS: u32 = 12;
/// Texture units, as in `shaders/webgl2/state.wgsl`; one number stands for the parameters.
const UNITS: i32 = 10;
/// Milliseconds between two polls of the context.
const PAUSE: i32 = 1;
/// `COMPLETION_STATUS_KHR`.
const COMPLETION_STATUS: u32 = 0x91b1;
/// `UNMASKED_RENDERER_WEBGL`.
const UNMASKED_RENDERER: u32 = 0x9246;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_name = setTimeout)]
    fn set_timeout(callback: &Function, ms: i32);
}

thread_local! {
    /// The function that loads the sources of the programs, called only when they are needed.
    static LOADER: RefCell<Option<Function>> = const { RefCell::new(None) };
    /// The context that all sessions share.
    static SHARED: RefCell<Option<Rc<Context>>> = const { RefCell::new(None) };
}

/// Sets the loader of the sources: a function that returns a promise of a module whose default export maps each
/// program's name to its text.
pub(crate) fn set_shader_loader(loader: Function) {
    LOADER.set(Some(loader));
}

/// A context and its programs.
pub(super) struct Context {
    pub(super) gl: Gl,
    /// The renderer's name.
    pub(super) adapter: String,
    /// The largest side of a texture.
    pub(super) largest_side: u32,
    /// See `shaders/shared/rounds.wgsl`.
    pub(super) ends_loops_early: Cell<bool>,
    pub(super) tested: Tested,
    pub(super) params: WebGlBuffer,
    sources: JsValue,
    programs: RefCell<Vec<(&'static str, WebGlProgram)>>,
    compiles_beside: bool,
}

impl Context {
    /// The shared context, if it is open.
    pub(super) fn known() -> Option<Rc<Self>> {
        SHARED.with_borrow(Clone::clone).filter(|context| !context.gl.is_context_lost())
    }

    /// The shared context. Opened at the first call, and again after a loss.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] if there is no context; [`Error::Device`] if it fails at once.
    pub(super) async fn shared() -> Result<Rc<Self>, Error> {
        if let Some(context) = Self::known() {
            return Ok(context);
        }
        let context = Self::open(create()?).await?;
        SHARED.set(Some(context.clone()));
        Ok(context)
    }

    async fn open(gl: Gl) -> Result<Rc<Self>, Error> {
        let largest_side = gl.get_parameter(Gl::MAX_TEXTURE_SIZE).ok().and_then(|side| side.as_f64());
        let context = Self {
            adapter: renderer(&gl),
            largest_side: largest_side.map_or(0, |side| side as u32),
            ends_loops_early: Cell::new(false),
            tested: Tested::default(),
            params: gl.create_buffer().ok_or_else(|| lost(&gl))?,
            sources: load_sources().await?,
            programs: RefCell::default(),
            compiles_beside: matches!(gl.get_extension("KHR_parallel_shader_compile"), Ok(Some(_))),
            gl,
        };
        let context = Rc::new(context);
        context.compile(&["probe"]).await?;
        let target = context.texture((1, 1), 4)?;
        context.pass("probe", &[], &target, None)?;
        let found = context.copy(&target, 1)?.await?;
        context.ends_loops_early.set(ends_loops_early(found[0]));
        drop(target);
        Ok(context)
    }

    /// A texture, all zero.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] where there is no memory for it; [`Error::Device`].
    pub(super) fn texture(&self, size: (u32, u32), words: usize) -> Result<Texture, Error> {
        Texture::new(&self.gl, &self.adapter, size, words)
    }

    /// Two equal textures.
    ///
    /// # Errors
    /// Those of [`Context::texture`].
    pub(super) fn pair(&self, size: (u32, u32), words: usize) -> Result<Pair, Error> {
        Ok(Pair { front: self.texture(size, words)?, back: self.texture(size, words)? })
    }

    /// Bits of the width of an about square texture for `count` texels.
    pub(super) fn width_bits(&self, count: usize) -> u32 {
        count.next_power_of_two().ilog2().div_ceil(2).min(MOST_WIDTH_BITS).min(self.largest_side.ilog2())
    }

    /// Compiles the named programs, unless they are compiled.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] with the log of the compiler; [`Error::Device`].
    pub(super) async fn compile(&self, names: &[&'static str]) -> Result<(), Error> {
        let is_known = |name: &str| self.programs.borrow().iter().any(|(known, _)| *known == name);
        let missing: Vec<_> = names.iter().copied().filter(|name| !is_known(name)).collect();
        let linked: Vec<_> =
            missing.into_iter().map(|name| Ok((name, self.link(name)?))).collect::<Result<_, Error>>()?;
        for (name, program) in linked {
            while self.compiles_beside
                && self.gl.get_program_parameter(&program, COMPLETION_STATUS).is_falsy()
                && !self.gl.is_context_lost()
            {
                pause().await;
            }
            if self.gl.get_program_parameter(&program, Gl::LINK_STATUS).is_falsy() {
                if self.gl.is_context_lost() {
                    return Err(lost(&self.gl));
                }
                let log = self.gl.get_program_info_log(&program).unwrap_or_default();
                return Err(unavailable(format!("it refuses the program {name}: {log}")));
            }
            self.gl.use_program(Some(&program));
            for unit in 0..UNITS {
                let sampler = self.gl.get_uniform_location(&program, &format!("_group_0_binding_{unit}_fs"));
                self.gl.uniform1i(sampler.as_ref(), unit);
            }
            self.programs.borrow_mut().push((name, program));
        }
        Ok(())
    }

    /// Starts the compiler. The caller reads its log when it has finished.
    fn link(&self, name: &str) -> Result<WebGlProgram, Error> {
        let gl = &self.gl;
        let program = gl.create_program().ok_or_else(|| lost(gl))?;
        for (kind, source) in [(Gl::VERTEX_SHADER, "cover"), (Gl::FRAGMENT_SHADER, name)] {
            let shader = gl.create_shader(kind).ok_or_else(|| lost(gl))?;
            let text = Reflect::get(&self.sources, &source.into()).ok().and_then(|text| text.as_string());
            gl.shader_source(&shader, &text.unwrap_or_default());
            gl.compile_shader(&shader);
            gl.attach_shader(&program, &shader);
        }
        gl.link_program(&program);
        Ok(program)
    }

    /// Runs a compiled program for every texel of `target`, or only for texel `column` of its first row. `inputs` are
    /// texture units, as in `shaders/webgl2/state.wgsl`, and their textures.
    ///
    /// # Errors
    /// [`Error::Device`] if the context is lost.
    pub(super) fn pass(
        &self,
        name: &str,
        inputs: &[(u32, &Texture)],
        target: &Texture,
        column: Option<u32>,
    ) -> Result<(), Error> {
        let gl = &self.gl;
        let programs = self.programs.borrow();
        let program = programs.iter().find(|(known, _)| *known == name);
        gl.use_program(program.map(|(_, program)| program));
        gl.bind_buffer_base(Gl::UNIFORM_BUFFER, 0, Some(&self.params));
        for (unit, texture) in inputs {
            gl.active_texture(Gl::TEXTURE0 + unit);
            gl.bind_texture(Gl::TEXTURE_2D, Some(&texture.texture));
        }
        gl.bind_framebuffer(Gl::FRAMEBUFFER, Some(&target.framebuffer));
        let (width, height) = if column.is_some() { (1, 1) } else { target.size };
        gl.viewport(column.unwrap_or(0) as i32, 0, width as i32, height as i32);
        gl.draw_arrays(Gl::TRIANGLES, 0, 3);
        if gl.is_context_lost() { Err(lost(gl)) } else { Ok(()) }
    }

    /// Copies at least the first `count` texels of four words, row by row. The copy is made at once; the answer
    /// waits for it.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) fn copy(
        self: &Rc<Self>,
        texture: &Texture,
        count: usize,
    ) -> Result<Answer<'static, Vec<u32>>, Error> {
        let gl = &self.gl;
        let (columns, rows) = texture.part(count);
        let words = 4 * columns * rows;
        let buffer = gl.create_buffer().ok_or_else(|| lost(gl))?;
        gl.bind_framebuffer(Gl::FRAMEBUFFER, Some(&texture.framebuffer));
        gl.bind_buffer(Gl::PIXEL_PACK_BUFFER, Some(&buffer));
        gl.buffer_data_with_f64(Gl::PIXEL_PACK_BUFFER, 4.0 * f64::from(words), Gl::STREAM_READ);
        let copied = gl.read_pixels_with_f64(
            0,
            0,
            columns as i32,
            rows as i32,
            Gl::RGBA_INTEGER,
            Gl::UNSIGNED_INT,
            0.0,
        );
        gl.bind_buffer(Gl::PIXEL_PACK_BUFFER, None);
        if copied.is_err() {
            gl.delete_buffer(Some(&buffer));
            return Err(lost(gl));
        }
        let context = self.clone();
        Ok(Box::pin(async move { context.fetch(&buffer, words).await }))
    }

    async fn fetch(&self, buffer: &WebGlBuffer, words: u32) -> Result<Vec<u32>, Error> {
        let gl = &self.gl;
        let result = Uint32Array::new_with_length(words);
        let ended = self.finish().await;
        if ended.is_ok() {
            gl.bind_buffer(Gl::PIXEL_PACK_BUFFER, Some(buffer));
            gl.get_buffer_sub_data_with_i32_and_array_buffer_view(Gl::PIXEL_PACK_BUFFER, 0, &result);
            gl.bind_buffer(Gl::PIXEL_PACK_BUFFER, None);
        }
        gl.delete_buffer(Some(buffer));
        ended?;
        self.checked(&result)
    }

    /// The same texels, for which the call waits. Those of one word have it first.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) fn read(&self, texture: &Texture, count: usize) -> Result<Vec<u32>, Error> {
        let gl = &self.gl;
        let (columns, rows) = texture.part(count);
        let result = Uint32Array::new_with_length(4 * columns * rows);
        gl.bind_framebuffer(Gl::FRAMEBUFFER, Some(&texture.framebuffer));
        gl.read_pixels_with_opt_array_buffer_view(
            0,
            0,
            columns as i32,
            rows as i32,
            Gl::RGBA_INTEGER,
            Gl::UNSIGNED_INT,
            Some(&result),
        )
        .map_err(|_| lost(gl))?;
        self.checked(&result)
    }

    fn checked(&self, read: &Uint32Array) -> Result<Vec<u32>, Error> {
        match self.gl.get_error() {
            Gl::NO_ERROR if !self.gl.is_context_lost() => Ok(read.to_vec()),
            Gl::CONTEXT_LOST_WEBGL | Gl::NO_ERROR => Err(lost(&self.gl)),
            code => Err(Error::Device { message: format!("WebGL2 reports the error {code:#06x}") }),
        }
    }

    /// Waits until the context has finished all calls. The page's event loop runs meanwhile.
    async fn finish(&self) -> Result<(), Error> {
        let gl = &self.gl;
        let sync = gl.fence_sync(Gl::SYNC_GPU_COMMANDS_COMPLETE, 0).ok_or_else(|| lost(gl))?;
        gl.flush();
        let is_signalled =
            || gl.get_sync_parameter(&sync, Gl::SYNC_STATUS).as_f64() == Some(f64::from(Gl::SIGNALED));
        while !is_signalled() && !gl.is_context_lost() {
            pause().await;
        }
        gl.delete_sync(Some(&sync));
        if gl.is_context_lost() { Err(lost(gl)) } else { Ok(()) }
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        self.gl.delete_buffer(Some(&self.params));
        for (_, program) in self.programs.borrow().iter() {
            self.gl.delete_program(Some(program));
        }
    }
}

/// Makes a context on a canvas that is never shown.
fn create() -> Result<Gl, Error> {
    let options = Object::new();
    for name in ["alpha", "antialias", "depth"] {
        // Setting a field of a new object does not fail.
        let _ = Reflect::set(&options, &name.into(), &false.into());
    }
    let _ = Reflect::set(&options, &"powerPreference".into(), &"high-performance".into());
    let offscreen = OffscreenCanvas::new(1, 1)
        .ok()
        .and_then(|canvas| canvas.get_context_with_context_options("webgl2", &options).ok().flatten());
    let context = offscreen.or_else(|| {
        let canvas = web_sys::window()?.document()?.create_element("canvas").ok()?;
        let canvas = canvas.dyn_into::<HtmlCanvasElement>().ok()?;
        canvas.get_context_with_context_options("webgl2", &options).ok().flatten()
    });
    context
        .and_then(|context| context.dyn_into::<Gl>().ok())
        .ok_or_else(|| unavailable("the browser gives no WebGL2 context"))
}

/// The name of the renderer. Chromium and Safari tell it only through an extension, about which Firefox warns.
fn renderer(gl: &Gl) -> String {
    let text = |parameter| gl.get_parameter(parameter).ok().and_then(|text| text.as_string());
    let name = text(Gl::RENDERER).unwrap_or_default();
    if name.starts_with("WebKit") && matches!(gl.get_extension("WEBGL_debug_renderer_info"), Ok(Some(_))) {
        return text(UNMASKED_RENDERER).unwrap_or(name);
    }
    name
}

async fn load_sources() -> Result<JsValue, Error> {
    let loader = LOADER.with_borrow(Clone::clone);
    let loader = loader.ok_or_else(|| unavailable("the loader of its programs is not set"))?;
    let load = async {
        let module = loader.call0(&JsValue::UNDEFINED)?;
        let module = JsFuture::from(Promise::resolve(&module)).await?;
        Reflect::get(&module, &"default".into())
    };
    load.await.map_err(|error| unavailable(format!("its programs could not be loaded: {error:?}")))
}

async fn pause() {
    let promise = Promise::new(&mut |resolve, _| set_timeout(&resolve, PAUSE));
    // This promise never rejects.
    let _ = JsFuture::from(promise).await;
}
