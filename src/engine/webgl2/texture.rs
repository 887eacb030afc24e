//! Integer textures: one element per texel, row after row.

use super::errors::{lost, refuse};
use crate::Error;
use js_sys::Uint32Array;
use web_sys::{WebGl2RenderingContext as Gl, WebGlFramebuffer, WebGlTexture};

/// A texture of words that a pass can write. It is deleted on drop.
pub(super) struct Texture {
    gl: Gl,
    pub(super) texture: WebGlTexture,
    pub(super) framebuffer: WebGlFramebuffer,
    /// Width and height.
    pub(super) size: (u32, u32),
    /// Words per texel: 1 or 4.
    words: usize,
}

impl Texture {
    /// A texture, all zero. `adapter` is the name of the renderer.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] where there is no memory for it; [`Error::Device`].
    pub(super) fn new(gl: &Gl, adapter: &str, size: (u32, u32), words: usize) -> Result<Self, Error> {
        let (Some(texture), Some(framebuffer)) = (gl.create_texture(), gl.create_framebuffer()) else {
            return Err(lost(gl));
        };
        let result = Self { gl: gl.clone(), texture, framebuffer, size, words };
        gl.active_texture(Gl::TEXTURE0);
        gl.bind_texture(Gl::TEXTURE_2D, Some(&result.texture));
        let format = if words == 1 { Gl::R32UI } else { Gl::RGBA32UI };
        gl.tex_storage_2d(Gl::TEXTURE_2D, 1, format, size.0 as i32, size.1 as i32);
        // Integers cannot be interpolated: with other filters the texture is incomplete.
        for filter in [Gl::TEXTURE_MIN_FILTER, Gl::TEXTURE_MAG_FILTER] {
            gl.tex_parameteri(Gl::TEXTURE_2D, filter, Gl::NEAREST as i32);
        }
        gl.bind_framebuffer(Gl::FRAMEBUFFER, Some(&result.framebuffer));
        let (target, point) = (Gl::TEXTURE_2D, Gl::COLOR_ATTACHMENT0);
        gl.framebuffer_texture_2d(Gl::FRAMEBUFFER, point, target, Some(&result.texture), 0);
        match gl.get_error() {
            Gl::NO_ERROR => {
                // ANGLE on SwiftShader may give a new texture the texels of a deleted one.
                result.fill(0);
                Ok(result)
            }
            Gl::OUT_OF_MEMORY => refuse(format!("{adapter} has no memory left for the mesh")),
            Gl::CONTEXT_LOST_WEBGL => Err(lost(gl)),
            code => Err(Error::Device { message: format!("WebGL2 reports the error {code:#06x}") }),
        }
    }

    /// Columns and rows that have at least the first `count` texels.
    pub(super) fn part(&self, count: usize) -> (u32, u32) {
        let width = self.size.0;
        (width.min(count as u32), (count as u32).div_ceil(width))
    }

    /// Fills all texels with one word.
    pub(super) fn fill(&self, word: u32) {
        self.gl.bind_framebuffer(Gl::FRAMEBUFFER, Some(&self.framebuffer));
        self.gl.clear_bufferuiv_with_u32_array(Gl::COLOR, 0, &[word; 4]);
    }

    /// Writes texels from the first on, row by row, and fills the last row with zeros.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) fn write(&self, mut words: Vec<u32>) -> Result<(), Error> {
        let row = self.size.0 as usize * self.words;
        let rows = words.len().div_ceil(row);
        words.resize(rows * row, 0);
        let format = if self.words == 1 { Gl::RED_INTEGER } else { Gl::RGBA_INTEGER };
        self.gl.active_texture(Gl::TEXTURE0);
        self.gl.bind_texture(Gl::TEXTURE_2D, Some(&self.texture));
        let (width, height) = (self.size.0 as i32, rows as i32);
        let pixels = Uint32Array::from(words.as_slice());
        self.gl
            .tex_sub_image_2d_with_i32_and_i32_and_u32_and_type_and_opt_array_buffer_view(
                Gl::TEXTURE_2D,
                0,
                0,
                0,
                width,
                height,
                format,
                Gl::UNSIGNED_INT,
                Some(&pixels),
            )
            .map_err(|_| lost(&self.gl))
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        self.gl.delete_framebuffer(Some(&self.framebuffer));
        self.gl.delete_texture(Some(&self.texture));
    }
}

/// Two equal textures: a pass reads the front and writes the back.
pub(super) struct Pair {
    pub(super) front: Texture,
    pub(super) back: Texture,
}

impl Pair {
    /// Exchanges front and back, so that the next pass reads what this one wrote.
    pub(super) fn swap(&mut self) {
        std::mem::swap(&mut self.front, &mut self.back);
    }
}
