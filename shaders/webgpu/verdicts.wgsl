// Finds the verdicts on the three edges of a triangle, by filters.
#import mesh
#import moving
#import plane if plane
#import points
#import space if space
#import state

// The verdicts by the fast or the slower filter; UNDECIDED if exact arithmetic has to decide. A census tests every edge
// from its lower half-edge; an iteration tests the edges that may flip. The other edges get DELAUNAY.
fn verdicts_on(t: u32, is_census: bool, is_close: bool) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    let first = 3u * t;
    let entries = vec3u(twin_entry(first), twin_entry(first + 1u), twin_entry(first + 2u));
    let corners = vec3u(vertex(first), vertex(first + 1u), vertex(first + 2u));
    let own = vec3u(first, first + 1u, first + 2u);
    let are_counted = select(entries < vec3u(LOCKED), (entries != vec3u(NONE)) & (own < (entries & vec3u(~FLAGS))), vec3<bool>(is_census));
    // All loads come before the tests. An edge that does not count is tested with its own triangle twice.
    let others = select(own, entries & vec3u(~FLAGS), are_counted);
    let far = vec3u(vertex(prev(others.x)), vertex(prev(others.y)), vertex(prev(others.z)));
    let a = position(corners.x);
    let b = position(corners.y);
    let c = position(corners.z);
    let opposite_c = position(far.x);
    let opposite_a = position(far.y);
    let opposite_b = position(far.z);
    let verdicts = vec3u(
        verdict_on_points(a, b, c, opposite_c, winding, is_close),
        verdict_on_points(b, c, a, opposite_a, winding, is_close),
        verdict_on_points(c, a, b, opposite_b, winding, is_close),
    );
    return select(vec3u(DELAUNAY), verdicts, are_counted);
}

fn verdict_on_points(a: Point, b: Point, c: Point, d: Point, winding: i32, is_close: bool) -> u32 {
    var verdict = DELAUNAY;
    if leaves_some() {
        verdict = left_alone(a, b, c, d);
    }
    if verdict == DELAUNAY && is_close {
        verdict = close_verdict_on(a, b, c, d, winding);
    } else if verdict == DELAUNAY {
        verdict = filtered_verdict_on(a, b, c, d, winding);
    }
    return verdict;
}

fn counts(h: u32, entry: u32, is_census: bool) -> bool {
    return select(entry < LOCKED, entry != NONE && h < unflagged(entry), is_census);
}

fn verdict_at(verdicts: vec3u, k: u32) -> u32 {
    return select(select(verdicts.x, verdicts.y, k == 1u), verdicts.z, k == 2u);
}

fn with_verdict(verdicts: vec3u, k: u32, verdict: u32) -> vec3u {
    return select(verdicts, vec3u(verdict), vec3u(0u, 1u, 2u) == vec3u(k));
}
