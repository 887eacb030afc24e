// Lift: a vertex of a turned triangle leaves the mesh, and triangles fill its link, as src/untangle/frame/lift.rs.
#import areas
#import claims
#import guard
#import history_write
#import mesh
#import star_counts
#import state

const MOST: u32 = 16u;
const FIRST_MOST: u32 = 5u;
const LARGE: u32 = 64u;
const BIAS: u32 = 4u;
const NEVER: u32 = 15u;

// The star of a vertex: the corners around it, from that of its lowest turned triangle on; a bit for each turned triangle;
// and the vertices of its link.
var<private> degree: u32;
var<private> corners: array<u32, MOST>;
var<private> turned: u32;
var<private> ring: array<u32, MOST>;
// For each side or chord of the link, from its first corner to its last, a byte: MOST times how few turned triangles fill
// the part between them, plus the third corner of its triangle.
var<private> chords: array<u32, MOST * MOST / 4u>;

// The most triangles of a star that is lifted in this round.
fn most() -> u32 {
    return min(MOST, FIRST_MOST + number);
}

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
        is_whole = degree < most() && u != v && !has_several_fans(u) && entry < LOCKED && (turned & 1u) == 1u &&
            area != UNDECIDED_AREA && (area == POSITIVE_AREA || h / 3u >= corner / 3u);
        degree++;
        h = entry;
    }
    return is_whole && degree > 2u;
}

fn chord(i: u32, j: u32) -> u32 {
    return (chords[(MOST * i + j) / 4u] >> (8u * (j % 4u))) & 255u;
}

fn cost(i: u32, j: u32) -> u32 {
    return chord(i, j) / MOST;
}

// Finds the costs of the chords, and their third corners. `looks`: whether to look for other edges between their ends.
fn find_costs(looks: bool) {
    let last = degree - 1u;
    for (var length = 1u; length <= last; length++) {
        for (var i = 0u; i + length <= last; i++) {
            let j = i + length;
            var least = select(MOST * NEVER, 0u, length == 1u);
            if length == last || !looks || !are_joined(next(corners[i]), next(corners[j]), LARGE) {
                for (var k = i + 1u; k < j; k++) {
                    var sum = cost(i, k) + cost(k, j);
                    if sum < least / MOST {
                        let area = area_at(corners[0] / 3u, vec3u(ring[i], ring[k], ring[j]), true);
                        sum += select(1u, 0u, area == POSITIVE_AREA);
                        least = min(least, MOST * sum + k);
                    }
                }
            }
            let at = (MOST * i + j) / 4u;
            chords[at] = insertBits(chords[at], least, 8u * (j % 4u), 8u);
        }
    }
}

// Finds the costs without chords that would join two vertices a second time. Mostly there are none, so only the chords of
// the best filling are tested first: without the others, it stays the best. Returns the cost of the whole link.
fn plan() -> u32 {
    find_costs(false);
    var open = array<u32, MOST>();
    open[0] = degree - 1u;
    var count = 1u;
    while count > 0u {
        count--;
        let i = open[count] / MOST;
        let j = open[count] % MOST;
        let k = chord(i, j) % MOST;
        if j - i < degree - 1u && are_joined(next(corners[i]), next(corners[j]), LARGE) {
            find_costs(true);
            break;
        }
        if k > i + 1u {
            open[count] = MOST * i + k;
            count++;
        }
        if j > k + 1u {
            open[count] = MOST * k + j;
            count++;
        }
    }
    return cost(0u, degree - 1u);
}

// Claims, for a corner of a turned triangle, the link of its vertex, and notes so in the list. Or, if it `acts`, takes the
// vertex out, if it has kept the claims. Returns whether it does.
fn lift(item: u32, acts: bool) -> bool {
    let at = turned_list() + item / 3u;
    let bit = 1u << (item % 3u);
    let entry = atomicLoad(&claims[at]);
    let corner = 3u * (entry / 8u) + item % 3u;
    let v = vertex(corner);
    var key = NONE;
    if acts && (entry & bit) != 0u {
        key = own_claim(v);
    }
    var does = (!acts || key != NONE) && read_star(corner);
    for (var n = 0u; n < degree && acts && does; n++) {
        does = atomicLoad(&claims[ring[n]]) == key;
    }
    if does {
        let least = plan();
        let gain = countOneBits(turned) + BIAS;
        does = least < NEVER;
        if acts {
            fill(v);
        } else if does {
            key = claim_key(v, gain - min(gain, least));
            atomicMin(&claims[v], key);
            for (var n = 0u; n < degree; n++) {
                atomicMin(&claims[ring[n]], key);
            }
        }
    }
    if !acts && does {
        atomicOr(&claims[at], bit);
    } else if !acts {
        atomicAnd(&claims[at], ~bit);
    }
    return does;
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
        let k = chord(i, j) % MOST;
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
