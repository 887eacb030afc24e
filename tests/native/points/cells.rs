//! The cells of a Voronoi diagram from their definition: the box is clipped by the bisectors with all other points, in
//! integers of any size, and only the corners that are left are rounded.

use edgeflip::Positions;
use num_bigint::BigInt;
use std::cmp::Ordering;

/// The half-plane of a x + b y + c >= 0; or a corner, whose x and y are the first two over the third, which is positive.
type Triple = [BigInt; 3];

/// A number as an integer, in units of 2^-1074.
fn integer(x: f64) -> BigInt {
    let bits = x.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let magnitude =
        BigInt::from(if exponent == 0 { fraction } else { fraction | 1 << 52 }) << (exponent.max(1) - 1);
    if x < 0.0 { -magnitude } else { magnitude }
}

fn sign(x: &BigInt) -> Ordering {
    x.cmp(&BigInt::ZERO)
}

fn at(plane: &Triple, corner: &Triple) -> BigInt {
    plane.iter().zip(corner).map(|(x, y)| x * y).sum()
}

/// Where two lines meet.
fn meeting(p: &Triple, q: &Triple) -> Triple {
    let minor = |i: usize, j: usize| &p[i] * &q[j] - &p[j] * &q[i];
    let corner = [minor(1, 2), minor(2, 0), minor(0, 1)];
    if sign(&corner[2]).is_lt() { corner.map(|x| -x) } else { corner }
}

/// A convex polygon: its sides, and where each meets the next. A new side that only touches the polygon is left out.
type Polygon = Vec<(Triple, Triple)>;

fn clip(polygon: &mut Polygon, plane: &Triple) {
    let signs: Vec<Ordering> = polygon.iter().map(|(_, corner)| sign(&at(plane, corner))).collect();
    if signs.iter().all(|sign| sign.is_ge()) {
        return;
    }
    let mut left = Polygon::new();
    for (i, (side, corner)) in polygon.iter().enumerate() {
        let before = signs[(i + signs.len() - 1) % signs.len()];
        match (before.is_ge(), signs[i].is_ge()) {
            (_, true) => left.push((side.clone(), corner.clone())),
            (true, false) => {
                // Where the side leaves the half-plane; the corner before may be on its edge.
                left.push((side.clone(), meeting(side, plane)));
            }
            (false, false) => {}
        }
        if signs[i].is_lt() && signs[(i + 1) % signs.len()].is_ge() {
            let next = &polygon[(i + 1) % polygon.len()].0;
            left.push((plane.clone(), meeting(plane, next)));
        }
    }
    *polygon = left;
}

/// The nearest number to a quotient, by halving the range of numbers.
fn nearest(numerator: &BigInt, denominator: &BigInt) -> f64 {
    let (magnitude, is_negative) = (BigInt::from(numerator.magnitude().clone()), sign(numerator).is_lt());
    let [mut low, mut high] = [0.0f64, f64::INFINITY].map(f64::to_bits);
    while high - low > 1 {
        let middle = low.midpoint(high);
        if integer(f64::from_bits(middle)) * denominator <= magnitude {
            low = middle;
        } else {
            high = middle;
        }
    }
    let twice: BigInt = (magnitude * 2) - integer(f64::from_bits(low)) * denominator;
    let order = twice.cmp(&(integer(f64::from_bits(high)) * denominator));
    let bits = if order.is_gt() || (order.is_eq() && low % 2 == 1) { high } else { low };
    let rounded = f64::from_bits(bits);
    // -0 counts as 0.
    if is_negative && rounded > 0.0 { -rounded } else { rounded }
}

/// The rounded coordinates of a corner.
fn rounded([x, y, w]: &Triple) -> [f64; 2] {
    [x, y].map(|x| nearest(x, w))
}

/// A polygon without corners that equal the one before; nothing if less than three are left.
fn without_repeats(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    if corners.len() < 3 { Vec::new() } else { corners }
}

/// The polygon from its least corner on.
pub fn turned(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    let least = (0..corners.len()).min_by(|&i, &j| corners[i].partial_cmp(&corners[j]).unwrap());
    corners.rotate_left(least.unwrap_or(0));
    corners
}

/// The cell of each point.
pub fn cells(positions: &Positions, bounds: [f64; 4]) -> Vec<Vec<[f64; 2]>> {
    let numbers: Vec<BigInt> = positions.iter().map(integer).collect();
    let points = numbers.as_chunks::<2>().0;
    let [left, bottom, right, top] = bounds.map(integer);
    let [zero, one] = [0, 1].map(BigInt::from);
    let sides: [Triple; 4] = [
        [zero.clone(), one.clone(), -bottom],
        [-one.clone(), zero.clone(), right],
        [zero.clone(), -one.clone(), top],
        [one, zero, -left],
    ];
    let cell = |i: usize| {
        let mut polygon: Polygon =
            (0..4).map(|k| (sides[k].clone(), meeting(&sides[k], &sides[(k + 1) % 4]))).collect();
        for (j, q) in points.iter().enumerate() {
            let p = &points[i];
            if p == q {
                if j < i {
                    return Vec::new();
                }
                continue;
            }
            // Nearer to p than to q.
            let square = |[x, y]: &[BigInt; 2]| x * x + y * y;
            let plane = [(&p[0] - &q[0]) * 2, (&p[1] - &q[1]) * 2, square(q) - square(p)];
            clip(&mut polygon, &plane);
            if polygon.is_empty() {
                break;
            }
        }
        without_repeats(polygon.iter().map(|(_, corner)| rounded(corner)).collect())
    };
    (0..points.len()).map(cell).collect()
}

/// The circumcentre of three points.
pub fn circumcentre(corners: [[f64; 2]; 3]) -> [f64; 2] {
    let [a, b, c] = corners.map(|p| p.map(integer));
    let bisector = |p: &[BigInt; 2], q: &[BigInt; 2]| {
        let square = |[x, y]: &[BigInt; 2]| x * x + y * y;
        [(&p[0] - &q[0]) * 2, (&p[1] - &q[1]) * 2, square(q) - square(p)]
    };
    rounded(&meeting(&bisector(&a, &b), &bisector(&b, &c)))
}
