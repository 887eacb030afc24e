// Which chunks of as many triangles as a workgroup has invocations hold one that waits for exact arithmetic: mostly few do,
// and a look at every triangle would take longer than deciding those.

// Chunks that a workgroup looks at together in a sweep.
const CHUNKS: u32 = 8u;

// Where the bits begin.
fn doubts() -> u32 {
    return 3u * params.triangles + 1u;
}

fn doubt(chunk: u32) {
    let bit = 1u << (chunk % 32u);
    let place = doubts() + chunk / 32u;
    if (atomicLoad(&frontier[place]) & bit) == 0u {
        atomicOr(&frontier[place], bit);
    }
}

// A bit for each of `count` chunks from `first` on, a multiple of the count.
fn doubtful_chunks(first: u32, count: u32) -> u32 {
    return (atomicLoad(&frontier[doubts() + first / 32u]) >> (first % 32u)) & ((1u << count) - 1u);
}
