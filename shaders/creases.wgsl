// Creases: the edges of the input over β, as src/phases/crease.rs.

// Whether the edge of the half-edges `h` and `g` is one: DELAUNAY or BLOCKED_BY + REASON_ANGLE; UNDECIDED where exact
// arithmetic would have to decide and is left out.
fn crease_verdict(h: u32, g: u32) -> u32 {
    let a = position(vertex(h));
    let b = position(vertex(g));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(g)));
    let quad = quad_of(a, b, c, d);
    let sign = compare_angle(cross(quad[0], quad[1]), cross(quad[3], quad[2]), bound_of(quad));
    var verdict = select(select(DELAUNAY, BLOCKED_BY + REASON_ANGLE, sign < 0), UNDECIDED, sign == 0);
    verdict = select(verdict, DELAUNAY, has_any_angle());
    if verdict == UNDECIDED && decides_exactly() {
        verdict = exactly_on(a, b, c, d, true);
    }
    return verdict;
}
