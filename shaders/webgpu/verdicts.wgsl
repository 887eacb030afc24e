// Finds the verdicts on the three edges of a triangle.
#import mesh
#import moving
#import plane if plane
#import plane_together if plane
#import points
#import space if space
#import space_together if space
#import state

// The verdicts by fast filters; UNDECIDED if none decides. Edges that may not flip get DELAUNAY. First the three edges are
// tested together, so that no test waits for a load of another edge; then those that are left, one by one.
fn verdicts_on(t: u32) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    let own = vec3u(3u * t, 3u * t + 1u, 3u * t + 2u);
    let entries = vec3u(twin_entry(own.x), twin_entry(own.y), twin_entry(own.z));
    let may_flip = entries < vec3u(LOCKED);
    // An edge that may not flip has a half-edge of its own as its twin.
    let others = select(own, entries, may_flip);
    let a = position(vertex(own.x));
    let b = position(vertex(own.y));
    let c = position(vertex(own.z));
    let beyond_ab = position(vertex(prev(others.x)));
    let beyond_bc = position(vertex(prev(others.y)));
    let beyond_ca = position(vertex(prev(others.z)));
    var verdicts = vec3u(UNDECIDED);
    if !leaves_some() {
        verdicts = verdicts_together(a, b, c, beyond_ab, beyond_bc, beyond_ca, winding);
    }
    verdicts = select(vec3u(DELAUNAY), verdicts, may_flip);
    var left = dot(vec3u(verdicts == vec3u(UNDECIDED)), vec3u(1u, 2u, 4u));
    while left != 0u {
        let k = firstTrailingBit(left);
        left &= left - 1u;
        verdicts = with_verdict(verdicts, k, verdict_at_edge(3u * t + k, winding, false));
    }
    return verdicts;
}

// The verdict on the edge of `h`, which has a twin.
fn verdict_at_edge(h: u32, winding: i32, is_close: bool) -> u32 {
    let a = position(vertex(h));
    let b = position(vertex(next(h)));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(twin(h))));
    var verdict = verdict_on(a, b, c, d, winding);
    if is_close && verdict == UNDECIDED {
        verdict = close_verdict_on(a, b, c, d, winding);
    }
    return verdict;
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

// The verdicts by the fast filter and a slower test, which decides more. A census tests every edge from its lower
// half-edge. One loop compiles faster than three tests.
fn close_verdicts_on(t: u32, is_census: bool) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    var verdicts = vec3u();
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let entry = twin_entry(h);
        var verdict = DELAUNAY;
        if select(entry < LOCKED, entry != NONE && h < unflagged(entry), is_census) {
            verdict = verdict_at_edge(h, winding, true);
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
