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
    if magnitude == 0u {
        return vec4u();
    }
    let exponent = i32(max((bits >> 23u) & 0xffu, 1u)) - 150 - grid;
    if exponent < 0 {
        return vec4u(magnitude >> u32(-exponent), 0u, 0u, bits >> 31u);
    }
    let low = magnitude << (u32(exponent) % 32u);
    let high = (magnitude >> 1u) >> (31u - u32(exponent) % 32u);
    switch u32(exponent) / 32u {
        case 0u: { return vec4u(low, high, 0u, bits >> 31u); }
        case 1u: { return vec4u(0u, low, high, bits >> 31u); }
        // Below 84 bits nothing is left for a fourth word.
        default: { return vec4u(0u, 0u, low, bits >> 31u); }
    }
}

fn magnitude_is_less(x: vec4u, y: vec4u) -> bool {
    if x.z != y.z {
        return x.z < y.z;
    }
    if x.y != y.y {
        return x.y < y.y;
    }
    return x.x < y.x;
}

// x - y of magnitudes with signs.
fn difference(x: vec4u, y: vec4u) -> vec4u {
    if x.w != y.w {
        let low = x.x + y.x;
        let carry_low = select(0u, 1u, low < x.x);
        let sum = x.y + y.y;
        let middle = sum + carry_low;
        let carry = select(0u, 1u, sum < x.y) + select(0u, 1u, middle < sum);
        return vec4u(low, middle, x.z + y.z + carry, x.w);
    }
    let is_less = magnitude_is_less(x, y);
    let larger = select(x, y, is_less);
    let smaller = select(y, x, is_less);
    let borrow_low = select(0u, 1u, larger.x < smaller.x);
    let rest = larger.y - smaller.y;
    let borrow = select(0u, 1u, larger.y < smaller.y) + select(0u, 1u, rest < borrow_low);
    return vec4u(larger.x - smaller.x, rest - borrow_low, larger.z - smaller.z - borrow, select(x.w, 1u - x.w, is_less));
}
