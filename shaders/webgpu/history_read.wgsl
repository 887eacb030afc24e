// The history, for kernels that only read it: a word that all invocations read as an atomic takes long.

// What its words are, state.wgsl says.
@group(0) @binding(7) var<storage, read_write> history: array<u32>;

fn history_word(i: u32) -> u32 {
    return history[i];
}

// Steps in which one of two stars is walked alone, see guard.wgsl: in a sweep few of many edges are at a pole.
const ALONE: u32 = 16u;
