// The state of a mesh in buffers, as src/engine/webgpu binds it for the phases.
#import mesh
#import three_axes if space
#import two_axes if plane

const WORKGROUP_SIZE: u32 = 256u;

struct Params {
    // The signs that occur among the triangles, in 2D: a bit for each sign. The device writes this word before the
    // first iteration.
    signs: u32,
    vertices: u32,
    triangles: u32,
    // The index of the batch's first iteration.
    first: u32,
    // The offset of the table of the fans in `topology`, and its length.
    fans: u32,
    fans_length: u32,
    // The index in the submission of the first iteration of the tail.
    tail: u32,
    // cos β, rounded to f32 for the filter, and its sign.
    cos: f32,
    cos_sign: i32,
    // 1 if β is 180°.
    any_angle: u32,
    tail_iterations: u32,
    // The longest list that the tail takes.
    tail_length: u32,
    // An iteration builds the list for the next iteration if the iteration before made fewer flips than this.
    list_below: u32,
    // The offset of the bits of the vertices in `topology`, in 2D.
    embedded: u32,
    // 1 if the winding bits are known before the preparation.
    knows_winding: u32,
    // 1 if an invocation of decide.wgsl decides one triangle per dispatch.
    decides_one: u32,
    // |cos β| is exactly mantissa / power: eight digits each, as in numbers.wgsl.
    cos_digits: array<vec4i, 4>,
    // The limit for the deviation: the words of a coordinate, and rounded to f32 for the filter.
    deviation: vec4u,
}

// Bits of signs. The bit between them is for flat triangles.
const NEGATIVE: u32 = 1u;
const POSITIVE: u32 = 4u;

struct Step {
    // The iteration's index in the batch.
    index: u32,
    // See doubts.wgsl.
    task: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> step_: Step;
// floats.wgsl and fixed_point.wgsl define the layout: the exact tests read integers.
@group(0) @binding(2) var<storage, read> positions: array<u32>;
@group(0) @binding(3) var<storage, read_write> triangles: array<u32>;
@group(0) @binding(4) var<storage, read_write> twins: array<u32>;
// The choice of Label for each triangle, then the choice of Select, see `flip_of`.
@group(0) @binding(5) var<storage, read_write> choices: array<u32>;
// Two lists of triangles that alternate between iterations; for each triangle a stamp, the iteration in which it is
// due; one more stamp, for neighbours that are NONE; a bit for each chunk of triangles, see `doubt`.
@group(0) @binding(6) var<storage, read_write> frontier: array<atomic<u32>>;
// Binding 7 is the history, see history_read.wgsl and history_write.wgsl.
// Winding bits, which are valid only if triangles have both signs, then the bits of the embedded stars, then the table
// of the fans.
@group(0) @binding(8) var<storage, read_write> topology: array<u32>;

// Words of the history: the counts; 1 plus the index of the iteration in which the tail has paused, or 0; how many
// vertices have several fans; the entries. An entry is about the iteration before the one that reads it.
const COUNTED: u32 = 0u;
const COUNTS: u32 = 6u;
const PAUSED: u32 = 6u;
const SEVERAL_FANS: u32 = 7u;
const ENTRIES: u32 = 8u;
const ENTRY_WORDS: u32 = 4u;
const FLIPS: u32 = 0u;
// The length of the list of due triangles, if it was built.
const LENGTH: u32 = 1u;
const BUILT: u32 = 2u;
// Whether the iteration ran at all.
const RAN: u32 = 3u;

fn vertex(h: u32) -> u32 {
    return triangles[h];
}

// The half-edge on the other side, with its flags, or NONE.
fn twin_entry(h: u32) -> u32 {
    return twins[h];
}

fn set_twin_entry(h: u32, entry: u32) {
    twins[h] = entry;
}

fn twin(h: u32) -> u32 {
    return unflagged(twin_entry(h));
}

fn best(t: u32) -> u32 {
    return choices[t];
}

// The two half-edges of the selected edge of triangle `t`, its own one first; NONE if no edge is selected. The choice
// of Select has the other half-edge, and in the bits of the flags the index of its own half-edge in the triangle,
// 0 to 2.
fn flip_of(t: u32) -> vec2u {
    let entry = choices[params.triangles + t];
    return select(vec2u(3u * t + (entry >> 30u), entry & ~FLAGS), vec2u(NONE), entry == NONE);
}

fn set_flip(h: u32, g: u32) {
    choices[params.triangles + h / 3u] = g | ((h % 3u) << 30u);
}

fn clear_flip(t: u32) {
    choices[params.triangles + t] = NONE;
}

fn stamp_index(t: u32) -> u32 {
    return 2u * params.triangles + min(t, params.triangles);
}

// Words of a position, one for each axis.
fn coordinates(i: u32) -> vec3u {
    let at = DIMENSION * i;
    return vec3u(positions[at], positions[at + 1u], select(0u, positions[at + DIMENSION - 1u], DIMENSION == 3u));
}

fn is_clockwise(t: u32) -> bool {
    let has_both = are_both(params.signs);
    return (params.signs & NEGATIVE) != 0u && (!has_both || ((topology[t / 32u] >> (t % 32u)) & 1u) == 1u);
}

// Whether triangles have both signs. Then each component has its winding, which the host finds.
fn are_both(signs: u32) -> bool {
    return (signs & (NEGATIVE | POSITIVE)) == (NEGATIVE | POSITIVE);
}

// Whether the star of a vertex is known to be embedded, see embedded.wgsl.
fn is_embedded(v: u32) -> bool {
    return DIMENSION == 2u && ((topology[params.embedded + v / 32u] >> (v % 32u)) & 1u) == 1u;
}

// Whether all triangles are positive, or all are negative: then no edge that is not Delaunay can fold.
fn is_strict() -> bool {
    return params.signs == NEGATIVE || params.signs == POSITIVE;
}

fn has_fans() -> bool {
    return params.fans_length > 0u;
}

// A word of the table of the fans, see src/mesh/star.rs.
fn fan_entry(i: u32) -> u32 {
    return topology[params.fans + i];
}

fn has_any_angle() -> bool {
    return params.any_angle == 1u;
}

fn cos_rounded() -> f32 {
    return params.cos;
}

fn cos_sign() -> i32 {
    return params.cos_sign;
}

fn cos_digit(i: u32) -> i32 {
    return params.cos_digits[i / 4u][i % 4u];
}

fn deviation() -> vec4u {
    return params.deviation;
}
