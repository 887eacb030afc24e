//! Why `auto` takes the CPU, in words.

/// Why it is the CPU where the GPU does not take the mesh for this reason.
pub(super) fn without_gpu(why: String) -> String {
    if cfg!(all(target_arch = "wasm32", feature = "js")) {
        return why + "; webgl2 is left out: it takes longer than the cpu";
    }
    why
}
