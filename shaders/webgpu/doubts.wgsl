// Keeps track of the triangles that wait for exact arithmetic: their choice is DOUBTFUL. A chunk has as many triangles
// as a workgroup has invocations; each chunk has a bit, set if one of its triangles waits. Mostly few triangles wait, or
// none, and visiting every triangle would take longer than deciding those few. A word after the bits is 1 if one is set.
#import mesh
#import state

// The task of a step of a submission: an iteration, the iteration in which the tail has paused, the census, or the
// preparation.
const ITERATE: u32 = 0u;
const RESUME: u32 = 1u;
const CENSUS: u32 = 2u;
const PREPARE: u32 = 3u;

// Triangles of a word of bits.
const CHUNK_WORD: u32 = 32u * WORKGROUP_SIZE;

// The offset of the bits.
fn doubts() -> u32 {
    return 3u * params.triangles + 1u;
}

// The offset after them.
fn end_of_doubts() -> u32 {
    return doubts() + (params.triangles + CHUNK_WORD - 1u) / CHUNK_WORD;
}

fn doubt(chunk: u32) {
    let bit = 1u << (chunk % 32u);
    let index = doubts() + chunk / 32u;
    if (atomicLoad(&frontier[index]) & bit) == 0u {
        atomicOr(&frontier[index], bit);
        atomicStore(&frontier[end_of_doubts()], 1u);
    }
}

fn has_doubts() -> bool {
    return atomicLoad(&frontier[end_of_doubts()]) == 1u;
}

fn is_doubtful(chunk: u32) -> bool {
    return ((atomicLoad(&frontier[doubts() + chunk / 32u]) >> (chunk % 32u)) & 1u) == 1u;
}

fn clear_doubts(first: u32, stride: u32) {
    for (var i = doubts() + first; i <= end_of_doubts(); i += stride) {
        atomicStore(&frontier[i], 0u);
    }
}

// The choice of a triangle in a sweep outside of iterations: NONE, or DOUBTFUL if the triangle waits.
fn wait_for(t: u32, is_left: bool) -> u32 {
    if is_left {
        doubt(t / WORKGROUP_SIZE);
    }
    return select(NONE, DOUBTFUL, is_left);
}

// The index at which a triangle waits. A census must keep the choices of Label, but not those of Select.
fn waiting_index(t: u32) -> u32 {
    return t + select(0u, params.triangles, step_.task == CENSUS);
}

// Verdicts packed into one word, four bits each. A choice of Select has the index of a side, 0 to 2, in the two
// highest bits. So no choice equals such a word, whose highest bits are 3.
const PACKED: u32 = 0xc0000000u;

fn packed(verdicts: vec3u) -> u32 {
    return PACKED | verdicts.x | (verdicts.y << 4u) | (verdicts.z << 8u);
}

fn is_packed(word: u32) -> bool {
    return word >= PACKED && word < PACKED + 4096u;
}

fn unpacked(word: u32) -> vec3u {
    return vec3u(word & 15u, (word >> 4u) & 15u, (word >> 8u) & 15u);
}
