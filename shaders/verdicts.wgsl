// The verdicts on the three edges of a triangle.

// By the filter: UNDECIDED where exact arithmetic has to decide. Of no twin, and of an edge that stays, nothing.
fn filtered_verdicts(t: u32) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    var a = position(vertex(3u * t));
    var b = position(vertex(3u * t + 1u));
    var c = position(vertex(3u * t + 2u));
    var verdicts = vec3u();
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let g = twin_entry(h);
        var verdict = DELAUNAY;
        if g < LOCKED {
            verdict = filtered_verdict_on(a, b, c, position(vertex(prev(g))), winding);
        }
        verdicts = vec3u(verdicts.yz, verdict);
        let first = a;
        a = b;
        b = c;
        c = first;
    }
    return verdicts;
}

// The same, with exact arithmetic for those that the filter leaves. Mostly it leaves one: then all invocations decide
// theirs at the same time, whichever edge of its triangle it is.
fn exact_verdicts(t: u32, filtered: vec3u) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    var verdicts = filtered;
    var k = first_undecided(verdicts);
    while k < 3u {
        let h = 3u * t + k;
        let a = position(vertex(h));
        let b = position(vertex(next(h)));
        let c = position(vertex(prev(h)));
        let d = position(vertex(prev(twin(h))));
        let verdict = exact_verdict_on(a, b, c, d, winding);
        verdicts = select(verdicts, vec3u(verdict), vec3u(0u, 1u, 2u) == vec3u(k));
        k = first_undecided(verdicts);
    }
    return verdicts;
}

// 3 where all are decided.
fn first_undecided(verdicts: vec3u) -> u32 {
    let is_undecided = verdicts == vec3u(UNDECIDED);
    return select(select(select(3u, 2u, is_undecided.z), 1u, is_undecided.y), 0u, is_undecided.x);
}
