//! The exact tests of the simulation: integers of any size, no filter, no bound to prove.

use edgeflip::{Dimension, Mesh, Reason};
use num_bigint::{BigInt, Sign};

type Vector = [BigInt; 3];

/// `None` for a Delaunay edge, else whether it may flip.
pub type Verdict = Option<Result<(), Reason>>;

pub struct Predicates {
    dimension: Dimension,
    /// All coordinates times one power of two that makes them integers.
    points: Vec<Vector>,
    /// cos β = mantissa / 2^shift.
    cosine: (BigInt, u32),
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

fn is_negative(x: &BigInt) -> bool {
    x.sign() == Sign::Minus
}

/// x·√m + y·√n < 0.
fn negative_sum(x: &BigInt, m: &BigInt, y: &BigInt, n: &BigInt) -> bool {
    // x·√m as its sign times its square.
    let signed_square = |x: &BigInt, m: &BigInt| if is_negative(x) { -(x * x * m) } else { x * x * m };
    signed_square(x, m) < -signed_square(y, n)
}

impl Predicates {
    pub fn new(mesh: &Mesh, beta_deg: f64) -> Self {
        let positions: Vec<f64> = mesh.positions().iter().collect();
        let nonzero = positions.iter().filter(|&&x| x != 0.0);
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

        let cosine = match beta_deg {
            0.0 => 1.0,
            60.0 => 0.5,
            90.0 => 0.0,
            120.0 => -0.5,
            180.0 => -1.0,
            _ => libm::cos(beta_deg * (std::f64::consts::PI / 180.0)),
        };
        // Times 2^200 the cosine is an integer: it is 0 or at least 2^-60 in size, of 53 bits.
        let bits = cosine.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as u32;
        let mantissa = BigInt::from(bits & ((1 << 52) - 1) | 1 << 52);
        let mantissa = if cosine == 0.0 { BigInt::ZERO } else { mantissa << (exponent + 200 - 1075) };
        let cosine = (if cosine < 0.0 { -mantissa } else { mantissa }, 200);
        Self { dimension: mesh.dimension(), points, cosine }
    }

    fn normal(&self, corners: [u32; 3]) -> Vector {
        let [p, q, r] = corners.map(|v| &self.points[v as usize]);
        cross(&minus(p, r), &minus(q, r))
    }

    /// Of the vectors from the third corner to the other two.
    fn dot(&self, corners: [u32; 3]) -> BigInt {
        let [p, q, r] = corners.map(|v| &self.points[v as usize]);
        dot(&minus(p, r), &minus(q, r))
    }

    /// Doubled signed area (2D).
    pub fn area(&self, corners: [u32; 3]) -> BigInt {
        let [_, _, z] = self.normal(corners);
        z
    }

    /// Whether the angles at the third corners sum to more than π: |n1|·dot2 + |n2|·dot1 < 0.
    pub fn exceeds_pi(&self, first: [u32; 3], second: [u32; 3]) -> bool {
        let square = |corners| {
            let normal = self.normal(corners);
            dot(&normal, &normal)
        };
        negative_sum(&self.dot(second), &square(first), &self.dot(first), &square(second))
    }

    /// n1·n2 < cos β · |n1|·|n2|.
    fn differ(&self, n1: &Vector, n2: &Vector) -> bool {
        let (mantissa, shift) = &self.cosine;
        let lengths = dot(n1, n1) * dot(n2, n2);
        negative_sum(&(dot(n1, n2) << *shift), &BigInt::from(1), &-mantissa, &lengths)
    }

    /// What the four points alone tell of an edge.
    /// Whether the normals of two triangles differ by more than β (3D).
    pub fn is_sharp(&self, [a, b, c, d]: [u32; 4]) -> bool {
        self.dimension == Dimension::Three && self.differ(&self.normal([a, b, c]), &self.normal([b, a, d]))
    }

    pub fn verdict(&self, [a, b, c, d]: [u32; 4], clockwise: bool) -> Verdict {
        let (old1, old2, new1, new2) = ([a, b, c], [b, a, d], [a, d, c], [b, c, d]);
        match self.dimension {
            Dimension::Two => {
                let orient = |x: BigInt| if clockwise { -x } else { x };
                let s = self.area(old1) * self.dot(old2) + self.dot(old1) * self.area(old2);
                let positive = |corners| orient(self.area(corners)).sign() == Sign::Plus;
                is_negative(&orient(s))
                    .then(|| if positive(new1) && positive(new2) { Ok(()) } else { Err(Reason::Fold) })
            }
            Dimension::Three => {
                let [n1, n2, m1, m2] = [old1, old2, new1, new2].map(|corners| self.normal(corners));
                let turned = [(&n1, &m1), (&n1, &m2), (&n2, &m1), (&n2, &m2)];
                self.exceeds_pi(old1, old2).then(|| {
                    if self.differ(&n1, &n2) || self.differ(&m1, &m2) {
                        Err(Reason::Angle)
                    } else if turned.into_iter().any(|(n, m)| is_negative(&dot(n, m))) {
                        Err(Reason::Fold)
                    } else {
                        Ok(())
                    }
                })
            }
        }
    }
}
