// Points of three f32 coordinates, of which the plane leaves the last one 0, and their differences: rounded for
// the filters, exact on the grid of four points, which are integers times one power of two.

// The coordinates as bits.
alias Point = vec3u;
// The magnitude in 96 bits and a sign, for each axis.
alias Differences = array<vec4u, 3>;

// Bits that a coordinate may take on the grid of its mesh: what the engine accepts at upload.
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

// u - v, with an error of one rounding.
fn rounded_difference(u: Point, v: Point) -> vec3f {
    return bitcast<vec3f>(u) - bitcast<vec3f>(v);
}

// 0 where the filter cannot decide.
fn filtered_sign(value: f32, bound: f32) -> i32 {
    return select(0, select(1, -1, value < 0.0), abs(value) > bound);
}

// The exponent of the grid of four points.
fn grid_of(a: Point, b: Point, c: Point, d: Point) -> i32 {
    return min(min(unit_exponent(a), unit_exponent(b)), min(unit_exponent(c), unit_exponent(d)));
}

fn unit_exponent(v: Point) -> i32 {
    return min(min(lowest_exponent(v.x), lowest_exponent(v.y)), lowest_exponent(v.z));
}

// Exponent of the lowest set bit of an f32, 1000 for zero.
fn lowest_exponent(bits: u32) -> i32 {
    let field = (bits >> 23u) & 0xffu;
    let magnitude = magnitude_of(bits);
    // A power of two, whose f32 is exact: GLSL ES 3.00 cannot count zeros.
    let lowest = f32(magnitude & (~magnitude + 1u));
    return select(i32(max(field, 1u)) - 277 + i32(bitcast<u32>(lowest) >> 23u), 1000, magnitude == 0u);
}

// The 24 bits of an f32 before its exponent.
fn magnitude_of(bits: u32) -> u32 {
    let fraction = bits & 0x7fffffu;
    return select(fraction | 0x800000u, fraction, ((bits >> 23u) & 0xffu) == 0u);
}

// u - v on a grid that both are on.
fn exact_differences(u: Point, v: Point, grid: i32) -> Differences {
    return Differences(
        difference(on_grid(u.x, grid), on_grid(v.x, grid)),
        difference(on_grid(u.y, grid), on_grid(v.y, grid)),
        difference(on_grid(u.z, grid), on_grid(v.z, grid)),
    );
}

// The f32 in units of 2^grid, as magnitude and sign.
fn on_grid(bits: u32, grid: i32) -> vec4u {
    let magnitude = magnitude_of(bits);
    let exponent = i32(max((bits >> 23u) & 0xffu, 1u)) - 150 - grid;
    // Bits below the grid are zeros. Of zero the exponent says nothing.
    let whole = magnitude >> u32(clamp(-exponent, 0, 24));
    let shift = u32(clamp(exponent, 0, 95));
    let low = whole << (shift % 32u);
    let high = (whole >> 1u) >> (31u - shift % 32u);
    let word = shift / 32u;
    // Below 84 bits nothing is left for a fourth word.
    return vec4u(
        select(0u, low, word == 0u),
        select(select(0u, low, word == 1u), high, word == 0u),
        select(select(0u, low, word == 2u), high, word == 1u),
        bits >> 31u,
    );
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
