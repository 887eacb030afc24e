// Tests edges in space by exact integers.
#import any_deviation if any_deviation
#import deviation_numbers if deviation
#import doubts
#import flag_creases
#import mesh
#import numbers
#import points
#import space
#import state
#import verdicts

// Programs, in the order in which they are run. 1: the squares of the old normals. 2: the angle sum, by squares. 3: the
// dot products that the later programs take, and the product of the old normals. 4: the angle between the old normals.
// 5: the squares and the product of the new normals. 6: the angle between the new normals. 7: the products of old
// normals and new ones.
const SQUARES: u32 = 1u;
const ANGLE_SUM: u32 = 2u;
const OLD_ANGLE: u32 = 4u;
const NEW_NORMALS: u32 = 5u;
const NEW_ANGLE: u32 = 6u;
const TURNS: u32 = 7u;

// Offsets of the results of these programs: the dot products p·q and r·s, and values.
const PQ: u32 = 128u;
const RS: u32 = 240u;
const N: u32 = 272u;
const M: u32 = 308u;
const COSINE: u32 = 344u;
const LAST: u32 = 488u;

// |cos β| is mantissa / power: numbers after the differences.
const MANTISSA: u32 = 96u;
const POWER: u32 = 104u;

var<workgroup> known: Signs;

// The verdict on any edge. All invocations of a workgroup call it for the same one. In the preparation, LABELLED stands
// for an edge that is not a crease.
fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var signs = Signs(-1, 0, 1, 1);
    if step_.task != PREPARE {
        signs = filtered_signs(a, b, c, d, true);
    }
    signs = agreed(signs);
    let digit = digit_of_differences(a, b, c, d);
    put_given(select(digit, cos_digit(lane % 16u), lane >= MANTISSA && lane < POWER + GIVEN_WORDS));
    for (var program = SQUARES; verdict_of(signs) == UNDECIDED; program++) {
        let open = select(select(signs.x, signs.y, program == OLD_ANGLE), signs.z, program > OLD_ANGLE);
        if program == SQUARES || program == OLD_ANGLE - 1u || select(open, signs.w, program == TURNS) == 0 {
            run(program);
            signs = agreed(signs_after(program, signs));
        }
    }
    var verdict = verdict_of(signs);
    if verdict == LABELLED {
        verdict = exact_deviation(a, b, c, d);
    }
    return verdict;
}

// The signs that the first invocation knows: loops with barriers need the same value in all.
fn agreed(signs: Signs) -> Signs {
    if lane == 0u {
        known = signs;
    }
    return workgroupUniformLoad(&known);
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

// The verdict on the geometry of each edge, UNDECIDED if the invocations have to decide it together. In the preparation,
// whether it is a crease.
fn verdicts_alone(t: u32) -> vec3u {
    var verdicts = vec3u();
    if step_.task == PREPARE {
        verdicts = filtered_creases(t);
    } else {
        verdicts = close_verdicts_on(t, step_.task == CENSUS);
    }
    return verdicts;
}

fn prepare(t: u32, verdicts: vec3u) {
    flag_creases(t, verdicts);
    choices[t] = NONE;
}
