//! Surfaces in space: the angle sum, the angle between normals, the deviation, and normals that turn over.

use super::cosine::cosine_fraction;
use super::exact::{Bounded, Differences, Ring, Unbounded};
use glam::DVec3;
use std::cmp::Ordering;

/// The error bound of every filter here, relative to the product of the sizes of its vectors: 32 unit roundoffs.
///
/// A size is the 1-norm, which is at least the Euclidean norm. Let L1 = |p|·|q| and L2 = |s|·|r| in 1-norms. Each
/// operation (sqrt included) has a relative error of at most ε. So a component of a computed normal is off by at most
/// ((1+ε)^4 - 1) times the sum of the magnitudes of its two products, the normal by at most 4.01ε·L, its computed
/// length by at most 7ε·L (three more roundings on a length of at most L), and a computed dot product of two
/// differences by at most 5.01ε·L. The errors of the values are at most:
/// - angle sum |n1|·dot2 + |n2|·dot1: (7 + 5.01 + 1)ε·L1·L2 for each term, 2.1ε for the sum: 28.2ε·L1·L2;
/// - n·n': (4.01 + 4.01 + 3)ε·L·L' = 11.1ε·L·L', which also decides `turns_over`;
/// - n·n' - k|n||n'|: 11.1ε + (7 + 7 + 2)ε + 2.1ε = 29.2ε·L·L';
/// - |n1·r| - δ|n1 + n2|: 7.1ε·L1·|r| and 9.1ε·δ·(L1 + L2), and 1.1ε of both for the difference.
///
/// The products L·L' are rounded eight times; a bound of 32 covers that too.
const BOUND: f64 = 32.0 * (f64::EPSILON / 2.0);

/// A bound for the error that underflow adds, relative to the square of the sum of all sizes: 2^-530.
///
/// A product that underflows is off by at most η = 2^-1075; sums and differences do not underflow. So a component of a
/// normal, or a dot product, is off by at most 3.1η, and a normal by 5.4η. The square of a length is off by another
/// 3.1η, and the length by at most the root of that, 2^-536.6 in all. Each value is a sum of products of two lengths,
/// normals or dot products of sizes L and L'. As |k| is at most 1, it is off by at most 2^-534·(L + L') + 12η; the
/// product of the sizes is off by less. Both L and L' are at most a quarter of the square of the sum of all sizes.
const UNDERFLOW: f64 = f64::from_bits((1023 - 530) << 52);

/// With differences up to this width, every test fits 20 limbs, 1280 bits: from differences of b bits, degree 8 with
/// its sums is below 2^(8b + 9), and the β test multiplies by at most 2^212 (the square of an f64 cosine in units of
/// 2^-106).
pub(super) const BITS: u32 = 132;

/// With differences up to this width, a dot product and the components of a normal fit 4 limbs, 256 bits.
const CORNER_BITS: u32 = 126;

/// The two triangles (a, b, c) and (b, a, d) at an edge (a, b).
pub(crate) struct Quad {
    points: [DVec3; 4],
    p: DVec3,
    q: DVec3,
    r: DVec3,
    s: DVec3,
    /// The error bound of a filter whose four vectors have the sizes of p, q, r and s.
    bound: f64,
}

/// Evaluates a function exactly. The function is generic over the integers; it gets the 12 components of p, q, r, s and
/// one more number, 0 by default. The code is out of line, so that the filters, which run for every edge, stay small.
macro_rules! exactly {
    ($quad:expr, $function:ident $(, $argument:expr)*) => {
        exactly!($quad, with 0.0, $function $(, $argument)*)
    };
    ($quad:expr, with $number:expr, $function:ident $(, $argument:expr)*) => {
        out_of_line(|| {
            let differences = $quad.differences($number);
            if differences.bits <= BITS {
                $function::<Bounded<20>>(&differences.integers() $(, $argument)*)
            } else {
                $function::<Unbounded>(&differences.integers() $(, $argument)*)
            }
        })
    };
}

#[cold]
#[inline(never)]
fn out_of_line<T>(decide: impl FnOnce() -> T) -> T {
    decide()
}

