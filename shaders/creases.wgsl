// Creases: the edges of the input over β, as src/phases/crease.rs.

// Whether the edge of the half-edges `h` and `g` is one: DELAUNAY or BLOCKED_BY + REASON_ANGLE; UNDECIDED where exact
// arithmetic would have to decide and is left out.
fn crease_verdict(h: u32, g: u32) -> u32 {
    let a = position(vertex(h));
    let b = position(vertex(g));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(g)));
    var sign = angle_sign(old_normals(quad_of(a, b, c, d), decides_exactly()));
    if sign == 0 && decides_exactly() {
        // Only the angle before the flip is open.
        sign = exact_signs(a, b, c, d, Signs(-1, 0, 1, 1)).y;
    }
    return select(select(DELAUNAY, BLOCKED_BY + REASON_ANGLE, sign < 0), UNDECIDED, sign == 0);
}
