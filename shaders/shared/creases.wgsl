// Finds creases, the edges of the input whose normals differ by more than β, as src/phases/crease.rs.
#import mesh
#import normals
#import points

// Tests an edge by a filter. Returns BLOCKED_BY + REASON_ANGLE for a crease, else DELAUNAY; UNDECIDED if exact
// arithmetic has to decide.
fn filtered_crease(a: Point, b: Point, c: Point, d: Point) -> u32 {
    let sign = angle_sign(old_normals(quad_of(a, b, c, d), true));
    return select(select(DELAUNAY, BLOCKED_BY + REASON_ANGLE, sign < 0), UNDECIDED, sign == 0);
}
