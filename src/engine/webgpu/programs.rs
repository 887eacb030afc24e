//! The programs of exact arithmetic, which `shaders/webgpu/numbers.wgsl` runs. A step of a program is a sum of products
//! of two integers. Each invocation has a lane of words; an integer is stored in it at a fixed offset.

/// The word offset of the lanes, the words of a step, and the number of lanes: the same in `numbers.wgsl`.
pub(super) const LANES: usize = 512;
pub(super) const STEP: usize = 5;
pub(super) const LANE_COUNT: u32 = 8192;
/// Invocations per workgroup of the kernel, each with its own lane.
pub(super) const DECIDERS: u32 = 64;
/// Words of the whole buffer: programs and lanes.
pub(super) const WORDS: usize = LANES + LANE * LANE_COUNT as usize;

/// A word offset in a lane.
type Offset = u32;

/// Words of an input number, and of a vector of three.
const GIVEN: u32 = 9;
const VECTOR: u32 = 3 * GIVEN;

/// The differences of two points, axis by axis: a - c, b - c, a - d, b - d.
pub(super) const P: Offset = 0;
pub(super) const Q: Offset = P + VECTOR;
const R: Offset = Q + VECTOR;
const S: Offset = R + VECTOR;

/// |cos β| is mantissa / power.
pub(super) const MANTISSA: Offset = S + VECTOR;
pub(super) const POWER: Offset = MANTISSA + GIVEN;

/// The diagonals a - b and c - d, and the limit for the deviation.
pub(super) const E: Offset = POWER + GIVEN;
const F: Offset = E + VECTOR;
pub(super) const ALLOWED: Offset = F + VECTOR;

/// Integers of degree 2 in the differences.
const fn medium(i: u32) -> Offset {
    ALLOWED + GIVEN + 17 * i
}
const PP: Offset = medium(0);
pub(super) const PQ: Offset = medium(1);
const PR: Offset = medium(2);
const PS: Offset = medium(3);
const QQ: Offset = medium(4);
const QR: Offset = medium(5);
const QS: Offset = medium(6);
const RR: Offset = medium(7);
pub(super) const RS: Offset = medium(8);
const SS: Offset = medium(9);

// The same offsets, used in the plane and for the deviation.
const CROSS1: Offset = medium(0);
const DOT1: Offset = medium(1);
const CROSS2: Offset = medium(2);
const DOT2: Offset = medium(3);
const EE: Offset = medium(0);
const FF: Offset = medium(1);
const EF: Offset = medium(2);
const FP: Offset = medium(3);
const EP: Offset = medium(4);
const BEYOND: Offset = medium(5);

/// Integers of degree 4, with room for a product with the mantissa or the power of cos β.
const fn large(i: u32) -> Offset {
    medium(10) + 37 * i
}
/// The squares of two normals, and their product.
pub(super) const N: Offset = large(0);
pub(super) const M: Offset = large(1);
pub(super) const COSINE: Offset = large(2);
const X: Offset = large(3);
const Y: Offset = large(4);
const Z: Offset = large(5);
/// An integer of degree 8, with room for a product with the square of the mantissa or of the power.
pub(super) const LAST: Offset = large(6);

/// Words of a lane.
const LANE: usize = LAST as usize + 75;

/// The offset of the result and the number of terms; then the terms: two offsets, and whether the product is
/// subtracted.
type Step = [u32; STEP];

const fn plus(x: Offset, y: Offset) -> u32 {
    x | y << 10
}

const fn minus(x: Offset, y: Offset) -> u32 {
    plus(x, y) | 1 << 20
}

const fn step(to: Offset, terms: &[u32]) -> Step {
    let mut step = [0; STEP];
    step[0] = to | (terms.len() as u32) << 16;
    let mut i = 0;
    while i < terms.len() {
        step[i + 1] = terms[i];
        i += 1;
    }
    step
}

/// x·y - u·v
const fn difference(to: Offset, x: Offset, y: Offset, u: Offset, v: Offset) -> Step {
    step(to, &[plus(x, y), minus(u, v)])
}

