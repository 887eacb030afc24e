// The claims of the rounds that untangle, and what these write, as src/untangle/frame/rounds.rs.
#import mesh
#import star_counts
#import state

const LIFTS: u32 = 16u;
const PUTS: u32 = 10u;
const STRAYS: u32 = 4u;
const HOME: u32 = LIFTS + PUTS + STRAYS;
const KEY_BITS: u32 = 27u;

// In the buffer of the choices: a claim for each vertex; the list of turned triangles, each 8 times its number, plus a
// bit for each of its corners that claims; from the end on, the vertices that are out, by the first of their slots.
//
// The corners of an empty slot are NONE. Twins of the first slot of a vertex that is out: a slot near it; the vertex; its
// second slot. Of the second: a slot near it; the triangle that its walk has come to; the triangle that it claims.
@group(0) @binding(5) var<storage, read_write> claims: array<atomic<u32>>;

// The round.
var<private> number: u32;

// The bits of the gains in a key, between those of the round and those of the vertex.
fn gains() -> u32 {
    return (1u << KEY_BITS) - (1u << vertex_bits());
}

fn vertex_bits() -> u32 {
    return 32u - countLeadingZeros(params.vertices - 1u);
}

fn claim_key(v: u32, gain: u32) -> u32 {
    let hash = (v * 0x9e3779b1u) & ((1u << vertex_bits()) - 1u);
    return ((HOME - number) << KEY_BITS) + gains() - min(gain << vertex_bits(), gains()) + hash;
}

// The claim of a vertex for itself, if it has kept it; else NONE.
fn own_claim(v: u32) -> u32 {
    var word = NONE;
    if v != NONE {
        word = atomicLoad(&claims[v]);
    }
    return select(NONE, word, (word | gains()) == claim_key(v, 0u));
}

fn has_several_fans(v: u32) -> bool {
    var has = false;
    if has_fans() {
        has = fan_entry(v) != NONE;
    }
    return has;
}

fn set_triangle(slot: u32, vertices: vec3u) {
    for (var i = 0u; i < 3u; i++) {
        triangles[3u * slot + i] = vertices[i];
        if vertices[i] < counted_vertices() {
            atomicAdd(&frontier[word_of(vertices[i], CROSSINGS)], NOT_EMBEDDED);
        }
    }
    if params.changes > 0u {
        topology[params.changes + slot] = params.update;
    }
}

fn set_record(slot: u32, words: vec3u) {
    for (var i = 0u; i < 3u; i++) {
        set_twin_entry(3u * slot + i, words[i]);
    }
}

fn join(h: u32, entry: u32) {
    set_twin_entry(h, entry);
    if entry != NONE {
        set_twin_entry(unflagged(entry), h | (entry & FLAGS));
    }
}
