//! The exact tests of the simulation: integers of any size, no filter, no bound to prove.

use edgeflip::{Dimension, Mesh, Reason, cos_degrees};
use num_bigint::BigInt;
use std::cmp::Ordering;

type Vector = [BigInt; 3];

/// `None` for a Delaunay edge, else whether it may flip.
pub type Verdict = Option<Result<(), Reason>>;

pub struct Predicates {
    dimension: Dimension,
    /// All coordinates times one power of two that makes them integers.
    points: Vec<Vector>,
    /// cos β = mantissa / 2^shift.
    cosine: (BigInt, u32),
    /// The limit for the deviation, in the units of the points.
    deviation: Option<BigInt>,
}

/// |x| = mantissa · 2^(exponent - 1074).
fn decode(x: f64) -> (u64, u64) {
    let (biased, fraction) = (x.to_bits() >> 52 & 0x7ff, x.to_bits() & ((1 << 52) - 1));
    if biased == 0 { (fraction, 0) } else { (fraction | 1 << 52, biased - 1) }
}

fn minus(x: &Vector, y: &Vector) -> Vector {
    [0, 1, 2].map(|i| &x[i] - &y[i])
}

fn dot(x: &Vector, y: &Vector) -> BigInt {
    &x[0] * &y[0] + &x[1] * &y[1] + &x[2] * &y[2]
}

fn cross(x: &Vector, y: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &x[i] * &y[j] - &x[j] * &y[i])
}

fn sign(x: &BigInt) -> Ordering {
    x.cmp(&BigInt::ZERO)
}

/// The sign of x·√m + y·√n.
fn root_sum_sign(x: &BigInt, m: &BigInt, y: &BigInt, n: &BigInt) -> Ordering {
    // x·√m as its sign times its square.
    let signed_square = |x: &BigInt, m: &BigInt| if sign(x).is_lt() { -(x * x * m) } else { x * x * m };
    signed_square(x, m).cmp(&-signed_square(y, n))
}

impl Predicates {
    pub fn new(mesh: &Mesh, beta_deg: f64, deviation: f64) -> Self {
        let positions: Vec<f64> = mesh.positions().iter().collect();
        // The largest 32-bit float that is not larger.
        let mut most = deviation as f32;
        while f64::from(most) > deviation {
            most = most.next_down();
        }
        let most = most.is_finite().then_some(f64::from(most));
        let nonzero = positions.iter().chain(&most).filter(|&&x| x != 0.0);
        let least =
            nonzero.map(|&x| decode(x).1 + u64::from(decode(x).0.trailing_zeros())).min().unwrap_or(0);
        let integer = |x: f64| {
            let (mantissa, exponent) = decode(x);
            let scaled = (BigInt::from(mantissa) << exponent) >> least;
            if x < 0.0 { -scaled } else { scaled }
        };
        let stride = mesh.dimension().stride();
        let point = |p: &[f64]| [0, 1, 2].map(|i| p.get(i).map_or(BigInt::ZERO, |&x| integer(x)));
        let points = positions.chunks(stride).map(point).collect();

        let cosine = cos_degrees(beta_deg);
        // The cosine times 2^200 is an integer: the cosine has 53 bits, and is 0 or at least 2^-60 in magnitude.
        let bits = cosine.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as u32;
        let mantissa = BigInt::from(bits & ((1 << 52) - 1) | 1 << 52);
        let mantissa = if cosine == 0.0 { BigInt::ZERO } else { mantissa << (exponent + 200 - 1075) };
        let cosine = (if cosine < 0.0 { -mantissa } else { mantissa }, 200);
        Self { dimension: mesh.dimension(), points, cosine, deviation: most.map(integer) }
    }

    fn normal(&self, corners: [u32; 3]) -> Vector {
        let [p, q, r] = corners.map(|v| &self.points[v as usize]);
        cross(&minus(p, r), &minus(q, r))
    }

    /// The dot product of the vectors from the third corner to the other two.
    fn dot(&self, corners: [u32; 3]) -> BigInt {
        let [p, q, r] = corners.map(|v| &self.points[v as usize]);
        dot(&minus(p, r), &minus(q, r))
    }

