// The verdicts on edges, with exact arithmetic or without.

// Exact arithmetic takes so many registers that a kernel with it has few invocations at a time: what the filter decides
// is done without it first.
override EXACT: bool = true;

fn decides_exactly() -> bool {
    return EXACT;
}

// On the geometry of the three edges of triangle `t`; of no twin, and of an edge that stays, nothing.
fn verdicts_on(t: u32) -> vec3u {
    let winding = select(1, -1, is_clockwise(t));
    var a = position(vertex(3u * t));
    var b = position(vertex(3u * t + 1u));
    var c = position(vertex(3u * t + 2u));
    var verdicts = vec3u();
    for (var h = 3u * t; h < 3u * t + 3u; h++) {
        let g = twin_entry(h);
        var verdict = DELAUNAY;
        if g < LOCKED {
            verdict = verdict_on(a, b, c, position(vertex(prev(g))), winding);
        }
        verdicts = vec3u(verdicts.yz, verdict);
        let first = a;
        a = b;
        b = c;
        c = first;
    }
    return verdicts;
}
