// Lift: a vertex of a turned triangle leaves the mesh, and triangles fill its link, as src/untangle/frame/lift.rs.
#import areas
#import claims
#import guard
#import history_write
#import mesh
#import star_counts
#import state

const MOST: u32 = 16u;
const LARGE: u32 = 64u;
const BIAS: u32 = 4u;
const NEVER: u32 = 15u;

// The star of a vertex: the corners around it, from that of its lowest turned triangle on; a bit for each turned triangle;
// and the vertices of its link.
var<private> degree: u32;
var<private> corners: array<u32, MOST>;
var<private> turned: u32;
var<private> ring: array<u32, MOST>;
// For each side or chord of the link, from its first corner to its last: MOST times how few turned triangles fill the part
// between them, plus the third corner of its triangle.
var<private> chords: array<u32, MOST * MOST>;

// Reads the star of the vertex that a corner starts at. Returns whether the vertex can be lifted.
fn read_star(corner: u32) -> bool {
    let v = vertex(corner);
    var h = corner;
    var is_whole = v != NONE && !has_several_fans(v);
    degree = 0u;
    turned = 0u;
    while is_whole && (degree == 0u || h != corner) {
        let u = vertex(next(h));
        let entry = twin_entry(prev(h));
        let area = area_of(h / 3u, true);
        corners[min(degree, MOST - 1u)] = h;
        ring[min(degree, MOST - 1u)] = u;
        turned |= select(0u, 1u << degree, area < UNDECIDED_AREA);
        is_whole = degree < MOST && u != v && !has_several_fans(u) && entry < LOCKED && (turned & 1u) == 1u &&
            area != UNDECIDED_AREA && (area == POSITIVE_AREA || h / 3u >= corner / 3u);
        degree++;
        h = entry;
    }
    return is_whole && degree > 2u;
}

fn cost(i: u32, j: u32) -> u32 {
    return chords[MOST * i + j] / MOST;
}

// Finds the costs of the chords, and their third corners. Returns the cost of the whole link.
fn find_costs() -> u32 {
    let last = degree - 1u;
    for (var length = 1u; length <= last; length++) {
        for (var i = 0u; i + length <= last; i++) {
            let j = i + length;
            var least = select(MOST * NEVER, 0u, length == 1u);
            if length == last || (length > 1u && !are_joined(next(corners[i]), next(corners[j]), LARGE)) {
                for (var k = i + 1u; k < j; k++) {
                    var sum = cost(i, k) + cost(k, j);
                    if sum < least / MOST {
                        let area = area_at(corners[0] / 3u, vec3u(ring[i], ring[k], ring[j]), true);
                        sum += select(1u, 0u, area == POSITIVE_AREA);
                        least = min(least, MOST * sum + k);
                    }
                }
            }
            chords[MOST * i + j] = least;
        }
    }
    return cost(0u, last);
}

// Claims, for a turned triangle, the link of the best of its vertices. Or, if it `acts`, takes the vertex out that it has
// claimed for, if it has kept its claims. Returns whether it claims.
fn lift(at: u32, acts: bool) -> bool {
    let entry = atomicLoad(&claims[at]);
    let h = entry - entry / 4u;
    var best = NONE;
    var k = 3u;
    if acts && entry % 4u < 3u {
        k = entry % 4u;
        best = own_claim(vertex(h));
    }
    // The last one is the best one again.
    for (var i = select(0u, 3u, acts); i < 3u || (i == 3u && best != NONE); i++) {
        let corner = h - entry % 4u + select(i, k, i == 3u);
        let v = vertex(corner);
        if read_star(corner) {
            let gain = countOneBits(turned) + BIAS;
            var is_kept = acts;
            for (var n = 0u; n < degree && i == 3u; n++) {
                if acts {
                    is_kept = is_kept && atomicLoad(&claims[ring[n]]) == best;
                } else {
                    atomicMin(&claims[ring[n]], best);
                }
            }
            if select(claim_key(v, gain) < best, is_kept, i == 3u) {
                let least = find_costs();
                let mine = claim_key(v, gain - min(gain, least));
                if i == 3u {
                    fill(v);
                } else if least < NEVER && mine < best {
                    best = mine;
                    k = i;
                }
            }
        }
    }
    if !acts {
        atomicStore(&claims[at], entry - entry % 4u + k);
        if k < 3u {
            atomicMin(&claims[vertex(h - entry % 4u + k)], best);
        }
    }
    return k < 3u;
}

fn fill(v: u32) {
    var slots = array<u32, MOST>();
    var outer = array<u32, MOST>();
    var first = 0u;
    for (var half = 0u; half < 2u; half++) {
        for (var i = 0u; i < degree; i++) {
            if ((turned >> i) & 1u) != half {
                slots[first] = corners[i] / 3u;
                first++;
            }
            outer[i] = twin_entry(next(corners[i]));
        }
    }
    first = 0u;
    var end = degree;
    var near = NONE;
    // Two corners of a side or chord, and the entry on its other side.
    var open = array<vec2u, MOST>();
    open[0] = vec2u(degree - 1u, outer[degree - 1u]);
    var count = 1u;
    while count > 0u {
        count--;
        let side = open[count];
        let i = side.x / MOST;
        let j = side.x % MOST;
        let k = chords[side.x] % MOST;
        var slot = slots[first];
        if cost(i, j) == cost(i, k) + cost(k, j) {
            end--;
            slot = slots[end];
        } else {
            first++;
        }
        near = select(near, slot, near == NONE);
        set_triangle(slot, vec3u(ring[i], ring[k], ring[j]));
        join(3u * slot + 2u, side.y);
        for (var m = 0u; m < 2u; m++) {
            let begin = select(i, k, m == 1u);
            let to = select(k, j, m == 1u);
            if to == begin + 1u {
                join(3u * slot + m, outer[begin]);
            } else {
                open[count] = vec2u(MOST * begin + to, 3u * slot + m);
                count++;
            }
        }
    }
    let one = slots[first];
    let other = slots[first + 1u];
    set_triangle(one, vec3u(NONE));
    set_triangle(other, vec3u(NONE));
    set_record(one, vec3u(near, v, other));
    set_record(other, vec3u(near, near, NONE));
    atomicStore(&claims[2u * params.triangles - 1u - atomicAdd(&history[LOOSE], 1u)], one);
}
