// The passes of the phases and of the census. `verdict_pass` visits all half-edges, most others visit all triangles.
// Triangles without changes around them keep their values. The exact tests contain loops. They are in `verdict_pass`,
// where they are not inside another loop, because compilers that inline everything take very long for nested loops.
#import guard
#import label
#import mesh
#import rounds
#import select
#import slot
#import state
#import verdict

// Side of the square of texels that one fragment sums.
const BLOCK: u32 = 8u;

// A triangle that covers the whole target.
@vertex
fn cover(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
    return vec4f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

// The verdict on the geometry of the edge of half-edge `h`. It is kept if neither of its triangles has flipped.
// `selections` are those of the iteration before.
@fragment
fn verdict_pass(@builtin(position) fragment: vec4f) -> @location(0) u32 {
    let h = index_at(fragment);
    var verdict = DELAUNAY;
    if h < 3u * params[0].x {
        let g = twin(h);
        verdict = textureLoad(verdicts, texel_at(h), 0).x;
        if g != NONE && h < g && (is_first_iteration() || selected(h / 3u) != NONE || selected(g / 3u) != NONE) {
            verdict = geometric_verdict(h, g);
        }
    }
    return verdict;
}

// The frontier: a triangle without a choice gets one only if it or a neighbour has flipped. `bests` and `selections`
// are those of the iteration before.
@fragment
fn label_pass(@builtin(position) fragment: vec4f) -> @location(0) u32 {
    let t = index_at(fragment);
    let around = textureLoad(twins, texel_at(t), 0);
    let is_active = best(t) != NONE || selected(t) != NONE
        || has_flipped(around.x) || has_flipped(around.y) || has_flipped(around.z);
    var choice = NONE;
    if t < params[0].x && is_active {
        choice = label(t, params[0].z, vec3u(known_verdict(3u * t), known_verdict(3u * t + 1u), known_verdict(3u * t + 2u)));
    }
    return choice;
}

// The verdict of `verdict_pass`; DELAUNAY for a half-edge without a twin, and for an edge that never flips.
fn known_verdict(h: u32) -> u32 {
    let g = twin_entry(h);
    var verdict = DELAUNAY;
    if g < LOCKED {
        verdict = textureLoad(verdicts, texel_at(min(h, g)), 0).x;
    }
    return verdict;
}

fn has_flipped(entry: u32) -> bool {
    return entry != NONE && selected(unflagged(entry) / 3u) != NONE;
}

@fragment
fn select_pass(@builtin(position) fragment: vec4f) -> @location(0) u32 {
    let t = index_at(fragment);
    var choice = NONE;
    if t < params[0].x {
        choice = selection(t, params[0].z);
    }
    return choice;
}

// Flip, into another texture: the vertices of a triangle.
@fragment
fn flip_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let t = index_at(fragment);
    var result = textureLoad(triangles, texel_at(t), 0);
    let flip = flip_of(t);
    if flip.x != NONE {
        result = with_component(result, next(flip.x) % 3u, vertex(prev(flip.y)));
    }
    return result;
}

// Update, into another texture: the twins of a triangle. It does not read the vertices.
@fragment
fn update_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let t = index_at(fragment);
    let old = textureLoad(twins, texel_at(t), 0);
    var entries = vec4u(slot(old.x), slot(old.y), slot(old.z), 0u);
    let flip = flip_of(t);
    if flip.x != NONE {
        entries = with_component(entries, next(flip.x) % 3u, next(flip.y));
        entries = with_component(entries, flip.x % 3u, slot(twin_entry(next(flip.y))));
    }
    return entries;
}

// The anchors of the fans, which come after one word per vertex.
@fragment
fn anchor_pass(@builtin(position) fragment: vec4f) -> @location(0) u32 {
    let i = index_at(fragment);
    var entry = fan_entry(i);
    if i >= params[0].y {
        entry = slot(entry);
    }
    return entry;
}

// Counts the interior edges of a triangle, each from its lower half-edge, by verdict: labelled, then blocked by angle,
// fold and duplicate.
@fragment
fn census_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let t = index_at(fragment);
    var result = vec4u();
    let end = select(3u * t, 3u * t + 3u, t < params[0].x);
    for (var h = 3u * t; h < end; h++) {
        let g = twin(h);
        if g != NONE && h < g {
            let verdict = vec4u(guarded(textureLoad(verdicts, texel_at(h), 0).x, h, g));
            result += vec4u(verdict == vec4u(LABELLED, LABELLED + 1u, LABELLED + 2u, LABELLED + 3u));
        }
    }
    return result;
}

// The rest of the census: how many interior edges are blocked by a lock, how many by the deviation, and how many are
// left alone while the mesh moves, for either reason.
@fragment
fn more_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let t = index_at(fragment);
    var result = vec4u();
    let end = select(3u * t, 3u * t + 3u, t < params[0].x);
    for (var h = 3u * t; h < end; h++) {
        let g = twin(h);
        if g != NONE && h < g {
            let verdict = vec4u(textureLoad(verdicts, texel_at(h), 0).x);
            let reasons = vec4u(REASON_LOCKED, REASON_DEVIATION, LEFT_AS_INFINITE - BLOCKED_BY, LEFT_AS_WIDE - BLOCKED_BY);
            result += vec4u(verdict == BLOCKED_BY + reasons);
        }
    }
    return result;
}

// The number of triangles in a block that have a selected edge.
@fragment
fn flips_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let first = vec2u(fragment.xy) * BLOCK;
    let end = min(first + vec2u(BLOCK), textureDimensions(selections));
    var result = vec4u();
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            result.x += u32(textureLoad(selections, vec2u(x, y), 0).x != NONE);
        }
    }
    return result;
}

// The sum of a block of counts, or of all counts if they are one block.
@fragment
fn sum_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let size = textureDimensions(counts);
    let is_last = size.x <= BLOCK && size.y <= BLOCK;
    let first = select(vec2u(fragment.xy) * BLOCK, vec2u(), is_last);
    let end = min(first + vec2u(BLOCK), size);
    var result = vec4u();
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            result += textureLoad(counts, vec2u(x, y), 0);
        }
    }
    return result;
}

// The entry point of rounds.wgsl.
@fragment
fn probe_pass() -> @location(0) vec4u {
    return vec4u(rounds());
}