impl Quad {
    #[inline(always)]
    pub(crate) fn new(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Self {
        let (p, q, r, s) = (a - c, b - c, a - d, b - d);
        let (u, v, w, x) = (size(p), size(q), size(r), size(s));
        Self { points: [a, b, c, d], p, q, r, s, bound: bound((u * v) * (w * x), u + v + w + x) }
    }

    /// Whether the opposite angles sum to more than π: |n1|·dot2 + |n2|·dot1 < 0.
    #[inline(always)]
    pub(crate) fn is_non_delaunay(&self) -> bool {
        let (dot1, dot2) = (self.p.dot(self.q), self.s.dot(self.r));
        let (n1, n2) = (self.p.cross(self.q), self.s.cross(self.r));
        let value = n1.length() * dot2 + n2.length() * dot1;
        if value.abs() > self.bound {
            value < 0.0
        } else {
            !self.has_right_angles() && exactly!(self, angle_sum).is_lt()
        }
    }

    /// Whether, in the dot products at c and d, the product on each axis has a factor 0. Then both angles are right, as
    /// at all ties of a lattice along the axes.
    #[cold]
    fn has_right_angles(&self) -> bool {
        let [a, b, c, d] = self.points;
        [c, d].iter().all(|&v| (a.cmpeq(v) | b.cmpeq(v)).all())
    }

    /// Whether the angle between the normals is larger than β = acos(`cos`), before or after the flip. A zero normal
    /// makes no angle with any other.
    pub(crate) fn exceeds_angle(&self, cos: f64) -> bool {
        // By the Cauchy–Schwarz inequality, no angle exceeds 180°.
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

    /// Whether the angle between the present normals is larger than β = acos(`cos`).
    #[inline(always)]
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

    /// Compares n·m - k|n||m| with zero; `Equal` if the filter cannot decide.
    #[inline]
    fn compare_angle(&self, n: DVec3, m: DVec3, cos: f64) -> Ordering {
        let value = n.dot(m) - cos * (n.length() * m.length());
        if value > self.bound {
            Ordering::Greater
        } else if value < -self.bound {
            Ordering::Less
        } else {
            Ordering::Equal
        }
    }

    /// Whether the lines through the old and the new diagonal are further apart than `most` = δ: |n1·r| > δ|n1 + n2|.
    /// `most` is finite and not negative. Parallel lines count as distance 0.
    pub(crate) fn deviates(&self, most: f64) -> bool {
        let (n1, n2) = (self.p.cross(self.q), self.s.cross(self.r));
        let (u, v, w, x) = (size(self.p), size(self.q), size(self.r), size(self.s));
        let value = n1.dot(self.r).abs() - most * (n1 + n2).length();
        let bound = bound(0.0, u + v + w + x)
            + (BOUND * (u * v * w + most * (u * v + w * x)) + UNDERFLOW * (most + w));
        if value.abs() > bound { value > 0.0 } else { exactly!(self, with most, deviating) }
    }

    /// Whether a new normal has a strictly negative dot product with an old one.
    pub(crate) fn turns_over(&self) -> bool {
        let (old1, old2) = (self.p.cross(self.q), self.s.cross(self.r));
        let (new1, new2) = (self.r.cross(self.p), self.q.cross(self.s));
        // Each bound is a product of four sizes, in which one of the sizes occurs twice.
        let largest = size(self.p).max(size(self.q)).max(size(self.r)).max(size(self.s));
        let bound = bound((largest * largest) * (largest * largest), 4.0 * largest);
        let dots = [old1.dot(new1), old1.dot(new2), old2.dot(new1), old2.dot(new2)];
        if dots.iter().any(|&dot| dot < -bound) {
            true
        } else if dots.iter().all(|&dot| dot > bound) {
            false
        } else {
            exactly!(self, turned_over)
        }
    }

    fn differences(&self, number: f64) -> Differences<COUNT> {
        let [a, b, c, d] = self.points.map(|point| point.to_array());
        let pairs = [(a, c), (b, c), (a, d), (b, d), ([number; 3], [0.0; 3])];
        Differences::new(std::array::from_fn(|i| {
            let (u, v) = pairs[i / 3];
            (u[i % 3], v[i % 3])
        }))
    }
}

/// If the triangle (a, b, c) has an obtuse angle at c: whether its area is zero.
pub(crate) fn obtuse(a: DVec3, b: DVec3, c: DVec3) -> Option<bool> {
    let (p, q) = (a - c, b - c);
    let bound = bound(size(p) * size(q), size(p) + size(q));
    let dot = p.dot(q);
    if dot > bound {
        return None;
    }
    if dot < -bound && p.cross(q).abs().max_element() > bound {
        return Some(false);
    }
    let (is_obtuse, is_flat) = corner(a, b, c);
    is_obtuse.then_some(is_flat)
}

/// Whether the triangle (a, b, c) has an area: its points are not on one line.
#[inline]
pub(crate) fn has_area(a: DVec3, b: DVec3, c: DVec3) -> bool {
    let (p, q) = (a - c, b - c);
    // Each component of the normal is off by at most 4.01ε of the product of the sizes, plus 3.1η.
    p.cross(q).abs().max_element() > BOUND * (size(p) * size(q)) + f64::MIN_POSITIVE || !corner(a, b, c).1
}

/// Whether the triangle (a, b, c) has an obtuse angle at c, and whether its area is zero, by integers.
fn corner(a: DVec3, b: DVec3, c: DVec3) -> (bool, bool) {
    out_of_line(|| {
        let [a, b, c] = [a, b, c].map(|point| point.to_array());
        let differences =
            Differences::new(std::array::from_fn(|i| (if i < 3 { a } else { b }[i % 3], c[i % 3])));
        if differences.bits <= CORNER_BITS {
            obtuse_and_flat::<Bounded<4>>(&differences.integers())
        } else {
            obtuse_and_flat::<Unbounded>(&differences.integers())
        }
    })
}

/// The error bound of a filter, from the product of the sizes of its four vectors and the sum of all sizes. The fourth
/// power of the sum is larger than anything that a filter computes. If that overflows, the bound is infinite, and the
/// filter decides nothing.
#[inline]
fn bound(product: f64, sum: f64) -> f64 {
    let square = sum * sum;
    BOUND * product + (UNDERFLOW * square + f64::MIN_POSITIVE * (square * square + 1.0))
}

/// The 1-norm.
#[inline]
fn size(v: DVec3) -> f64 {
    v.abs().element_sum()
}

/// How many numbers an exact function gets.
const COUNT: usize = 13;

/// One of p, q, r and s.
type Vector<R> = [R; 3];

/// p, q, r and s.
fn vectors<R>(v: &[R; COUNT]) -> [&Vector<R>; 4] {
    let (vectors, _) = v.as_chunks();
    [&vectors[0], &vectors[1], &vectors[2], &vectors[3]]
}

fn dot<R: Ring>(u: &Vector<R>, v: &Vector<R>) -> R {
    u[0].mul(&v[0]).add(&u[1].mul(&v[1])).add(&u[2].mul(&v[2]))
}

fn cross<R: Ring>(u: &Vector<R>, v: &Vector<R>) -> Vector<R> {
    let component = |i: usize, j: usize| u[i].mul(&v[j]).sub(&u[j].mul(&v[i]));
    [component(1, 2), component(2, 0), component(0, 1)]
}

/// The sign of √(n1²)·dot2 + √(n2²)·dot1: the common sign of the two terms, or else decided by their squares.
fn angle_sum<R: Ring>(v: &[R; COUNT]) -> Ordering {
    let [p, q, r, s] = vectors(v);
    let (n1, n2) = (cross(p, q), cross(s, r));
    let (n1, n2) = (dot(&n1, &n1), dot(&n2, &n2));
    let (dot1, dot2) = (dot(p, q), dot(s, r));
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

/// Whether n·m < k|n||m| for the normals before the flip or, if `after`, for those after it.
fn angle_exceeded<R: Ring>(v: &[R; COUNT], k: f64, after: bool) -> bool {
    let [p, q, r, s] = vectors(v);
    let (mantissa, shift) = cosine_fraction(k);
    let mantissa = R::new(mantissa as i64, 0);
    let (k_square, unit_square) = (mantissa.mul(&mantissa), R::new(1, 2 * shift));
    let exceeds = |n: Vector<R>, m: Vector<R>| {
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
        let difference = left.mul(&left).mul(&unit_square).sub(&scale.mul(&k_square)).sign();
        match right_sign {
            Ordering::Greater => difference.is_lt(),
            Ordering::Less => difference.is_gt(),
            Ordering::Equal => false,
        }
    };
    exceeds(cross(p, q), cross(s, r)) || (after && exceeds(cross(r, p), cross(q, s)))
}

/// Whether (n1·r)² > δ²(n1 + n2)².
fn deviating<R: Ring>(v: &[R; COUNT]) -> bool {
    let [p, q, r, s] = vectors(v);
    let (n1, n2) = (cross(p, q), cross(s, r));
    let both = [0, 1, 2].map(|i| n1[i].add(&n2[i]));
    let (volume, most) = (dot(&n1, r), &v[COUNT - 1]);
    volume.mul(&volume).sub(&most.mul(most).mul(&dot(&both, &both))).sign().is_gt()
}

fn turned_over<R: Ring>(v: &[R; COUNT]) -> bool {
    let [p, q, r, s] = vectors(v);
    let old = [cross(p, q), cross(s, r)];
    let new = [cross(r, p), cross(q, s)];
    old.iter().any(|n| new.iter().any(|m| dot(n, m).sign().is_lt()))
}

/// The same as [`corner`], from the components of p and q.
fn obtuse_and_flat<R: Ring>(v: &[R; 6]) -> (bool, bool) {
    let (vectors, _) = v.as_chunks();
    let (p, q): (&Vector<R>, &Vector<R>) = (&vectors[0], &vectors[1]);
    (dot(p, q).sign().is_lt(), cross(p, q).iter().all(|component| component.sign().is_eq()))
}
