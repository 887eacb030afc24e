// The history, for kernels that only read it: a word that all invocations read as an atomic takes long.

// state.wgsl says what its words mean.
@group(0) @binding(7) var<storage, read_write> history: array<u32>;

fn history_word(i: u32) -> u32 {
    return history[i];
}