    /// Doubled signed area (2D).
    pub fn area(&self, corners: [u32; 3]) -> BigInt {
        let [_, _, z] = self.normal(corners);
        z
    }

    /// Minus where the angles at the third corners sum to more than π: the sign of |n1|·dot2 + |n2|·dot1.
    fn angle_sum_sign(&self, first: [u32; 3], second: [u32; 3]) -> Ordering {
        let square = |corners| {
            let normal = self.normal(corners);
            dot(&normal, &normal)
        };
        root_sum_sign(&self.dot(second), &square(first), &self.dot(first), &square(second))
    }

    /// Whether the angles at the third corners sum to more than π.
    pub fn exceeds_pi(&self, first: [u32; 3], second: [u32; 3]) -> bool {
        self.angle_sum_sign(first, second).is_lt()
    }

    /// The sign of n1·n2 - cos β · |n1|·|n2|.
    fn angle_sign(&self, n1: &Vector, n2: &Vector) -> Ordering {
        let (mantissa, shift) = &self.cosine;
        let lengths = dot(n1, n1) * dot(n2, n2);
        root_sum_sign(&(dot(n1, n2) << *shift), &BigInt::from(1), &-mantissa, &lengths)
    }

    /// Whether the normals of two triangles differ by more than β (3D).
    pub fn is_sharp(&self, [a, b, c, d]: [u32; 4]) -> bool {
        self.dimension == Dimension::Three
            && self.angle_sign(&self.normal([a, b, c]), &self.normal([b, a, d])).is_lt()
    }

    /// Compares the distance of the lines a b and c d with the limit.
    fn compare_distance(&self, quad: [u32; 4]) -> Ordering {
        let Some(most) = &self.deviation else { return Ordering::Less };
        let [a, b, c, d] = quad.map(|v| &self.points[v as usize]);
        let across = cross(&minus(a, b), &minus(c, d));
        let volume = dot(&across, &minus(a, c));
        (&volume * &volume).cmp(&(most * most * dot(&across, &across)))
    }

    /// The verdict from the positions of the four vertices alone.
    pub fn verdict(&self, quad: [u32; 4], clockwise: bool) -> Verdict {
        self.decide(quad, clockwise).0
    }

    /// The verdict, and whether it depends on a sign that is zero.
    pub fn decide(&self, [a, b, c, d]: [u32; 4], clockwise: bool) -> (Verdict, bool) {
        let (old1, old2, new1, new2) = ([a, b, c], [b, a, d], [a, d, c], [b, c, d]);
        match self.dimension {
            Dimension::Two => {
                let orient = |x: Ordering| if clockwise { x.reverse() } else { x };
                let s = self.area(old1) * self.dot(old2) + self.dot(old1) * self.area(old2);
                let s = orient(sign(&s));
                if s.is_ge() {
                    return (None, s.is_eq());
                }
                let areas = [new1, new2].map(|corners| orient(sign(&self.area(corners))));
                match areas.into_iter().min() {
                    Some(Ordering::Greater) => (Some(Ok(())), false),
                    least => (Some(Err(Reason::Fold)), least == Some(Ordering::Equal)),
                }
            }
            Dimension::Three => {
                let sum = self.angle_sum_sign(old1, old2);
                if sum.is_ge() {
                    return (None, sum.is_eq());
                }
                let [n1, n2, m1, m2] = [old1, old2, new1, new2].map(|corners| self.normal(corners));
                let angles = [(&n1, &n2), (&m1, &m2)].map(|(n, m)| self.angle_sign(n, m));
                if angles.iter().any(|angle| angle.is_lt()) {
                    return (Some(Err(Reason::Angle)), false);
                }
                let turns = [(&n1, &m1), (&n1, &m2), (&n2, &m1), (&n2, &m2)].map(|(n, m)| sign(&dot(n, m)));
                if turns.iter().any(|turn| turn.is_lt()) {
                    return (Some(Err(Reason::Fold)), angles.contains(&Ordering::Equal));
                }
                let apart = self.compare_distance([a, b, c, d]);
                let is_tie = angles.iter().chain(&turns).any(|sign| sign.is_eq());
                (Some(if apart.is_gt() { Err(Reason::Deviation) } else { Ok(()) }), is_tie || apart.is_eq())
            }
        }
    }
}
