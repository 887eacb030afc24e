//! What exact arithmetic computes on the device, as `shaders/webgpu/numbers.wgsl` runs it: programs of steps, each a sum of products
//! of two integers. An integer has a place in the lane of an invocation.

/// Words before the lanes, those of a step, and the lanes: as in `numbers.wgsl`.
pub(super) const LANES: usize = 512;
pub(super) const STEP: usize = 5;
pub(super) const LANE_COUNT: u32 = 8192;
/// Invocations of a workgroup of the kernel, each with a lane.
pub(super) const DECIDERS: u32 = 64;
/// Words of the programs and the lanes.
pub(super) const WORDS: usize = LANES + LANE * LANE_COUNT as usize;

type Place = u32;

/// Words of a number that is given, and of a vector of three.
const GIVEN: u32 = 9;
const VECTOR: u32 = 3 * GIVEN;

/// The differences of two points, axis by axis: a - c, b - c, a - d, b - d.
pub(super) const P: Place = 0;
pub(super) const Q: Place = P + VECTOR;
const R: Place = Q + VECTOR;
const S: Place = R + VECTOR;

/// |cos β| is mantissa / power.
pub(super) const MANTISSA: Place = S + VECTOR;
pub(super) const POWER: Place = MANTISSA + GIVEN;

/// a - b and c - d, and what diagonals may be apart.
pub(super) const E: Place = POWER + GIVEN;
const F: Place = E + VECTOR;
pub(super) const ALLOWED: Place = F + VECTOR;

/// Integers of degree 2 in the differences.
const fn medium(i: u32) -> Place {
    ALLOWED + GIVEN + 17 * i
}
const PP: Place = medium(0);
pub(super) const PQ: Place = medium(1);
const PR: Place = medium(2);
const PS: Place = medium(3);
const QQ: Place = medium(4);
const QR: Place = medium(5);
const QS: Place = medium(6);
const RR: Place = medium(7);
pub(super) const RS: Place = medium(8);
const SS: Place = medium(9);

// Others in the same places: in the plane, and of diagonals.
const CROSS1: Place = medium(0);
const DOT1: Place = medium(1);
const CROSS2: Place = medium(2);
const DOT2: Place = medium(3);
const EE: Place = medium(0);
const FF: Place = medium(1);
const EF: Place = medium(2);
const FP: Place = medium(3);
const EP: Place = medium(4);
const BEYOND: Place = medium(5);

/// Integers of degree 4, and those times a factor of cos β.
const fn large(i: u32) -> Place {
    medium(10) + 37 * i
}
/// The squares of two normals, and their product.
pub(super) const N: Place = large(0);
pub(super) const M: Place = large(1);
pub(super) const COSINE: Place = large(2);
const X: Place = large(3);
const Y: Place = large(4);
const Z: Place = large(5);
/// Of degree 8, and times those factors.
pub(super) const LAST: Place = large(6);

/// Words of a lane.
const LANE: usize = LAST as usize + 75;

/// A place and how many terms there are, then the terms: two places each, and whether the product is subtracted.
type Step = [u32; STEP];

const fn plus(x: Place, y: Place) -> u32 {
    x | y << 10
}

const fn minus(x: Place, y: Place) -> u32 {
    plus(x, y) | 1 << 20
}

const fn step(to: Place, terms: &[u32]) -> Step {
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
const fn difference(to: Place, x: Place, y: Place, u: Place, v: Place) -> Step {
    step(to, &[plus(x, y), minus(u, v)])
}

/// In the plane: the cross product of two vectors, and the dot product.
const fn cross(to: Place, u: Place, v: Place) -> Step {
    difference(to, u, v + GIVEN, u + GIVEN, v)
}

const fn flat_dot(to: Place, u: Place, v: Place) -> Step {
    step(to, &[plus(u, v), plus(u + GIVEN, v + GIVEN)])
}

/// In space.
const fn dot(to: Place, u: Place, v: Place) -> Step {
    step(to, &[plus(u, v), plus(u + GIVEN, v + GIVEN), plus(u + 2 * GIVEN, v + 2 * GIVEN)])
}

/// (n·m)² against (cos β)² n² m².
const ANGLE: &[Step] = &[
    step(X, &[plus(COSINE, POWER)]),
    step(Y, &[plus(N, MANTISSA)]),
    step(Z, &[plus(M, MANTISSA)]),
    difference(LAST, X, X, Y, Z),
];

/// In the order of their numbers in the shaders. Dot products of normals are by the identity of Binet and Cauchy,
/// (u × v)·(x × y) = (u·x)(v·y) - (u·y)(v·x).
const PROGRAMS: [&[Step]; 10] = [
    // In the plane: cross(λ)·dot(γ) + dot(λ)·cross(γ).
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
    // Of the new normals n = r × p and m = q × s the squares and the product.
    &[difference(N, RR, PP, PR, PR), difference(M, QQ, SS, QS, QS), difference(COSINE, QR, PS, RS, PQ)],
    ANGLE,
    // The products of the old normals and the new ones.
    &[
        difference(N, PR, PQ, PP, QR),
        difference(M, PQ, QS, PS, QQ),
        difference(COSINE, RS, PR, PS, RR),
        difference(LAST, QS, RS, SS, QR),
    ],
    // How far apart diagonals are, see `deviation_numbers.wgsl`.
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

/// As the shaders read them: where each begins and the last one ends, then the steps.
pub(super) fn words() -> Vec<u32> {
    let mut words = vec![0; PROGRAMS.len() + 1];
    for (i, program) in PROGRAMS.iter().enumerate() {
        words[i] = words.len() as u32;
        words.extend_from_slice(program.as_flattened());
    }
    words[PROGRAMS.len()] = words.len() as u32;
    words
}
