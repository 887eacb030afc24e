// Subtracts exact 96-bit integers, and reads their parts.

// The most bits of a coordinate, or of its distance from the centre of the bounding box, on the grid of its mesh. The
// engine checks this at upload.
const SPAN: u32 = 84u;

// Functions have one return each: with several, compilers that inline everything take very long.
fn magnitude_is_less(x: vec4u, y: vec4u) -> bool {
    return select(select(x.x < y.x, x.y < y.y, x.y != y.y), x.z < y.z, x.z != y.z);
}

// x - y, each as magnitude and sign.
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

// The sign of the highest digit that is not zero, or `below` if all digits are zero.
fn highest_sign(digits: vec4i, below: i32) -> i32 {
    let signs = sign(digits);
    return select(select(select(select(below, signs.x, signs.x != 0), signs.y, signs.y != 0), signs.z, signs.z != 0), signs.w, signs.w != 0);
}
