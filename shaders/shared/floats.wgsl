// Reads points of f32 coordinates.
#import integers
#import state

// The coordinates as bits.
alias Point = vec3u;

fn position(v: u32) -> Point {
    return coordinates(v);
}

// For each axis, 1 if u is greater than v, -1 if v is greater.
fn order(u: Point, v: Point) -> vec3i {
    let x = ordered(u);
    let y = ordered(v);
    return vec3i(x > y) - vec3i(x < y);
}

// For each axis, 0 if u and v have the same word. Words of equal numbers may differ: 0 and -0.
fn apart(u: Point, v: Point) -> vec3u {
    return u ^ v;
}

// Integers in the same order as the floats.
fn ordered(bits: Point) -> vec3i {
    let magnitude = vec3i(bits & vec3u(0x7fffffffu));
    return select(magnitude, -magnitude, bits > vec3u(0x7fffffffu));
}

// u - v, with an error of one rounding: ε.
fn rounded_difference(u: Point, v: Point) -> vec3f {
    return bitcast<vec3f>(u) - bitcast<vec3f>(v);
}

// The exponent of the grid of four points.
fn grid_of(a: Point, b: Point, c: Point, d: Point) -> i32 {
    return min(min(unit_exponent(a), unit_exponent(b)), min(unit_exponent(c), unit_exponent(d)));
}

fn unit_exponent(v: Point) -> i32 {
    return min(min(lowest_exponent(v.x), lowest_exponent(v.y)), lowest_exponent(v.z));
}

// Larger than the exponent of the lowest set bit of any number.
const ABOVE_EXPONENTS: i32 = 1000;

// Exponent of the lowest set bit of an f32; ABOVE_EXPONENTS for zero.
fn lowest_exponent(bits: u32) -> i32 {
    let field = (bits >> 23u) & 0xffu;
    let magnitude = magnitude_of(bits);
    // The f32 of a power of two is exact. GLSL ES 3.00 cannot count zeros.
    let lowest = f32(magnitude & (~magnitude + 1u));
    return select(i32(max(field, 1u)) - 277 + i32(bitcast<u32>(lowest) >> 23u), ABOVE_EXPONENTS, magnitude == 0u);
}

// The 24-bit mantissa of an f32.
fn magnitude_of(bits: u32) -> u32 {
    let fraction = bits & 0x7fffffu;
    return select(fraction | 0x800000u, fraction, ((bits >> 23u) & 0xffu) == 0u);
}

// u - v, on a grid of both.
fn exact_difference(u: Point, v: Point, axis: u32, grid: i32) -> vec4u {
    return difference(on_grid(component_of(u, axis), grid), on_grid(component_of(v, axis), grid));
}

fn deviation_grid() -> i32 {
    return lowest_exponent(deviation().x);
}

// No two points are farther apart than 2^(SPAN + 2), so a larger limit is cut down to that.
fn deviation_on(grid: i32) -> vec4u {
    let most = deviation().x;
    let is_beyond = i32(most >> 23u) - 127 - grid >= i32(SPAN) + 2;
    return select(on_grid(most, grid), vec4u(0u, 0u, 1u << (SPAN - 62u), 0u), is_beyond);
}

// The f32 in units of 2^grid, as magnitude and sign.
fn on_grid(bits: u32, grid: i32) -> vec4u {
    let magnitude = magnitude_of(bits);
    let exponent = i32(max((bits >> 23u) & 0xffu, 1u)) - 150 - grid;
    // Bits below the grid are zeros. The exponent of zero means nothing.
    let whole = magnitude >> u32(clamp(-exponent, 0, 24));
    let shift = u32(clamp(exponent, 0, 95));
    let low = whole << (shift % 32u);
    let high = (whole >> 1u) >> (31u - shift % 32u);
    let word = shift / 32u;
    // A coordinate on the grid has at most 84 bits, and never needs a fourth word.
    return vec4u(
        select(0u, low, word == 0u),
        select(select(0u, low, word == 1u), high, word == 0u),
        select(select(0u, low, word == 2u), high, word == 1u),
        bits >> 31u,
    );
}
