// The history, for kernels that only read it: atomic reads of the same word by all invocations are slow.

// state.wgsl defines its words.
@group(0) @binding(7) var<storage, read_write> history: array<u32>;

fn history_word(i: u32) -> u32 {
    return history[i];
}
