// Exact integers. Four points are integers times one power of two (the grid of the quad); a difference of
// coordinates is a vec4u, 96 bits of magnitude and a sign; what is computed from differences is an Int.
// Drivers inline every call, so the callers loop over tables rather than call `multiply` from many places.

// Bits that a coordinate may take on the grid of its mesh: what the engine accepts at upload.
const SPAN: u32 = 84u;
// 928 bits: degree 8 of 85-bit differences is below 2^690 with its sums, and the β test multiplies by at most
// 2^212.
const LIMBS: u32 = 29u;

struct Int {
    negative: bool,
    len: u32,
    limbs: array<u32, LIMBS>,
}

// Exponent of the lowest set bit of an f32, 1000 for zero.
fn unit_exponent(bits: u32) -> i32 {
    let field = (bits >> 23u) & 0xffu;
    let fraction = bits & 0x7fffffu;
    let magnitude = select(fraction | 0x800000u, fraction, field == 0u);
    return select(i32(max(field, 1u)) - 150 + i32(countTrailingZeros(magnitude)), 1000, magnitude == 0u);
}

// The f32 in units of 2^unit, as magnitude and sign.
fn on_grid(bits: u32, unit: i32) -> vec4u {
    let field = (bits >> 23u) & 0xffu;
    let fraction = bits & 0x7fffffu;
    let magnitude = select(fraction | 0x800000u, fraction, field == 0u);
    if magnitude == 0u {
        return vec4u();
    }
    let exponent = i32(max(field, 1u)) - 150 - unit;
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

// x - y of numbers on one grid.
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

// The 64-bit product of two words: low, high.
fn multiply_words(x: u32, y: u32) -> vec2u {
    let x_low = x & 0xffffu;
    let x_high = x >> 16u;
    let y_low = y & 0xffffu;
    let y_high = y >> 16u;
    let low = x_low * y_low;
    let first = x_high * y_low + (low >> 16u);
    let second = x_low * y_high + (first & 0xffffu);
    return vec2u((second << 16u) | (low & 0xffffu), x_high * y_high + (first >> 16u) + (second >> 16u));
}

fn widen(x: vec4u) -> Int {
    var result = Int();
    result.negative = x.w == 1u;
    result.len = select(select(select(0u, 1u, x.x != 0u), 2u, x.y != 0u), 3u, x.z != 0u);
    result.limbs[0] = x.x;
    result.limbs[1] = x.y;
    result.limbs[2] = x.z;
    return result;
}

fn int_sign(x: ptr<function, Int>) -> i32 {
    return select(select(1, -1, (*x).negative), 0, (*x).len == 0u);
}

// -1, 0 or 1 as |x| is below, equal to or above |y|.
fn compare_magnitude(x: ptr<function, Int>, y: ptr<function, Int>) -> i32 {
    if (*x).len != (*y).len {
        return select(1, -1, (*x).len < (*y).len);
    }
    for (var i = (*x).len; i > 0u; i--) {
        let u = (*x).limbs[i - 1u];
        let v = (*y).limbs[i - 1u];
        if u != v {
            return select(1, -1, u < v);
        }
    }
    return 0;
}

fn multiply(x: ptr<function, Int>, y: ptr<function, Int>) -> Int {
    var result = Int();
    result.negative = (*x).negative != (*y).negative;
    if (*x).len == 0u || (*y).len == 0u {
        return result;
    }
    for (var i = 0u; i < (*x).len; i++) {
        var carry = 0u;
        for (var j = 0u; j < (*y).len; j++) {
            // Below 2^64: (2^32 - 1)^2 + 2(2^32 - 1).
            let product = multiply_words((*x).limbs[i], (*y).limbs[j]);
            let first = product.x + result.limbs[i + j];
            let second = first + carry;
            carry = product.y + select(0u, 1u, first < product.x) + select(0u, 1u, second < first);
            result.limbs[i + j] = second;
        }
        result.limbs[i + (*y).len] = carry;
    }
    result.len = (*x).len + (*y).len;
    if result.limbs[result.len - 1u] == 0u {
        result.len--;
    }
    return result;
}

// x + y, or x - y.
fn add(x: ptr<function, Int>, y: ptr<function, Int>, subtract: bool) -> Int {
    var result = Int();
    let y_negative = (*y).negative != subtract;
    if (*x).negative == y_negative {
        result.negative = y_negative;
        result.len = max((*x).len, (*y).len);
        var carry = 0u;
        for (var i = 0u; i < result.len; i++) {
            let first = (*x).limbs[i] + (*y).limbs[i];
            let second = first + carry;
            carry = select(0u, 1u, first < (*x).limbs[i]) + select(0u, 1u, second < first);
            result.limbs[i] = second;
        }
        if carry == 1u {
            result.limbs[result.len] = 1u;
            result.len++;
        }
        return result;
    }
    let is_less = compare_magnitude(x, y) < 0;
    result.negative = select((*x).negative, y_negative, is_less);
    result.len = max((*x).len, (*y).len);
    var borrow = 0u;
    for (var i = 0u; i < result.len; i++) {
        let larger = select((*x).limbs[i], (*y).limbs[i], is_less);
        let smaller = select((*y).limbs[i], (*x).limbs[i], is_less);
        let first = larger - smaller;
        result.limbs[i] = first - borrow;
        borrow = select(0u, 1u, larger < smaller) + select(0u, 1u, first < borrow);
    }
    while result.len > 0u && result.limbs[result.len - 1u] == 0u {
        result.len--;
    }
    return result;
}

fn product(x: vec4u, y: vec4u) -> Int {
    var u = widen(x);
    var v = widen(y);
    return multiply(&u, &v);
}

// The sign of x·u + y·v, without the sum.
fn sum_of_products_sign(x: ptr<function, Int>, u: ptr<function, Int>, y: ptr<function, Int>, v: ptr<function, Int>) -> i32 {
    let first = int_sign(x) * int_sign(u);
    let second = int_sign(y) * int_sign(v);
    if first == second || second == 0 {
        return first;
    }
    if first == 0 {
        return second;
    }
    var left = multiply(x, u);
    var right = multiply(y, v);
    return first * compare_magnitude(&left, &right);
}
