// Multiplies integers of 32-bit words, the lowest word first.
#import integers

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

// The sum of two 128-bit integers, which is below 2^128.
fn sum_of_words(x: vec4u, y: vec4u) -> vec4u {
    let sum = x + y;
    let carries = vec4u(sum < x);
    let second = sum.y + carries.x;
    let carry2 = carries.y + select(0u, 1u, second < sum.y);
    let third = sum.z + carry2;
    let carry3 = carries.z + select(0u, 1u, third < sum.z);
    return vec4u(sum.x, second, third, sum.w + carry3);
}

// The product of a 96-bit integer and a word.
fn multiply_by_word(x: vec3u, y: u32) -> vec4u {
    let middle = multiply_words(x.y, y);
    return sum_of_words(vec4u(multiply_words(x.x, y), multiply_words(x.z, y)), vec4u(0u, middle, 0u));
}

// The 192-bit product of two 96-bit integers: its lowest two words, then the others.
alias Product = array<vec4u, 2>;

fn multiply(x: vec3u, y: vec3u) -> Product {
    let first = multiply_by_word(x, y.x);
    let second = sum_of_words(vec4u(first.yzw, 0u), multiply_by_word(x, y.y));
    let third = sum_of_words(vec4u(second.yzw, 0u), multiply_by_word(x, y.z));
    return Product(vec4u(first.x, second.x, 0u, 0u), third);
}

// The sign of x·y - u·v, for magnitudes of 96 bits with a sign.
fn sign_of_difference(x: vec4u, y: vec4u, u: vec4u, v: vec4u) -> i32 {
    let left = multiply(x.xyz, y.xyz);
    let right = multiply(u.xyz, v.xyz);
    let left_sign = signed(left, x.w != y.w);
    let right_sign = signed(right, u.w != v.w);
    let low = highest_sign(vec4i(left[0] > right[0]) - vec4i(left[0] < right[0]), 0);
    let larger = highest_sign(vec4i(left[1] > right[1]) - vec4i(left[1] < right[1]), low);
    // If the signs agree, the sign of the larger magnitude.
    return select(sign(left_sign - right_sign), left_sign * larger, left_sign * right_sign > 0);
}

fn signed(magnitude: Product, is_negative: bool) -> i32 {
    let is_zero = all((magnitude[0] | magnitude[1]) == vec4u());
    return select(select(1, -1, is_negative), 0, is_zero);
}
