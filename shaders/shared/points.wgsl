// Differences of points: rounded for the filters, exact on the grid of four points, which are integers times one power
// of two. What a point is, floats.wgsl and fixed.wgsl say; the plane leaves the last of its three coordinates 0.

// The magnitude in 96 bits and a sign, for each axis.
alias Differences = array<vec4u, 3>;

// Bits that a coordinate, or its distance from the middle of the bounding box, may take on the grid of its mesh: what the
// engine accepts at upload.
const SPAN: u32 = 84u;

// Subnormals may be flushed. The differences are scaled so that the largest lies in [1, 2) and none was
// computed from a quad smaller than 2^-67; what is flushed then changes a filter's value by less than its bound says.
const SMALLEST_FIELD: u32 = 60u;
const LARGEST_FIELD: u32 = 250u;

// The power of two that scales `largest` into [1, 2); 0 where a filter cannot be trusted.
fn scale_for(largest: f32) -> f32 {
    let field = (bitcast<u32>(largest) >> 23u) & 0xffu;
    return select(0.0, bitcast<f32>((254u - field) << 23u), field >= SMALLEST_FIELD && field <= LARGEST_FIELD);
}

// 0 where the filter cannot decide.
fn filtered_sign(value: f32, bound: f32) -> i32 {
    return select(0, select(1, -1, value < 0.0), abs(value) > bound);
}

// Shaders have one way out of a function: where there are several, compilers that inline everything take very long.
fn magnitude_is_less(x: vec4u, y: vec4u) -> bool {
    return select(select(x.x < y.x, x.y < y.y, x.y != y.y), x.z < y.z, x.z != y.z);
}

// x - y of magnitudes with signs.
fn difference(x: vec4u, y: vec4u) -> vec4u {
    let low = x.x + y.x;
    let carry_low = select(0u, 1u, low < x.x);
    let middle = x.y + y.y;
    let carry = select(0u, 1u, middle < x.y) + select(0u, 1u, middle + carry_low < middle);
    let sum = vec4u(low, middle + carry_low, x.z + y.z + carry, x.w);
    let is_less = magnitude_is_less(x, y);
    let larger = select(x, y, is_less);
    let smaller = select(y, x, is_less);
    let borrow_low = select(0u, 1u, larger.x < smaller.x);
    let rest = larger.y - smaller.y;
    let borrow = select(0u, 1u, larger.y < smaller.y) + select(0u, 1u, rest < borrow_low);
    let sign = select(x.w, 1u - x.w, is_less);
    let rest_of_all = vec4u(larger.x - smaller.x, rest - borrow_low, larger.z - smaller.z - borrow, sign);
    return select(rest_of_all, sum, x.w != y.w);
}

fn component_of(v: vec3u, axis: u32) -> u32 {
    return select(select(v.x, v.y, axis == 1u), v.z, axis == 2u);
}

// u - v on a grid that both are on.
fn exact_differences(u: Point, v: Point, grid: i32) -> Differences {
    return Differences(
        exact_difference(u, v, 0u, grid),
        exact_difference(u, v, 1u, grid),
        exact_difference(u, v, 2u, grid),
    );
}

// The sign of the highest digit that is not zero, or `below` if all are.
fn highest_sign(digits: vec4i, below: i32) -> i32 {
    let signs = sign(digits);
    return select(select(select(select(below, signs.x, signs.x != 0), signs.y, signs.y != 0), signs.z, signs.z != 0), signs.w, signs.w != 0);
}
