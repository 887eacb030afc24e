// The history, for kernels that write it.

// What its words are, state.wgsl says.
@group(0) @binding(7) var<storage, read_write> history: array<atomic<u32>>;

fn history_word(i: u32) -> u32 {
    return atomicLoad(&history[i]);
}

// Writes the entry that the first iteration starts from: as if one before it had flipped something and built no list. Where
// the host has to help first, with windings or the table of the fans, nothing has flipped, and no iteration runs.
fn begin_history(needs_windings: bool) {
    let needs_fans = history_word(SEVERAL_FANS) > 0u && !has_fans();
    atomicStore(&history[entry(0u, FLIPS)], select(params.triangles, 0u, needs_windings || needs_fans));
    atomicStore(&history[entry(0u, RAN)], 1u);
}

// Steps in which one of two stars is walked alone, see guard.wgsl: none, as the tail has few edges at a time to wait for.
const ALONE: u32 = 0u;