/// The cross product of two vectors in the plane.
const fn cross(to: Offset, u: Offset, v: Offset) -> Step {
    difference(to, u, v + GIVEN, u + GIVEN, v)
}

/// The dot product of two vectors in the plane.
const fn flat_dot(to: Offset, u: Offset, v: Offset) -> Step {
    step(to, &[plus(u, v), plus(u + GIVEN, v + GIVEN)])
}

/// The dot product of two vectors in space.
const fn dot(to: Offset, u: Offset, v: Offset) -> Step {
    step(to, &[plus(u, v), plus(u + GIVEN, v + GIVEN), plus(u + 2 * GIVEN, v + 2 * GIVEN)])
}

/// (n·m)² against (cos β)² n² m².
const ANGLE: &[Step] = &[
    step(X, &[plus(COSINE, POWER)]),
    step(Y, &[plus(N, MANTISSA)]),
    step(Z, &[plus(M, MANTISSA)]),
    difference(LAST, X, X, Y, Z),
];

/// The programs, in the order of their numbers in the shaders. Dot products of normals use the Binet–Cauchy identity
/// (u × v)·(x × y) = (u·x)(v·y) - (u·y)(v·x).
const PROGRAMS: [&[Step]; 10] = [
    // The in-circle test in the plane: cross(λ)·dot(γ) + dot(λ)·cross(γ), with the angles λ at c and γ at d.
    &[
        cross(CROSS1, P, Q),
        flat_dot(DOT1, P, Q),
        cross(CROSS2, S, R),
        flat_dot(DOT2, S, R),
        step(N, &[plus(CROSS1, DOT2), plus(DOT1, CROSS2)]),
    ],
    // The areas of the new triangles.
    &[cross(N, R, P), cross(M, Q, S)],
    // In space: the squares of the old normals n = p × q and m = s × r.
    &[
        dot(PP, P, P),
        dot(PQ, P, Q),
        dot(QQ, Q, Q),
        dot(RR, R, R),
        dot(RS, R, S),
        dot(SS, S, S),
        difference(N, PP, QQ, PQ, PQ),
        difference(M, SS, RR, RS, RS),
    ],
    // n²(r·s)² - m²(p·q)²
    &[step(X, &[plus(RS, RS)]), step(Y, &[plus(PQ, PQ)]), difference(LAST, N, X, M, Y)],
    // The product of the old normals.
    &[dot(PR, P, R), dot(PS, P, S), dot(QR, Q, R), dot(QS, Q, S), difference(COSINE, PS, QR, PR, QS)],
    ANGLE,
    // The squares and the product of the new normals n = r × p and m = q × s.
    &[difference(N, RR, PP, PR, PR), difference(M, QQ, SS, QS, QS), difference(COSINE, QR, PS, RS, PQ)],
    ANGLE,
    // The products of the old normals and the new ones.
    &[
        difference(N, PR, PQ, PP, QR),
        difference(M, PQ, QS, PS, QQ),
        difference(COSINE, RS, PR, PS, RR),
        difference(LAST, QS, RS, SS, QR),
    ],
    // The distance of the diagonals, see `deviation_numbers.wgsl`.
    &[
        dot(EE, E, E),
        dot(FF, F, F),
        dot(EF, E, F),
        dot(FP, F, P),
        dot(EP, E, P),
        step(
            BEYOND,
            &[
                plus(P, P),
                plus(P + GIVEN, P + GIVEN),
                plus(P + 2 * GIVEN, P + 2 * GIVEN),
                minus(ALLOWED, ALLOWED),
            ],
        ),
        difference(N, EE, FF, EF, EF),
        difference(M, FF, BEYOND, FP, FP),
        difference(COSINE, FF, EP, EF, FP),
        difference(LAST, N, M, COSINE, COSINE),
    ],
];

/// The programs as the shaders read them: the offset of each program, the end of the last one, then the steps.
pub(super) fn words() -> Vec<u32> {
    let mut words = vec![0; PROGRAMS.len() + 1];
    for (i, program) in PROGRAMS.iter().enumerate() {
        words[i] = words.len() as u32;
        words.extend_from_slice(program.as_flattened());
    }
    words[PROGRAMS.len()] = words.len() as u32;
    words
}
