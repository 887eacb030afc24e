// Subtracts points: with rounding for the filters, and exactly for integers. On the grid of four points, their
// coordinates are integers times one power of two. floats.wgsl and fixed_point.wgsl define points. In the plane, the
// third coordinate is 0.
#import fixed_point if fixed
#import floats if floats

// The magnitude in 96 bits and a sign, for each axis.
alias Differences = array<vec4u, 3>;

// A device may flush subnormals to zero. So the differences are scaled until the largest lies in [1, 2). If the largest
// is below 2^-67 before that, no filter decides. Flushing then changes the value of a filter by less than its bound.
const SMALLEST_FIELD: u32 = 60u;
const LARGEST_FIELD: u32 = 250u;

// The power of two that scales `largest` into [1, 2); 0 if a filter cannot be trusted.
fn scale_for(largest: f32) -> f32 {
    let field = (bitcast<u32>(largest) >> 23u) & 0xffu;
    return select(0.0, bitcast<f32>((254u - field) << 23u), field >= SMALLEST_FIELD && field <= LARGEST_FIELD);
}

// The sign of a value with this error bound; 0 if the filter cannot decide.
fn filtered_sign(value: f32, bound: f32) -> i32 {
    return select(0, select(1, -1, value < 0.0), abs(value) > bound);
}

// Whether in (a - c)·(b - c) and in (a - d)·(b - d) the product of each axis has a factor 0. Then both opposite angles
// are right angles, and the edge a, b is Delaunay. Compares words: a device may flush a difference to zero.
fn has_right_angles(a: Point, b: Point, c: Point, d: Point) -> bool {
    let at_c = min(apart(a, c), apart(b, c));
    let at_d = min(apart(a, d), apart(b, d));
    return all((at_c | at_d) == vec3u());
}

// u - v, on a grid of both.
fn exact_differences(u: Point, v: Point, grid: i32) -> Differences {
    return Differences(
        exact_difference(u, v, 0u, grid),
        exact_difference(u, v, 1u, grid),
        exact_difference(u, v, 2u, grid),
    );
}
