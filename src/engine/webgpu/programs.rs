//! The programs of exact arithmetic, which `shaders/webgpu/numbers.wgsl` runs. A step of a program is a sum of products
//! of two integers. A workgroup keeps the integers at fixed offsets.

/// Invocations per workgroup of the kernel.
pub(super) const DECIDERS: u32 = 128;

/// Triangles that one workgroup decides.
pub(super) const SLICE: u32 = 8;

/// A word offset in the memory of a workgroup.
type Offset = u32;

/// Words of an input number, and of a vector of three.
pub(super) const GIVEN: u32 = 8;
const VECTOR: u32 = 3 * GIVEN;

/// The differences of two points, axis by axis: a - c, b - c, a - d, b - d.
const P: Offset = 0;
const Q: Offset = P + VECTOR;
const R: Offset = Q + VECTOR;
const S: Offset = R + VECTOR;

/// |cos β| is mantissa / power.
pub(super) const MANTISSA: Offset = S + VECTOR;
pub(super) const POWER: Offset = MANTISSA + GIVEN;

/// For the deviation, in the place of differences: the diagonals a - b and c - d, and the limit.
const E: Offset = Q;
const F: Offset = R;
const ALLOWED: Offset = S;

/// Integers of degree 2 in the differences.
const fn medium(i: u32) -> Offset {
    POWER + GIVEN + 16 * i
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
    medium(10) + 36 * i
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

/// Words of all numbers.
#[cfg(test)]
pub(super) const WORDS: u32 = LAST + 74;

/// The terms: two offsets in ten bits each, then whether the product is added, and whether it is subtracted. The ten
/// highest bits of the first three terms are the offset of the result, and, if the step is the first of a group, how many
/// steps the group has and how many invocations each of them.
type Step = [u32; 4];

/// Steps that do not need each other's results.
type Group = &'static [Step];

const fn plus(x: Offset, y: Offset) -> u32 {
    x | y << 10 | 1 << 20
}

const fn minus(x: Offset, y: Offset) -> u32 {
    x | y << 10 | 1 << 21
}

const fn step(to: Offset, terms: &[u32]) -> Step {
    let mut step = [0; 4];
    let mut i = 0;
    while i < terms.len() {
        step[i] = terms[i];
        i += 1;
    }
    step[0] |= to << 22;
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
const ANGLE: &[Group] = &[
    &[step(X, &[plus(COSINE, POWER)]), step(Y, &[plus(N, MANTISSA)]), step(Z, &[plus(M, MANTISSA)])],
    &[difference(LAST, X, X, Y, Z)],
];

/// The programs, in the order of their numbers in the shaders. Dot products of normals use the Binet–Cauchy identity
/// (u × v)·(x × y) = (u·x)(v·y) - (u·y)(v·x).
const PROGRAMS: [&[Group]; 9] = [
    // The in-circle test in the plane: cross(λ)·dot(γ) + dot(λ)·cross(γ), with the angles λ at c and γ at d; and the areas
    // of the new triangles.
    &[
        &[cross(CROSS1, P, Q), flat_dot(DOT1, P, Q), cross(CROSS2, S, R), flat_dot(DOT2, S, R)],
        &[step(N, &[plus(CROSS1, DOT2), plus(DOT1, CROSS2)]), cross(M, R, P), cross(COSINE, Q, S)],
    ],
    // In space: the squares of the old normals n = p × q and m = s × r, and of (r·s) and (p·q).
    &[
        &[dot(PP, P, P), dot(PQ, P, Q), dot(QQ, Q, Q), dot(RR, R, R), dot(RS, R, S), dot(SS, S, S)],
        &[
            difference(N, PP, QQ, PQ, PQ),
            difference(M, SS, RR, RS, RS),
            step(X, &[plus(RS, RS)]),
            step(Y, &[plus(PQ, PQ)]),
        ],
    ],
    // n²(r·s)² - m²(p·q)²
    &[&[difference(LAST, N, X, M, Y)]],
    // The product of the old normals.
    &[&[dot(PR, P, R), dot(PS, P, S), dot(QR, Q, R), dot(QS, Q, S)], &[difference(COSINE, PS, QR, PR, QS)]],
    ANGLE,
    // The squares and the product of the new normals n = r × p and m = q × s.
    &[&[difference(N, RR, PP, PR, PR), difference(M, QQ, SS, QS, QS), difference(COSINE, QR, PS, RS, PQ)]],
    ANGLE,
    // The products of the old normals and the new ones.
    &[&[
        difference(N, PR, PQ, PP, QR),
        difference(M, PQ, QS, PS, QQ),
        difference(COSINE, RS, PR, PS, RR),
        difference(LAST, QS, RS, SS, QR),
    ]],
    // The distance of the diagonals, see `deviation_numbers.wgsl`.
    &[
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
        ],
        &[
            difference(N, EE, FF, EF, EF),
            difference(M, FF, BEYOND, FP, FP),
            difference(COSINE, FF, EP, EF, FP),
        ],
        &[difference(LAST, N, M, COSINE, COSINE)],
    ],
];

/// The programs as the shaders read them: the first step of each program, the end of the last one, then the steps.
pub(super) fn table() -> Vec<[u32; 4]> {
    let mut table = vec![[0; 4]; PROGRAMS.len() + 1];
    for (i, program) in PROGRAMS.iter().enumerate() {
        table[i][0] = table.len() as u32;
        for group in *program {
            let first = table.len();
            table.extend_from_slice(group);
            let count = group.len() as u32;
            table[first][1] |= count << 22;
            table[first][2] |= (DECIDERS / count) << 22;
        }
    }
    table[PROGRAMS.len()][0] = table.len() as u32;
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::gpu::cosine::DIGIT_BITS;
    use crate::engine::gpu::probe::SHORT_STAR;
    use crate::engine::gpu::upload::SPAN;
    use std::collections::HashMap;

    /// The rounds of all loops of an invocation that llvmpipe runs.
    const ROUNDS: u32 = 65_535;

    /// What is known of a number: the largest magnitude, digits, and the largest magnitude of one.
    #[derive(Clone, Copy)]
    struct Bound {
        most: f64,
        length: u32,
        digit: i64,
    }

    /// The numbers that the shader writes before it runs programs.
    fn given() -> HashMap<Offset, Bound> {
        // A limit for the deviation has one bit more than a difference.
        let difference = Bound { most: 2f64.powi(SPAN as i32 + 2), length: 7, digit: 8191 };
        let mut given: HashMap<_, _> = (0..12).map(|i| (P + GIVEN * i, difference)).collect();
        given.insert(MANTISSA, Bound { most: 2f64.powi(53), length: 5, digit: 8191 });
        given.insert(POWER, Bound { most: 2f64.powi(106), length: 8, digit: 1 << 15 });
        given
    }

    /// Runs all programs on the bounds of numbers. No sum overflows, and all numbers and steps have room.
    #[test]
    fn the_longest_numbers_have_room() {
        let mut known = given();
        let mut rounds = 0;
        let room = |to: Offset| match to {
            ..N => 16,
            N..LAST => 36,
            LAST.. => WORDS - LAST,
        };
        for group in PROGRAMS.into_iter().flatten() {
            let mut longest = 0;
            for step in *group {
                let terms: Vec<[Bound; 2]> = step
                    .iter()
                    .filter(|&term| term >> 20 & 3 != 0)
                    .map(|term| [term & 1023, term >> 10 & 1023].map(|offset| known[&offset]))
                    .collect();
                let sum: i64 =
                    terms.iter().map(|[x, y]| i64::from(x.length.min(y.length)) * x.digit * y.digit).sum();
                assert!(sum < i64::from(i32::MAX) - 4096, "{step:?}: {sum}");
                // Two rounds of carries.
                let first = 4096 + (sum + 4096) / 8192;
                let digit = 4096 + (first + 4096) / 8192;
                let columns = terms.iter().map(|[x, y]| x.length + y.length + 1).max().unwrap_or(0);
                let to = step[0] >> 22;
                assert!(digit <= 4125 && columns <= room(to), "{step:?}: {digit}, {columns}");
                assert!(columns <= DECIDERS / group.len() as u32, "{step:?}: {columns} columns");
                // Digits of up to 4125 below the highest one add up to less than 0.504 of its unit.
                let most: f64 = terms.iter().map(|[x, y]| x.most * y.most).sum();
                let length = ((most / 0.496).log2() / f64::from(DIGIT_BITS)) as u32 + 1;
                known.insert(to, Bound { most, length: length.min(columns), digit });
                let products = terms.iter().map(|[x, y]| x.length.min(y.length)).sum::<u32>();
                longest = longest.max(4 + products);
            }
            rounds += longest + 1;
        }
        // All three edges of each triangle, and walks around the vertices across two of them.
        assert!(3 * SLICE * rounds + 2 * SHORT_STAR < ROUNDS, "{rounds} rounds");
    }
}
