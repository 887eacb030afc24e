// Tests how far a flip moves the surface: compares the distance of the lines through the two diagonals with the limit,
// as `deviates` in src/predicates/space.rs. It compares |n1·r| with δ|n1 + n2|.
#import mesh
#import normals
#import points
#import state

// LABELLED, BLOCKED_BY + REASON_DEVIATION, or UNDECIDED. With ε = 2^-23 and sizes as in normals.wgsl, n1·r errs by at
// most 19ε of the product of the sizes of n1 and r, and δ|n1 + n2| by at most 24ε of δ times the sum of the sizes of n1
// and n2.
fn filtered_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    // The distance is always below 8 times the largest difference of two coordinates. A larger limit is cut down to
    // that, so nothing overflows.
    let largest = largest_of(unscaled(a, b, c, d));
    let allowed = 8.0 * (min(0.125 * bitcast<f32>(deviation().w), largest) * scale_for(largest));
    let quad = quad_of(a, b, c, d);
    let old = old_normals(quad, false);
    let both = old[0].xyz + old[1].xyz;
    let value = abs(dot(old[0].xyz, quad[2])) - allowed * sqrt(dot(both, both));
    let sign = sign_of(value, old[0].w * size(quad[2]) + allowed * (old[0].w + old[1].w));
    return select(select(LABELLED, BLOCKED_BY + REASON_DEVIATION, sign > 0), UNDECIDED, sign == 0);
}
