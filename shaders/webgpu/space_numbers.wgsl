// Tests edges in space by exact integers in memory.
#import any_deviation if any_deviation
#import deviation if deviation
#import deviation_numbers if deviation
#import doubts
#import flag_creases
#import mesh
#import numbers
#import points
#import space
#import state
#import verdicts

// Programs, in the order in which they are run. 2: the squares of the old normals. 3: the angle sum, by squares. 4: the
// dot products that the later programs take, and the product of the old normals. 5: the angle between the old normals.
// 6: the squares and the product of the new normals. 7: the angle between the new normals. 8: the products of old
// normals and new ones.
const SQUARES: u32 = 2u;
const ANGLE_SUM: u32 = 3u;
const OLD_ANGLE: u32 = 5u;
const NEW_NORMALS: u32 = 6u;
const NEW_ANGLE: u32 = 7u;
const TURNS: u32 = 8u;

// Offsets of the results of these programs: the dot products p·q and r·s, and values.
const PQ: u32 = 206u;
const RS: u32 = 325u;
const N: u32 = 359u;
const M: u32 = 396u;
const COSINE: u32 = 433u;
const LAST: u32 = 581u;

// |cos β| is mantissa / power.
const MANTISSA: u32 = 108u;
const POWER: u32 = 117u;

// The verdict on any edge: by a filter that is slower and decides more, then by integers. In the preparation, LABELLED
// stands for an edge that is not a crease.
fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32, task: u32) -> u32 {
    var signs = Signs(-1, 0, 1, 1);
    if task != PREPARE {
        signs = filtered_signs(a, b, c, d, true);
    }
    if verdict_of(signs) == UNDECIDED {
        signs = exact_signs(a, b, c, d, signs);
    }
    var verdict = verdict_of(signs);
    if verdict == LABELLED {
        verdict = filtered_deviation(a, b, c, d);
    }
    if verdict == UNDECIDED {
        verdict = exact_deviation(a, b, c, d);
    }
    return verdict;
}

// The signs. Integers decide the undecided ones that matter.
fn exact_signs(a: Point, b: Point, c: Point, d: Point, filtered: Signs) -> Signs {
    put_differences(a, b, c, d, grid_of(a, b, c, d));
    put_cosine();
    var signs = filtered;
    for (var program = SQUARES; verdict_of(signs) == UNDECIDED; program++) {
        let open = select(select(signs.x, signs.y, program == OLD_ANGLE), signs.z, program > OLD_ANGLE);
        if program == SQUARES || program == OLD_ANGLE - 1u || select(open, signs.w, program == TURNS) == 0 {
            run(program);
            signs = signs_after(program, signs);
        }
    }
    return signs;
}

fn put_cosine() {
    for (var factor = 0u; factor < 2u; factor++) {
        let offset = select(MANTISSA, POWER, factor == 1u);
        var length = 0;
        for (var i = 0u; i < 8u; i++) {
            let digit = cos_digit(8u * factor + i);
            numbers[word(offset + 1u + i)] = digit;
            length = select(length, i32(i) + 1, digit != 0);
        }
        numbers[word(offset)] = length;
    }
}

// The signs with those that a program has decided.
fn signs_after(program: u32, before: Signs) -> Signs {
    let first = sign_at(N);
    let second = sign_at(M);
    let third = sign_at(COSINE);
    let last = sign_at(LAST);
    var signs = before;
    if program == ANGLE_SUM {
        // Whether |n1|(r·s) + |n2|(p·q) < 0: by the squares, with the signs of what was squared.
        let left = first * sign_at(RS);
        let right = second * sign_at(PQ);
        signs.x = select(1, -1, select(left + right, left * last, left * right < 0) < 0);
    } else if program == OLD_ANGLE || program == NEW_ANGLE {
        // Whether n·m < cos β |n||m|.
        let right = cos_sign() * first * second;
        let angle = select(1, -1, select(third - right, third * last, third * right > 0) < 0);
        signs = select(Signs(signs.xy, angle, signs.w), Signs(signs.x, angle, signs.zw), program == OLD_ANGLE);
    } else if program == TURNS {
        signs.w = select(1, -1, min(min(first, second), min(third, last)) < 0);
    }
    return signs;
}

// In the preparation, whether each edge is a crease; else the verdict on the geometry of each.
fn filtered_answers(t: u32, task: u32) -> vec3u {
    var answers = vec3u();
    if task == PREPARE {
        answers = filtered_creases(t);
    } else {
        answers = verdicts_on(t, task == CENSUS, false);
    }
    return answers;
}

fn prepare(t: u32, answers: vec3u) {
    flag_creases(t, answers);
    choices[t] = NONE;
}
