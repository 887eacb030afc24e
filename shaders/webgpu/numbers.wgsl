// Computes with exact integers in workgroup memory. A number is a sum of digit i times 2^(13·i); its digits are at a
// fixed offset, the lowest first. All invocations of a workgroup compute together, each one column of a sum of
// products. Programs (src/engine/webgpu/programs.rs) define the sums. The code for the product of two numbers therefore
// exists only once. Inlined everywhere, it would compile for seconds.
#import integers
#import points

const DIGIT_BITS: u32 = 13u;
const HALF_DIGIT: i32 = 4096;
const DIGIT_MASK: i32 = 8191;

// Invocations of a workgroup: at least as many as the columns of the steps that they compute at the same time.
const DECIDERS: u32 = 128u;

// The first step of each program, the end of the last one, then the steps: up to four products of two numbers each. See
// programs.rs for the bits.
const TABLE: u32 = 58u;
@group(0) @binding(9) var<uniform> programs: array<vec4u, TABLE>;

// Words of all numbers, and of an input number: none has fewer.
const WORDS: u32 = 562u;
const GIVEN_WORDS: u32 = 8u;

var<workgroup> digits: array<i32, WORDS>;
// How many digits each number has, by its offset / GIVEN_WORDS. The digits above are not written.
var<workgroup> lengths: array<atomic<u32>, WORDS / GIVEN_WORDS + 1u>;
// The carries into each column, for two rounds. Into the first column there is none.
var<workgroup> carries: array<array<i32, DECIDERS + 1u>, 2>;

var<private> lane: u32;

fn length_at(offset: u32) -> u32 {
    return atomicLoad(&lengths[offset / GIVEN_WORDS]);
}

// The highest digit has the sign of the number: the digits below it add up to less than one of its units.
fn sign_at(offset: u32) -> i32 {
    let length = length_at(offset);
    return select(0, sign(digits[offset + max(length, 1u) - 1u]), length > 0u);
}

fn put(offset: u32, column: u32, digit: i32) {
    digits[offset + column] = digit;
    if digit != 0 {
        atomicMax(&lengths[offset / GIVEN_WORDS], column + 1u);
    }
}

// Writes the input numbers, the first words: each invocation has one digit.
fn put_given(digit: i32) {
    atomicStore(&lengths[lane / GIVEN_WORDS], 0u);
    workgroupBarrier();
    put(lane - lane % GIVEN_WORDS, lane % GIVEN_WORDS, digit);
    workgroupBarrier();
}

// The digit of this invocation, of an integer of up to 91 bits, as magnitude and sign.
fn given_digit(x: vec4u) -> i32 {
    let bit = DIGIT_BITS * (lane % GIVEN_WORDS);
    let low = component_of(x.xyz, bit / 32u);
    let high = component_of(vec3u(x.yz, 0u), bit / 32u);
    let digit = i32(((low >> (bit % 32u)) | ((high << 1u) << (31u - bit % 32u))) & u32(DIGIT_MASK));
    return select(digit, -digit, x.w == 1u);
}

// The digit of this invocation, of the differences p = a - c, q = b - c, r = a - d and s = b - d, axis by axis.
fn digit_of_differences(a: Point, b: Point, c: Point, d: Point) -> i32 {
    let number = lane / GIVEN_WORDS;
    var u = a;
    var v = c;
    if ((number / 3u) & 1u) == 1u {
        u = b;
    }
    if number >= 6u {
        v = d;
    }
    return given_digit(exact_difference(u, v, number % 3u, grid_of(a, b, c, d)));
}

fn run(program: u32) {
    let end = programs[program + 1u].x;
    var at = programs[program].x;
    while at < end {
        run_steps(at);
        at += programs[at].y >> 22u;
    }
}

// Runs steps that do not need each other's results.
//
// Digits are from -8191 to 8191 in input numbers, but 2^15 in the power of cos β, and from -4125 to 4125 in computed
// ones. No sum of products reaches 2^31 - 4096: the largest has 4 products of 7 digits below 8192 (a test in programs.rs
// checks all). So two rounds of carries suffice. After the first, a column is a rest from -4096 to 4095 and a carry of
// magnitude at most 2^31 / 8192 = 2^18, so the next carry has magnitude at most 2^18 / 8192 + 1 = 33, in fact at most
// 29. After the second, a column is such a rest and that carry.
fn run_steps(first: u32) {
    let count = programs[first].y >> 22u;
    let width = programs[first].z >> 22u;
    let index = lane / width;
    let column = lane % width;
    var step = programs[first + min(index, count - 1u)];
    let to = step.x >> 22u;
    var sum = 0;
    var end = 0u;
    for (var i = 0u; i < 4u && index < count; i++) {
        let sign = i32((step.x >> 20u) & 1u) - i32((step.x >> 21u) & 1u);
        if sign != 0 {
            let x = step.x & 1023u;
            let y = (step.x >> 10u) & 1023u;
            let of_x = length_at(x);
            let of_y = length_at(y);
            end = max(end, of_x + of_y + 1u);
            // Digit j of one times digit column - j of the other.
            let last = min(column + 1u, of_x);
            for (var j = max(column + 1u, of_y) - of_y; j < last; j++) {
                sum += sign * digits[x + j] * digits[y + column - j];
            }
        }
        step = step.yzwx;
    }
    if column == 0u && index < count {
        atomicStore(&lengths[to / GIVEN_WORDS], 0u);
    }
    let digit = carried(carried(sum, 0u), 1u);
    if column < end {
        put(to, column, digit);
    }
    workgroupBarrier();
}

// A column with the carry from the one below, and without its own. Columns above a product are 0, so that nothing is
// carried into the next one.
fn carried(column: i32, round: u32) -> i32 {
    let digit = ((column + HALF_DIGIT) & DIGIT_MASK) - HALF_DIGIT;
    carries[round][lane + 1u] = (column - digit) >> DIGIT_BITS;
    workgroupBarrier();
    return digit + carries[round][lane];
}
