// Keeps track of what waits for exact arithmetic: such a triangle has DOUBTFUL as its choice, and each chunk of as many
// triangles as a workgroup has invocations has a bit that says whether it holds one. Mostly few do, and a look at every
// triangle would take longer than deciding those.
#import mesh
#import state

// Chunks that are looked at together in a sweep.
const CHUNKS: u32 = 8u;

// What a step of a submission is about: an iteration, the one that the tail has paused in, the census or what comes before
// the first iteration.
const ITERATE: u32 = 0u;
const RESUME: u32 = 1u;
const CENSUS: u32 = 2u;
const PREPARE: u32 = 3u;

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

fn clear_doubts(first: u32, stride: u32) {
    for (var i = doubts() + first; i < arrayLength(&frontier); i += stride) {
        atomicStore(&frontier[i], 0u);
    }
}

// The choice of a triangle in a sweep that is no iteration: none, or to wait.
fn wait_for(t: u32, is_left: bool) -> u32 {
    if is_left {
        doubt(t / WORKGROUP_SIZE);
    }
    return select(NONE, DOUBTFUL, is_left);
}

// Where a triangle waits: choices go on after a census, selections do not.
fn place_of_wait(t: u32) -> u32 {
    return t + select(0u, params.triangles, step_.task == CENSUS);
}

// Verdicts in one word, which is no half-edge with a side of its triangle: three bits each.
const PACKED: u32 = 0xc0000000u;

fn packed(verdicts: vec3u) -> u32 {
    return PACKED | verdicts.x | (verdicts.y << 3u) | (verdicts.z << 6u);
}

fn is_packed(word: u32) -> bool {
    return word >= PACKED && word < PACKED + 512u;
}

fn unpacked(word: u32) -> vec3u {
    return vec3u(word & 7u, (word >> 3u) & 7u, (word >> 6u) & 7u);
}
