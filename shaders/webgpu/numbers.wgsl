// Computes with exact integers in memory. A number is stored as its length, then its digits, the lowest first: it is
// the sum of digit i times 2^(13·i). Each invocation has its own lane. Programs (src/engine/webgpu/programs.rs) define
// the computations. The code for the product of two numbers therefore exists only once. Inlined everywhere, it would
// compile for seconds.
#import integers
#import points
#import three_axes if space
#import two_axes if plane

// Computed digits are balanced, from -4096 to 4095: the sign of a number is the sign of its highest digit.

const DIGIT_BITS: u32 = 13u;
const HALF_DIGIT: i32 = 4096;
const DIGIT_MASK: i32 = 8191;

// The offset of each program, the steps of the programs, then the lanes, interleaved word by word.
@group(0) @binding(9) var<storage, read_write> numbers: array<i32>;

// The offset of the lanes, the words of a step, and the number of lanes.
const LANES: u32 = 512u;
const STEP: u32 = 5u;
const LANE_COUNT: u32 = 8192u;

// Digits of an integer of up to 91 bits, words of a number of up to 8 digits, and words of a vector of three.
const DIGITS: u32 = 7u;
const GIVEN_WORDS: u32 = 9u;
const VECTOR: u32 = 27u;

// The offset of the differences of points in a lane, by vector and axis.
const DIFFERENCES: u32 = 0u;

var<private> lane: u32;

fn word(offset: u32) -> u32 {
    return LANES + offset * LANE_COUNT + lane;
}

fn sign_at(offset: u32) -> i32 {
    let length = u32(numbers[word(offset)]);
    return select(0, sign(numbers[word(offset + length)]), length > 0u);
}

// Writes an integer, from magnitude and sign.
fn put(offset: u32, x: vec4u) {
    var length = 0;
    for (var i = 0u; i < DIGITS; i++) {
        let bit = DIGIT_BITS * i;
        let low = component_of(x.xyz, bit / 32u);
        let high = component_of(vec3u(x.yz, 0u), bit / 32u);
        let digit = i32(((low >> (bit % 32u)) | ((high << 1u) << (31u - bit % 32u))) & u32(DIGIT_MASK));
        numbers[word(offset + 1u + i)] = select(digit, -digit, x.w == 1u);
        length = select(length, i32(i) + 1, digit != 0);
    }
    numbers[word(offset)] = length;
}

// Writes p = a - c, q = b - c, r = a - d and s = b - d.
fn put_differences(a: Point, b: Point, c: Point, d: Point, grid: i32) {
    for (var vector = 0u; vector < 4u; vector++) {
        var u = a;
        var v = c;
        if (vector & 1u) == 1u {
            u = b;
        }
        if vector >= 2u {
            v = d;
        }
        put_vector(DIFFERENCES + VECTOR * vector, u, v, grid);
    }
}

// Writes u - v, axis by axis.
fn put_vector(offset: u32, u: Point, v: Point, grid: i32) {
    for (var axis = 0u; axis < DIMENSION; axis++) {
        put(offset + GIVEN_WORDS * axis, exact_difference(u, v, axis, grid));
    }
}

fn run(program: u32) {
    let end = u32(numbers[program + 1u]);
    for (var step = u32(numbers[program]); step < end; step += STEP) {
        run_step(step);
    }
}

// Writes a sum of up to four products of two numbers each.
fn run_step(step: u32) {
    let to = u32(numbers[step]) & 1023u;
    var columns = 0;
    let end = step + 1u + u32(numbers[step] >> 16u);
    for (var term = step + 1u; term < end; term++) {
        let factors = u32(numbers[term]);
        columns = max(columns, numbers[word(factors & 1023u)] + numbers[word((factors >> 10u) & 1023u)]);
    }
    var length = 0;
    var carry = 0;
    for (var column = 0; column <= columns; column++) {
        for (var term = step + 1u; term < end; term++) {
            let factors = u32(numbers[term]);
            let part = part_of_column(factors & 1023u, (factors >> 10u) & 1023u, column);
            carry += select(part, -part, (factors >> 20u) == 1u);
        }
        let digit = ((carry + HALF_DIGIT) & DIGIT_MASK) - HALF_DIGIT;
        carry = (carry - digit) >> DIGIT_BITS;
        numbers[word(to + 1u + u32(column))] = digit;
        length = select(length, column + 1, digit != 0);
    }
    numbers[word(to)] = length;
}

// The sum that the product of two numbers adds to a column: digit i of one times digit column - i of the other.
fn part_of_column(x: u32, y: u32, column: i32) -> i32 {
    var sum = 0;
    let end = min(column + 1, numbers[word(x)]);
    for (var i = max(0, column + 1 - numbers[word(y)]); i < end; i++) {
        sum += numbers[word(x + 1u + u32(i))] * numbers[word(y + 1u + u32(column - i))];
    }
    return sum;
}
