//! The kinds of engines, and their names.

use std::fmt;

/// Which engine ran, or which engine an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EngineKind {
    /// The CPU engine.
    Cpu,
    /// The engine on WebGPU compute shaders.
    Gpu,
    /// The engine on WebGL2, in a browser.
    WebGl,
}

impl EngineKind {
    /// The name in results and messages: `cpu`, `gpu` or `webgl2`. In the npm package `gpu` is `webgpu`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Gpu if cfg!(all(target_arch = "wasm32", feature = "js-values")) => "webgpu",
            Self::Gpu => "gpu",
            Self::WebGl => "webgl2",
        }
    }
}

impl fmt::Display for EngineKind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}
