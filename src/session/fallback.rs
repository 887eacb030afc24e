//! Why `auto` takes the CPU, as a message.

/// The message for a GPU that failed or refused the mesh with `why`.
pub(super) fn without_gpu(why: String) -> String {
    if cfg!(all(target_arch = "wasm32", feature = "js")) {
        return why + "; webgl2 is left out: it takes longer than the cpu";
    }
    why
}
