// The state of a mesh in buffers, as src/engine/webgpu binds it for the phases.
#import choices if reads
#import choices if writes
#import mesh
#import three_axes if space
#import two_axes if plane

const WORKGROUP_SIZE: u32 = 256u;

struct Params {
    // The signs that occur among the triangles, in 2D: a bit for each sign, and UNEMBEDDED. If the winding is known, the signs are
    // relative to it. The device writes this word and the next two before the first iteration.
    signs: u32,
    // The span of all points while the mesh moves, see moving.wgsl.
    highest: u32,
    depth: u32,
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
    // What the host knows of the winding of the components: one of the constants below.
    winding: u32,
    // The number of the update while the mesh moves, from 1 on; else 0.
    update: u32,
    // The offset in `topology` of the updates in which the triangles last changed; 0 if nobody asks for them.
    changes: u32,
    // 1 if the update untangles. In the npm package none does.
    untangles: u32,
    // |cos β| is exactly mantissa / power: eight digits each, as in numbers.wgsl.
    cos_digits: array<vec4i, 4>,
    // The limit for the deviation: the words of a coordinate, and rounded to f32 for the filter.
    deviation: vec4u,
}

// Bits of signs. The bit between them is for flat triangles.
const NEGATIVE: u32 = 1u;
const POSITIVE: u32 = 4u;
// Set if some star is not known to be embedded.
const UNEMBEDDED: u32 = 8u;

// The host knows nothing of the winding: then all triangles have the same, which `signs` tells.
const WINDING_UNKNOWN: u32 = 0u;
// The winding bits are valid.
const WINDING_BITS: u32 = 1u;
// All components are clockwise.
const WINDING_CLOCKWISE: u32 = 2u;
// None is.
const WINDING_COUNTER_CLOCKWISE: u32 = 3u;

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
// Binding 5 is the choices, see choices.wgsl; before them, the claims, see untangle.wgsl.
// Two lists of triangles that alternate between iterations; for each triangle a stamp, the iteration in which it is
// due; one more stamp, for neighbours that are NONE; a bit for each chunk of triangles, see `doubt`.
@group(0) @binding(6) var<storage, read_write> frontier: array<atomic<u32>>;
// Binding 7 is the history, see history_read.wgsl and history_write.wgsl.
// Winding bits, then the bits of the embedded stars, then the table of the fans, then the updates in which the triangles
// last changed, if somebody asks for them.
@group(0) @binding(8) var<storage, read_write> topology: array<u32>;

// Words of the history: the counts; 1 plus the index of the iteration in which the tail has paused, or 0; how many
// vertices have several fans; the flips of all updates, as a low and a high word; the entries. An entry is about the
// iteration before the one that reads it.
const COUNTED: u32 = 0u;
const COUNTS: u32 = 11u;
const PAUSED: u32 = 11u;
const SEVERAL_FANS: u32 = 12u;
const FLIPPED: u32 = 13u;
const ENTRIES: u32 = 15u;
// In the preparation: the signs; the span of all points; if it untangles, how many triangles the list has of those that are
// turned over or flat, and how many vertices are out. The list follows the claims, in the buffer of the choices.
const HIGHEST: u32 = 1u;
const DEPTH: u32 = 2u;
const TURNED: u32 = 3u;
const LOOSE: u32 = 4u;
const ENTRY_WORDS: u32 = 4u;
const FLIPS: u32 = 0u;
// The length of the list of due triangles, if there is one.
const LENGTH: u32 = 1u;
// How the iteration finds the triangles that are due: one of the constants below.
const DUE: u32 = 2u;
// Whether the iteration ran at all.
const RAN: u32 = 3u;

// By their stamps; by a list; or all triangles are due, because most of them would be anyway.
const STAMPED: u32 = 0u;
const LISTED: u32 = 1u;
const ALL: u32 = 2u;

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

fn stamp_index(t: u32) -> u32 {
    return 2u * params.triangles + min(t, params.triangles);
}

// Words of a position, one for each axis.
fn coordinates(i: u32) -> vec3u {
    let at = DIMENSION * i;
    return vec3u(positions[at], positions[at + 1u], select(0u, positions[at + DIMENSION - 1u], DIMENSION == 3u));
}

fn is_clockwise(t: u32) -> bool {
    var clockwise = params.winding == WINDING_CLOCKWISE;
    if params.winding == WINDING_BITS {
        clockwise = ((topology[t / 32u] >> (t % 32u)) & 1u) == 1u;
    }
    return clockwise || (params.winding == WINDING_UNKNOWN && (params.signs & NEGATIVE) != 0u);
}

// Whether the star of a vertex is known to be embedded, see embedded.wgsl.
fn is_embedded(v: u32) -> bool {
    return !has_selection() || (DIMENSION == 2u && ((topology[params.embedded + v / 32u] >> (v % 32u)) & 1u) == 1u);
}

// Whether Select has to look for flips that make the same edge. If all stars are embedded, there are none.
fn has_selection() -> bool {
    return DIMENSION == 3u || (params.signs & UNEMBEDDED) != 0u;
}

// Whether all triangles have the strict sign of the winding: then no edge that is not Delaunay can fold.
fn is_strict() -> bool {
    let signs = params.signs & ~UNEMBEDDED;
    return signs == POSITIVE || (params.winding == WINDING_UNKNOWN && signs == NEGATIVE);
}

// The offset of the list of turned triangles, after a claim for each vertex: those are NONE where choices were.
fn turned_list() -> u32 {
    return max(params.triangles, params.vertices);
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
