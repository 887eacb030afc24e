// Lists and history, for kernels that write them.

// Two lists of triangles that change places with every iteration, then a stamp for each triangle.
@group(0) @binding(6) var<storage, read_write> frontier: array<atomic<u32>>;
// The census, then an entry for the state before each iteration of a batch.
@group(0) @binding(7) var<storage, read_write> history: array<atomic<u32>>;

fn history_word(i: u32) -> u32 {
    return atomicLoad(&history[i]);
}

fn frontier_word(i: u32) -> u32 {
    return atomicLoad(&frontier[i]);
}
