// The state of a mesh on the device, as src/engine/webgpu binds it for the phases.

const NONE: u32 = 0xffffffffu;
const BLOCKED: u32 = 0xfffffffeu;
// Set in both twin entries of an edge that was over β in the input: it stays, whatever its angle becomes.
const CREASE: u32 = 0x80000000u;
const WORKGROUP_SIZE: u32 = 256u;

// The verdict on an interior edge; a blocked one is BLOCKED_BY plus the index of its reason.
const DELAUNAY: u32 = 0u;
const LABELLED: u32 = 1u;
const BLOCKED_BY: u32 = 2u;
const REASON_ANGLE: u32 = 0u;
const REASON_FOLD: u32 = 1u;
const REASON_DUPLICATE: u32 = 2u;

struct Params {
    dimension: u32,
    vertices: u32,
    triangles: u32,
    // The number of the batch's first iteration.
    first: u32,
    // Where the fans' table begins in `topology`, how long it is, and how many words of it are per vertex.
    fans: u32,
    fans_length: u32,
    // Words of winding bits at the start of `topology`; none if every component is counter-clockwise.
    winding_length: u32,
    // The first entry of the tail.
    tail: u32,
    // cos β: rounded to f32 for the filter; exactly, its sign, and the square mantissa^2 / 2^shift.
    cos: f32,
    cos_sign: i32,
    cos_shift: u32,
    tail_iterations: u32,
    // The longest list that the tail takes.
    tail_length: u32,
    // An iteration builds the list for the next one if the one before it made fewer flips than this.
    list_below: u32,
    cos_square: vec4u,
}

struct Step {
    // The iteration's index in the batch.
    index: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> step_: Step;
// f32 coordinates as bits: the exact tests read integers.
@group(0) @binding(2) var<storage, read> positions: array<u32>;
@group(0) @binding(3) var<storage, read_write> triangles: array<u32>;
@group(0) @binding(4) var<storage, read_write> twins: array<u32>;
// best[t] at t, selected[t] at triangles + t.
@group(0) @binding(5) var<storage, read_write> choices: array<u32>;
// Two lists of triangles that change places with every iteration, then a stamp for each triangle.
@group(0) @binding(6) var<storage, read_write> frontier: array<atomic<u32>>;
// The census, then an entry for the state before each iteration of a batch.
@group(0) @binding(7) var<storage, read_write> history: array<atomic<u32>>;
// Winding bits, then the table of the fans.
@group(0) @binding(8) var<storage, read_write> topology: array<u32>;

// Words of the history. An entry tells of the iteration before it.
const CENSUS: u32 = 0u;
const ENTRIES: u32 = 4u;
const ENTRY_WORDS: u32 = 4u;
const FLIPS: u32 = 0u;
// Length of the list of the triangles to look at; meaningful where it was built.
const LENGTH: u32 = 1u;
const BUILT: u32 = 2u;
// Whether the iteration ran at all.
const RAN: u32 = 3u;

fn next(h: u32) -> u32 {
    return select(h + 1u, h - 2u, h % 3u == 2u);
}

fn prev(h: u32) -> u32 {
    return select(h - 1u, h + 2u, h % 3u == 0u);
}

// The half-edge that an entry of `twins` names, without its flag.
fn unflagged(entry: u32) -> u32 {
    return select(entry & ~CREASE, NONE, entry == NONE);
}

fn twin(h: u32) -> u32 {
    return unflagged(twins[h]);
}

fn is_crease(h: u32) -> bool {
    return twins[h] >= CREASE && twins[h] != NONE;
}

fn best(t: u32) -> u32 {
    return choices[t];
}

fn selected(t: u32) -> u32 {
    return choices[params.triangles + t];
}

fn is_clockwise(t: u32) -> bool {
    return t / 32u < params.winding_length && ((topology[t / 32u] >> (t % 32u)) & 1u) == 1u;
}

// The priority of an edge in an iteration; the smallest wins.
fn key(edge: u32, iteration: u32) -> u32 {
    var x = edge ^ (iteration * 0x9e3779b9u);
    x = (x ^ (x >> 16u)) * 0x7feb352du;
    x = (x ^ (x >> 15u)) * 0x846ca68bu;
    return x ^ (x >> 16u);
}
