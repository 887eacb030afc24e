// The history, for kernels that write it.

// state.wgsl defines its words.
@group(0) @binding(7) var<storage, read_write> history: array<atomic<u32>>;

fn history_word(i: u32) -> u32 {
    return atomicLoad(&history[i]);
}
