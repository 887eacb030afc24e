// Finds the embedded stars in the plane by counting, as src/mesh/embedded.rs. Flips there need no guard. An open fan that
// crosses the axis once is embedded too, if its last direction comes before its first one.
#import begin
#import doubts
#import history_write
#import mesh
#import plane
#import points
#import spans
#import star_counts
#import state

var<workgroup> signs: atomic<u32>;

// Counts, in the memory of the lists, the crossings and boundary half-edges of each vertex. Also collects the signs of
// the triangles: bits 0 to 2 for negative, flat, positive. If the winding is not known, each triangle has the winding of
// its own sign: the counts are right if all triangles have the same sign. If it is known, the signs are relative to it.
// A triangle that is left alone counts as flat. The choice of a triangle is DOUBTFUL if exact arithmetic has to find its
// sign, else NONE.
@compute @workgroup_size(WORKGROUP_SIZE)
fn prepare_all(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    var all = vec2u();
    var found = 0u;
    for (var t = id.x; t < params.triangles; t += groups.x * WORKGROUP_SIZE) {
        let a = position(vertex(3u * t));
        let b = position(vertex(3u * t + 1u));
        let c = position(vertex(3u * t + 2u));
        let span = max(span_of(a), max(span_of(b), span_of(c)));
        all = max(all, span);
        let is_left_alone = params.update > 0u && is_too_wide(span);
        let sign = select(filtered_sign_of(a, b, c), 0, is_left_alone);
        let is_doubtful = sign == 0 && !is_left_alone;
        choices[t] = wait_for(t, is_doubtful);
        if params.triangles + t < params.vertices {
            choices[params.triangles + t] = NONE;
        }
        if !is_doubtful {
            found |= counted(t, sign, array(a, b, c));
        }
    }
    add_span(all, local);
    add_signs(found, local);
}

// Counts the triangles whose sign exact arithmetic has found: it is 1 less than their choice.
@compute @workgroup_size(WORKGROUP_SIZE)
fn count_turns(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    var found = 0u;
    for (var t = id.x; t < params.triangles; t += groups.x * WORKGROUP_SIZE) {
        let choice = choices[t];
        if choice != NONE {
            choices[t] = NONE;
            let a = position(vertex(3u * t));
            let b = position(vertex(3u * t + 1u));
            let c = position(vertex(3u * t + 2u));
            found |= counted(t, i32(choice) - 1, array(a, b, c));
        }
    }
    add_signs(found, local);
}

// Counts what a triangle adds to its vertices, and lists it if an update may have to untangle it. Returns the bit of its
// sign.
fn counted(t: u32, sign: i32, points: array<Point, 3>) -> u32 {
    let is_known = params.winding != WINDING_UNKNOWN;
    let winding = select(sign, select(1, -1, is_clockwise(t)), is_known);
    let is_positive = sign * winding > 0;
    var a = points[0];
    var b = points[1];
    var c = points[2];
    if !is_positive && params.untangles > 0u && !is_too_wide(max(span_of(a), max(span_of(b), span_of(c)))) {
        let at = turned_list() + atomicAdd(&history[TURNED], 1u);
        if at < 2u * params.triangles {
            choices[at] = 8u * t;
        }
    }
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let first = order(b, a);
        let last = order(c, a);
        // From below the axis, or on it, to above it; in a clockwise mesh the other way round.
        let from_below = select(last, first, winding > 0);
        let to_above = select(first, last, winding > 0);
        let is_below = from_below.y < 0 || (from_below.y == 0 && from_below.x > 0);
        let crossings = select(NOT_EMBEDDED, select(0u, 1u, is_below && is_above(to_above)), is_positive);
        let v = vertex(h);
        if crossings > 0u && v < counted_vertices() {
            atomicAdd(&frontier[word_of(v, CROSSINGS)], crossings);
        }
        if twin_entry(h) == NONE {
            note_boundary(v, vertex(next(h)), winding > 0);
        }
        let corner = a;
        a = b;
        b = c;
        c = corner;
    }
    return 1u << u32(select(sign, sign * winding, is_known) + 1);
}

// Notes the boundary half-edge from u to v.
fn note_boundary(u: u32, v: u32, is_counter_clockwise: bool) {
    if u < counted_vertices() {
        atomicAdd(&frontier[word_of(u, STARTS)], 1u);
        atomicStore(&frontier[word_of(u, select(LAST, FIRST, is_counter_clockwise))], v);
    }
    if v < counted_vertices() {
        atomicStore(&frontier[word_of(v, select(FIRST, LAST, is_counter_clockwise))], u);
    }
}

// Whether the star of a vertex is embedded. A vertex without triangles counts too.
fn is_star_embedded(v: u32) -> bool {
    let crossings = atomicLoad(&frontier[word_of(v, CROSSINGS)]);
    let starts = atomicLoad(&frontier[word_of(v, STARTS)]);
    var is_embedded = crossings + starts <= 1u;
    // With several fans, a closed one may have the crossing.
    if crossings == 1u && starts == 1u && history_word(SEVERAL_FANS) == 0u {
        let first = position(vertex_in(v, FIRST));
        let last = position(vertex_in(v, LAST));
        let is_first_above = is_above(order(first, position(v)));
        let is_last_above = is_above(order(last, position(v)));
        let is_before = filtered_sign_of(position(v), last, first) > 0;
        is_embedded = select(is_last_above, is_before, is_first_above == is_last_above);
    }
    return is_embedded;
}

fn vertex_in(v: u32, word: u32) -> u32 {
    return atomicLoad(&frontier[word_of(v, word)]);
}

// Whether a direction points above the axis, or along it to the left.
fn is_above(direction: vec3i) -> bool {
    return direction.y > 0 || (direction.y == 0 && direction.x < 0);
}

// Adds the signs that the invocations of a workgroup have found.
fn add_signs(found: u32, local: u32) {
    atomicOr(&signs, found);
    workgroupBarrier();
    if local == 0u {
        atomicOr(&history[COUNTED], atomicLoad(&signs));
    }
}

// The bits of as many vertices as a workgroup has invocations.
const WORDS: u32 = WORKGROUP_SIZE / 32u;
var<workgroup> bits: array<atomic<u32>, WORDS>;

// Writes a bit for each vertex, and notes whether some star is not embedded. All signs are known now, so the iterations
// can begin.
@compute @workgroup_size(WORKGROUP_SIZE)
fn mark_embedded(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_index) local: u32,
    @builtin(num_workgroups) groups: vec3u,
) {
    if group.x == 0u && local == 0u {
        let are_both = (history_word(COUNTED) & (NEGATIVE | POSITIVE)) == (NEGATIVE | POSITIVE);
        begin_history(are_both && params.winding == WINDING_UNKNOWN);
    }
    for (var first = group.x * WORKGROUP_SIZE; first < params.vertices; first += groups.x * WORKGROUP_SIZE) {
        if first + local < counted_vertices() && is_star_embedded(first + local) {
            atomicOr(&bits[local / 32u], 1u << (local % 32u));
        }
        workgroupBarrier();
        let begin = first + 32u * local;
        if local < WORDS && begin < params.vertices {
            let word = atomicExchange(&bits[local], 0u);
            topology[params.embedded + begin / 32u] = word;
            if countOneBits(word) < min(32u, params.vertices - begin) {
                atomicOr(&history[COUNTED], UNEMBEDDED);
            }
        }
        workgroupBarrier();
    }
}
