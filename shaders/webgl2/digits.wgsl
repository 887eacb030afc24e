// Computes with exact integers that are stored as digits, the lowest first: an integer is the sum of digit i times
// 2^(13·i). Products are summed column by column, from the lowest digit on. That needs no computed index into an array,
// which old drivers get wrong, and no carry inside a column.
#import integers

// Computed digits are balanced, from -4096 to 4095. A number is zero if all its digits are zero. Its sign is the sign
// of its highest digit that is not zero. n digits hold every number up to 4095/8192·2^(13·n). If every difference of
// coordinates has c digits in use, 2c + 1 digits hold a sum of three products of differences (below 3·2^(26·c)), and
// 4c + 1 digits hold a sum of two products of such sums (below 18·2^(52·c)).

const DIGIT_BITS: u32 = 13u;
const HALF_DIGIT: i32 = 4096;
const DIGIT_MASK: i32 = 8191;

// 8 digits: a difference of coordinates (7 digits, from -8191 to 8191), and the factors of cos β.
alias Small = array<vec4i, 2>;
// 16 digits: what is of degree 2.
alias Medium = array<vec4i, 4>;
// 36 digits: what is of degree 4, below 2^346, also after a product with a factor of cos β, up to 2^106.
alias Large = array<vec4i, 9>;

fn digits_of(x: vec4u) -> Small {
    let low = vec4u(x.x, x.x >> 13u, (x.x >> 26u) | (x.y << 6u), x.y >> 7u) & vec4u(8191u);
    let high = vec4u((x.y >> 20u) | (x.z << 12u), x.z >> 1u, x.z >> 14u, x.z >> 27u) & vec4u(8191u);
    let sign = 1 - 2 * i32(x.w);
    return Small(sign * vec4i(low), sign * vec4i(high));
}

// Digits in use of the widest of several magnitudes, given their bitwise or.
fn digits_in_use(x: vec4u) -> u32 {
    let digits = digits_of(vec4u(x.xyz, 0u));
    let low = last_in_use(digits[0]);
    let high = last_in_use(digits[1]);
    return select(low, 4u + high, high > 0u);
}

fn last_in_use(x: vec4i) -> u32 {
    return select(select(select(select(0u, 1u, x.x != 0), 2u, x.y != 0), 3u, x.z != 0), 4u, x.w != 0);
}

// The balanced digit of a column. The carry goes to the next column.
fn digit_of(column: i32) -> i32 {
    return ((column + HALF_DIGIT) & DIGIT_MASK) - HALF_DIGIT;
}

fn medium_sign(x: Medium) -> i32 {
    return highest_sign(x[3], highest_sign(x[2], highest_sign(x[1], highest_sign(x[0], 0))));
}

fn large_sign(x: Large) -> i32 {
    let low = highest_sign(x[3], highest_sign(x[2], highest_sign(x[1], highest_sign(x[0], 0))));
    return highest_sign(x[8], highest_sign(x[7], highest_sign(x[6], highest_sign(x[5], highest_sign(x[4], low)))));
}

fn negated_small(x: Small) -> Small {
    return Small(-x[0], -x[1]);
}

fn negated_medium(x: Medium) -> Medium {
    return Medium(-x[0], -x[1], -x[2], -x[3]);
}

fn negated_large(x: Large) -> Large {
    return Large(-x[0], -x[1], -x[2], -x[3], -x[4], -x[5], -x[6], -x[7], -x[8]);
}

// The digits moved down by one, with a new highest one.
fn moved_down_small(x: Small, digit: i32) -> Small {
    return Small(vec4i(x[0].yzw, x[1].x), vec4i(x[1].yzw, digit));
}

fn moved_down_medium(x: Medium, digit: i32) -> Medium {
    return Medium(vec4i(x[0].yzw, x[1].x), vec4i(x[1].yzw, x[2].x), vec4i(x[2].yzw, x[3].x), vec4i(x[3].yzw, digit));
}

fn moved_down_large(x: Large, digit: i32) -> Large {
    return Large(
        vec4i(x[0].yzw, x[1].x),
        vec4i(x[1].yzw, x[2].x),
        vec4i(x[2].yzw, x[3].x),
        vec4i(x[3].yzw, x[4].x),
        vec4i(x[4].yzw, x[5].x),
        vec4i(x[5].yzw, x[6].x),
        vec4i(x[6].yzw, x[7].x),
        vec4i(x[7].yzw, x[8].x),
        vec4i(x[8].yzw, digit),
    );
}

// The digits moved up by one, with a new lowest one.
fn moved_up_small(x: Small, digit: i32) -> Small {
    return Small(vec4i(digit, x[0].xyz), vec4i(x[0].w, x[1].xyz));
}

fn moved_up_medium(x: Medium, digit: i32) -> Medium {
    return Medium(vec4i(digit, x[0].xyz), vec4i(x[0].w, x[1].xyz), vec4i(x[1].w, x[2].xyz), vec4i(x[2].w, x[3].xyz));
}

