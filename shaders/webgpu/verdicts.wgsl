// Finds the verdicts on the three edges of a triangle, by filters.
#import mesh
#import moving
#import plane if plane
#import points
#import space if space
#import state

// The verdicts by the fast filter; UNDECIDED if it does not decide. A census tests every edge from its lower half-edge;
// an iteration tests the edges that may flip. The other edges get DELAUNAY.
fn verdicts_on(t: u32, is_census: bool) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    let own = vec3u(3u * t, 3u * t + 1u, 3u * t + 2u);
    let entries = vec3u(twin_entry(own.x), twin_entry(own.y), twin_entry(own.z));
    let corners = vec3u(vertex(own.x), vertex(own.y), vertex(own.z));
    let lower = (entries != vec3u(NONE)) & (own < (entries & vec3u(~FLAGS)));
    let are_counted = select(entries < vec3u(LOCKED), lower, vec3<bool>(is_census));
    // The tests wait for no load of another edge. An edge that does not count has a half-edge of its own as its twin.
    let others = select(own, entries & vec3u(~FLAGS), are_counted);
    let far = vec3u(vertex(prev(others.x)), vertex(prev(others.y)), vertex(prev(others.z)));
    let a = position(corners.x);
    let b = position(corners.y);
    let c = position(corners.z);
    let beyond_ab = position(far.x);
    let beyond_bc = position(far.y);
    let beyond_ca = position(far.z);
    let verdicts = vec3u(
        verdict_on(a, b, c, beyond_ab, winding),
        verdict_on(b, c, a, beyond_bc, winding),
        verdict_on(c, a, b, beyond_ca, winding),
    );
    return select(vec3u(DELAUNAY), verdicts, are_counted);
}

fn verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var verdict = DELAUNAY;
    if leaves_some() {
        verdict = left_alone(a, b, c, d);
    }
    if verdict == DELAUNAY {
        verdict = filtered_verdict_on(a, b, c, d, winding);
    }
    return verdict;
}

// The same, with a slower test of the edges that the fast filter leaves undecided.
fn close_verdicts_on(t: u32, is_census: bool) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    var verdicts = verdicts_on(t, is_census);
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        var verdict = verdicts.x;
        if verdict == UNDECIDED {
            let d = position(vertex(prev(twin(h))));
            verdict = close_verdict_on(position(vertex(h)), position(vertex(next(h))), position(vertex(prev(h))), d, winding);
        }
        verdicts = vec3u(verdicts.yz, verdict);
    }
    return verdicts;
}

fn verdict_at(verdicts: vec3u, k: u32) -> u32 {
    return select(select(verdicts.x, verdicts.y, k == 1u), verdicts.z, k == 2u);
}

fn with_verdict(verdicts: vec3u, k: u32, verdict: u32) -> vec3u {
    return select(verdicts, vec3u(verdict), vec3u(0u, 1u, 2u) == vec3u(k));
}
