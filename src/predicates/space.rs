//! Surfaces in space: the angle sum, the angle between normals against β, and normals that turn over.

use super::exact::{Grid, Int, Ring, difference_is_exact};
use glam::DVec3;
use std::cmp::Ordering;

/// Bound of every filter here, relative to the product of the sizes of its vectors: 32 unit roundoffs.
///
/// A size is the 1-norm, which is at least the Euclidean one; L1 = |p|·|q|, L2 = |s|·|r| in 1-norms. With
/// relative errors of at most ε an operation (sqrt included), a component of a computed normal differs from
/// the true one by at most ((1+ε)^4 - 1) of the sum of the magnitudes of its two products, so the normal by
/// at most 4.01ε·L, its computed length by at most 7ε·L (three more roundings on a length of at most L), a
/// computed dot product of two differences by at most 5.01ε·L.
/// - angle sum |n1|·dot2 + |n2|·dot1: (7 + 5.01 + 1)ε·L1·L2 for each term, 2.1ε for the sum: 28.2ε·L1·L2;
/// - n·n': (4.01 + 4.01 + 3)ε·L·L' = 11.1ε·L·L', which also decides `turns_over`;
/// - n·n' - k|n||n'|: 11.1ε + (7 + 7 + 2)ε + 2.1ε = 29.2ε·L·L'.
///
/// The products L·L' are rounded eight times; 32 leaves room for that. f32 inputs can neither overflow nor
/// underflow degree 4 in f64.
const BOUND: f64 = 32.0 * (f64::EPSILON / 2.0);

/// Grids up to this width are evaluated in 12 limbs: degree 8 of 61-bit differences with sums is below
/// 2^494, and the β test multiplies by at most 2^212 (the square of an f64 cosine in units of 2^-106).
const NARROW_BITS: u32 = 60;

/// The two triangles (a, b, c) and (b, a, d) at an edge (a, b).
pub(crate) struct Quad {
    points: [DVec3; 4],
    p: DVec3,
    q: DVec3,
    r: DVec3,
    s: DVec3,
}

/// p, q, r, s as exact integers times a common unit: 12 components.
#[expect(clippy::large_enum_variant, reason = "on the stack, for one evaluation")]
enum Differences {
    Narrow([Int<12>; 12]),
    Wide([Int<40>; 12]),
}

/// Evaluates a function that is generic over the number of limbs.
macro_rules! exactly {
    ($quad:expr, $function:ident $(, $argument:expr)*) => {
        match $quad.differences() {
            Differences::Narrow(v) => $function(&v $(, $argument)*),
            Differences::Wide(v) => $function(&v $(, $argument)*),
        }
    };
}

