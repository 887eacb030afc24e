// The history, for kernels that write it.

// What its words are, state.wgsl says.
@group(0) @binding(7) var<storage, read_write> history: array<atomic<u32>>;

fn history_word(i: u32) -> u32 {
    return atomicLoad(&history[i]);
}

// Steps in which one of two stars is walked alone, see guard.wgsl: none, as the tail has few edges at a time to wait for.
const ALONE: u32 = 0u;
