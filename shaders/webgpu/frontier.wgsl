// Flips edges and builds the frontier: the triangles that are due in the next iteration. Triangles that have flipped,
// and their neighbours, are due; the neighbours are stamped. Triangles with an edge that was labelled and has not
// flipped, or that was blocked as a duplicate, are also due. The verdict on an edge changes only if one of its
// triangles has changed; but any flip may remove a duplicate.
#import active
#import flip
#import history_write
#import mesh
#import state

// How the next iteration finds the triangles that are due.
fn due_after(index: u32) -> u32 {
    let flips = history_word(entry(index, FLIPS));
    return select(select(STAMPED, ALL, flips > params.triangles / 8u), LISTED, flips < params.list_below);
}

// Flips the selected edge of triangle `t`, from its lower half-edge, and marks the triangles that are due. Returns the
// number of flips.
fn flip_triangle(t: u32, index: u32, iteration: u32, next_due: u32) -> u32 {
    let flip = flip_of(t);
    if next_due == LISTED && flip.x == NONE && best(t) != NONE {
        append(vec3u(stamped(t, iteration), NONE, NONE), vec3u(NONE), index, iteration);
    }
    if flip.x >= flip.y {
        return 0u;
    }
    let outer_h = vec2u(twin_entry(next(flip.x)), twin_entry(prev(flip.x)));
    let outer_g = vec2u(twin_entry(next(flip.y)), twin_entry(prev(flip.y)));
    let here = vec2u(unflagged(outer_h.x), unflagged(outer_h.y)) / 3u;
    let there = vec2u(unflagged(outer_g.x), unflagged(outer_g.y)) / 3u;
    if next_due == LISTED {
        // All exchanges come first, so that none waits for another: an exchange takes long.
        let first = vec3u(stamped(t, iteration), stamped(here.x, iteration), stamped(here.y, iteration));
        let second = vec3u(stamped(flip.y / 3u, iteration), stamped(there.x, iteration), stamped(there.y, iteration));
        append(first, second, index, iteration);
    } else if next_due == STAMPED {
        stamp(here, iteration);
        stamp(there, iteration);
    }
    flip_edge(flip.x, flip.y, outer_h, outer_g);
    if params.changes > 0u {
        topology[params.changes + t] = params.update;
        topology[params.changes + flip.y / 3u] = params.update;
    }
    return 1u;
}

// Stamps neighbours, which may be NONE. The triangles that flip are due anyway, as they have a choice.
fn stamp(neighbours: vec2u, iteration: u32) {
    atomicStore(&frontier[stamp_index(neighbours.x)], iteration + 1u);
    atomicStore(&frontier[stamp_index(neighbours.y)], iteration + 1u);
}

// Stamps a triangle. Returns NONE if it was stamped before, or is NONE.
fn stamped(t: u32, iteration: u32) -> u32 {
    let before = atomicExchange(&frontier[stamp_index(t)], iteration + 1u);
    return select(t, NONE, before == iteration + 1u || t >= params.triangles);
}

// Appends the triangles that are not NONE to the list of the next iteration.
fn append(first: vec3u, second: vec3u, index: u32, iteration: u32) {
    let count = dot(vec3u(first != vec3u(NONE)) + vec3u(second != vec3u(NONE)), vec3u(1u));
    if count > 0u {
        var at = ((iteration + 1u) & 1u) * params.triangles + atomicAdd(&history[entry(index + 1u, LENGTH)], count);
        at = listed(first.x, at);
        at = listed(first.y, at);
        at = listed(first.z, at);
        at = listed(second.x, at);
        at = listed(second.y, at);
        at = listed(second.z, at);
    }
}

// Writes a triangle into a list, and returns the index for the next one.
fn listed(t: u32, at: u32) -> u32 {
    if t != NONE {
        atomicStore(&frontier[at], t);
    }
    return at + select(1u, 0u, t == NONE);
}