fn moved_up_large(x: Large, digit: i32) -> Large {
    return Large(
        vec4i(digit, x[0].xyz),
        vec4i(x[0].w, x[1].xyz),
        vec4i(x[1].w, x[2].xyz),
        vec4i(x[2].w, x[3].xyz),
        vec4i(x[3].w, x[4].xyz),
        vec4i(x[4].w, x[5].xyz),
        vec4i(x[5].w, x[6].xyz),
        vec4i(x[6].w, x[7].xyz),
        vec4i(x[7].w, x[8].xyz),
    );
}

// x·u, digit by digit with equal indices.
fn column_small(x: Small, u: Small) -> i32 {
    return dot(x[0], u[0]) + dot(x[1], u[1]);
}

fn column_medium(x: Medium, u: Medium) -> i32 {
    return dot(x[0], u[0]) + dot(x[1], u[1]) + dot(x[2], u[2]) + dot(x[3], u[3]);
}

fn column_large(x: Large, u: Large) -> i32 {
    return dot(x[0], u[0]) + dot(x[1], u[1]) + dot(x[2], u[2]) + dot(x[3], u[3]) + dot(x[4], u[4])
        + dot(x[5], u[5]) + dot(x[6], u[6]) + dot(x[7], u[7]) + dot(x[8], u[8]);
}

// x·u + y·v + z·w of differences with `count` digits in use. A column is below 21·2^26.
fn sum_of_products(x: Small, u: Small, y: Small, v: Small, z: Small, w: Small, count: u32) -> Medium {
    var result = Medium();
    var left_u = u;
    var left_v = v;
    var left_w = w;
    // The digits so far, the last one first: column k multiplies digit i of x by digit k - i of u.
    var turned_u = Small();
    var turned_v = Small();
    var turned_w = Small();
    var carry = 0;
    for (var column = 0u; column < 16u; column++) {
        var digit = 0;
        if column <= 2u * count {
            turned_u = moved_up_small(turned_u, left_u[0].x);
            turned_v = moved_up_small(turned_v, left_v[0].x);
            turned_w = moved_up_small(turned_w, left_w[0].x);
            left_u = moved_down_small(left_u, 0);
            left_v = moved_down_small(left_v, 0);
            left_w = moved_down_small(left_w, 0);
            carry += column_small(x, turned_u) + column_small(y, turned_v) + column_small(z, turned_w);
            digit = digit_of(carry);
            carry = (carry - digit) >> DIGIT_BITS;
        }
        result = moved_down_medium(result, digit);
    }
    return result;
}

// x·u + y·v, where each factor is a `sum_of_products` of differences with `count` digits. A column is below 32·2^24.
fn sum_of_medium_products(x: Medium, u: Medium, y: Medium, v: Medium, count: u32) -> Large {
    var result = Large();
    var left_u = u;
    var left_v = v;
    var turned_u = Medium();
    var turned_v = Medium();
    var carry = 0;
    for (var column = 0u; column < 36u; column++) {
        var digit = 0;
        if column <= 4u * count {
            turned_u = moved_up_medium(turned_u, left_u[0].x);
            turned_v = moved_up_medium(turned_v, left_v[0].x);
            left_u = moved_down_medium(left_u, 0);
            left_v = moved_down_medium(left_v, 0);
            carry += column_medium(x, turned_u) + column_medium(y, turned_v);
            digit = digit_of(carry);
            carry = (carry - digit) >> DIGIT_BITS;
        }
        result = moved_down_large(result, digit);
    }
    return result;
}

// x·factor, below 2^467. A column is below 5·2^25, or 2^27 where the factor is a power of two.
fn scaled(x: Large, factor: Small) -> Large {
    var result = Large();
    var left = x;
    var turned = Small();
    var carry = 0;
    for (var column = 0u; column < 36u; column++) {
        turned = moved_up_small(turned, left[0].x);
        left = moved_down_large(left, 0);
        carry += column_small(factor, turned);
        let digit = digit_of(carry);
        carry = (carry - digit) >> DIGIT_BITS;
        result = moved_down_large(result, digit);
    }
    return result;
}

// The sign of x·u + y·v, which `columns` digits hold. A column is below 72·2^24.
fn sum_of_large_products_sign(x: Large, u: Large, y: Large, v: Large, columns: u32) -> i32 {
    var result = 0;
    var left_u = u;
    var left_v = v;
    var turned_u = Large();
    var turned_v = Large();
    var carry = 0;
    for (var column = 0u; column < columns; column++) {
        turned_u = moved_up_large(turned_u, left_u[0].x);
        turned_v = moved_up_large(turned_v, left_v[0].x);
        left_u = moved_down_large(left_u, 0);
        left_v = moved_down_large(left_v, 0);
        carry += column_large(x, turned_u) + column_large(y, turned_v);
        let digit = digit_of(carry);
        carry = (carry - digit) >> DIGIT_BITS;
        result = select(result, sign(digit), digit != 0);
    }
    return result;
}