impl Quad {
    pub(crate) fn new(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Self {
        Self { points: [a, b, c, d], p: a - c, q: b - c, r: a - d, s: b - d }
    }

    /// Whether the opposite angles sum to more than π: |n1|·dot2 + |n2|·dot1 < 0.
    pub(crate) fn is_non_delaunay(&self) -> bool {
        let (dot1, dot2) = (self.p.dot(self.q), self.s.dot(self.r));
        let (n1, n2) = (self.p.cross(self.q), self.s.cross(self.r));
        let value = n1.length() * dot2 + n2.length() * dot1;
        let bound = BOUND * size(self.p) * size(self.q) * size(self.s) * size(self.r);
        if value.abs() > bound { value < 0.0 } else { exactly!(self, angle_sum).is_lt() }
    }

    /// Whether the angle between the normals is larger than β = acos(`cos`), before the flip or after it.
    /// A zero normal is at no angle to anything.
    pub(crate) fn exceeds_angle(&self, cos: f64) -> bool {
        // By Cauchy and Schwarz no angle exceeds 180°.
        if cos <= -1.0 {
            return false;
        }
        let before = self.compare_angle(self.p.cross(self.q), self.s.cross(self.r), cos);
        let after = self.compare_angle(self.r.cross(self.p), self.q.cross(self.s), cos);
        match before.min(after) {
            Ordering::Less => true,
            Ordering::Equal => exactly!(self, angle_exceeded, cos, true),
            Ordering::Greater => false,
        }
    }

    /// Whether the angle between the normals, before any flip, is larger than β = acos(`cos`).
    pub(crate) fn is_over_angle(&self, cos: f64) -> bool {
        if cos <= -1.0 {
            return false;
        }
        let (n1, n2) = (self.p.cross(self.q), self.s.cross(self.r));
        match self.compare_angle(n1, n2, cos) {
            Ordering::Equal => exactly!(self, angle_exceeded, cos, false),
            decided => decided.is_lt(),
        }
    }

    /// n·m - k|n||m| against zero; `Equal` where the filter cannot decide.
    fn compare_angle(&self, n: DVec3, m: DVec3, cos: f64) -> Ordering {
        let value = n.dot(m) - cos * (n.length() * m.length());
        let bound = BOUND * size(self.p) * size(self.q) * size(self.s) * size(self.r);
        if value > bound {
            Ordering::Greater
        } else if value < -bound {
            Ordering::Less
        } else {
            Ordering::Equal
        }
    }

    /// Whether a new normal has a strictly negative dot product with an old one.
    pub(crate) fn turns_over(&self) -> bool {
        let old = [self.p.cross(self.q), self.s.cross(self.r)];
        let new = [self.r.cross(self.p), self.q.cross(self.s)];
        // Each bound is a product of four of the four sizes, one of them twice.
        let sizes = [self.p, self.q, self.r, self.s].map(size);
        let largest = sizes.iter().fold(0.0f64, |x, &y| x.max(y));
        let bound = BOUND * (largest * largest) * (largest * largest);
        let dots = old.map(|n| new.map(|m| n.dot(m)));
        if dots.as_flattened().iter().any(|&dot| dot < -bound) {
            true
        } else if dots.as_flattened().iter().all(|&dot| dot > bound) {
            false
        } else {
            exactly!(self, turned_over)
        }
    }

    fn differences(&self) -> Differences {
        let [a, b, c, d] = self.points;
        let pairs = [(a, c), (b, c), (a, d), (b, d)];
        let exact =
            |(u, v): &(DVec3, DVec3)| (0..3).all(|i| difference_is_exact(u.to_array()[i], v.to_array()[i]));
        if pairs.iter().all(exact) {
            let mut numbers = [0.0; 12];
            for (i, (u, v)) in pairs.into_iter().enumerate() {
                numbers[3 * i..3 * i + 3].copy_from_slice(&(u - v).to_array());
            }
            let grid = Grid::new(&numbers);
            return if grid.bits <= NARROW_BITS {
                Differences::Narrow(grid.wide())
            } else {
                Differences::Wide(grid.wide())
            };
        }
        let mut numbers = [0.0; 12];
        for (i, point) in self.points.into_iter().enumerate() {
            numbers[3 * i..3 * i + 3].copy_from_slice(&point.to_array());
        }
        // 278 bits a difference: degree 8 with sums and the factor of β stays below 2^2443.
        let grid = Grid::new(&numbers).wide::<40>();
        let vertex = |i: usize| [grid[3 * i], grid[3 * i + 1], grid[3 * i + 2]];
        let minus = |u: usize, v: usize| {
            let (u, v) = (vertex(u), vertex(v));
            [u[0].sub(&v[0]), u[1].sub(&v[1]), u[2].sub(&v[2])]
        };
        let [p, q, r, s] = [minus(0, 2), minus(1, 2), minus(0, 3), minus(1, 3)];
        Differences::Wide([p[0], p[1], p[2], q[0], q[1], q[2], r[0], r[1], r[2], s[0], s[1], s[2]])
    }
}

/// Whether the triangle (a, b, c) has an angle of more than 90° at c, and whether its area is zero.
pub(crate) fn corner(a: DVec3, b: DVec3, c: DVec3) -> (bool, bool) {
    let exact = |v: &[Int<40>; 12]| {
        let [p, q, _, _] = vectors(v);
        let normal = cross(&p, &q);
        (dot(&p, &q).sign().is_lt(), dot(&normal, &normal).sign().is_eq())
    };
    match Quad::new(a, b, c, c).differences() {
        Differences::Narrow(v) => exact(&v.map(|x| x.widened())),
        Differences::Wide(v) => exact(&v),
    }
}

/// The 1-norm.
fn size(v: DVec3) -> f64 {
    v.abs().element_sum()
}

type Vector<R> = [R; 3];

fn vectors<R: Ring>(v: &[R; 12]) -> [Vector<R>; 4] {
    [[v[0], v[1], v[2]], [v[3], v[4], v[5]], [v[6], v[7], v[8]], [v[9], v[10], v[11]]]
}

fn dot<R: Ring>(u: &Vector<R>, v: &Vector<R>) -> R {
    u[0].mul(&v[0]).add(&u[1].mul(&v[1])).add(&u[2].mul(&v[2]))
}

fn cross<R: Ring>(u: &Vector<R>, v: &Vector<R>) -> Vector<R> {
    let component = |i: usize, j: usize| u[i].mul(&v[j]).sub(&u[j].mul(&v[i]));
    [component(1, 2), component(2, 0), component(0, 1)]
}

/// The sign of √(n1²)·dot2 + √(n2²)·dot1: of equal signs of the two terms that sign, else by their squares.
fn angle_sum<R: Ring>(v: &[R; 12]) -> Ordering {
    let [p, q, r, s] = vectors(v);
    let (n1, n2) = (cross(&p, &q), cross(&s, &r));
    let (n1, n2) = (dot(&n1, &n1), dot(&n2, &n2));
    let (dot1, dot2) = (dot(&p, &q), dot(&s, &r));
    let term = |square: &R, dot: &R| if square.sign().is_eq() { Ordering::Equal } else { dot.sign() };
    let (first, second) = (term(&n1, &dot2), term(&n2, &dot1));
    if first == second || second.is_eq() {
        return first;
    }
    if first.is_eq() {
        return second;
    }
    let larger = n1.mul(&dot2.mul(&dot2)).sub(&n2.mul(&dot1.mul(&dot1))).sign();
    if first.is_gt() { larger } else { larger.reverse() }
}

/// Whether n·m < k|n||m| for the normals before the flip or, with `after` too, for those after it.
fn angle_exceeded<const N: usize>(v: &[Int<N>; 12], k: f64, after: bool) -> bool {
    let [p, q, r, s] = vectors(v);
    let (mantissa, shift) = super::cosine_fraction(k);
    let mantissa = Int::<N>::new(mantissa as i64, 0);
    let k_square = mantissa.mul(&mantissa);
    let exceeds = |n: Vector<Int<N>>, m: Vector<Int<N>>| {
        let left = dot(&n, &m);
        // k|n||m| has the sign of k, or is zero.
        let scale = dot(&n, &n).mul(&dot(&m, &m));
        let right_sign = if scale.sign().is_eq() || k == 0.0 {
            Ordering::Equal
        } else if k > 0.0 {
            Ordering::Greater
        } else {
            Ordering::Less
        };
        if left.sign() != right_sign {
            return left.sign() < right_sign;
        }
        let difference = left.mul(&left).shifted(2 * shift).sub(&scale.mul(&k_square)).sign();
        match right_sign {
            Ordering::Greater => difference.is_lt(),
            Ordering::Less => difference.is_gt(),
            Ordering::Equal => false,
        }
    };
    exceeds(cross(&p, &q), cross(&s, &r)) || (after && exceeds(cross(&r, &p), cross(&q, &s)))
}

fn turned_over<R: Ring>(v: &[R; 12]) -> bool {
    let [p, q, r, s] = vectors(v);
    let old = [cross(&p, &q), cross(&s, &r)];
    let new = [cross(&r, &p), cross(&q, &s)];
    old.iter().any(|n| new.iter().any(|m| dot(n, m).sign().is_lt()))
}
