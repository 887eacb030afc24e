//! Kinds of quads: four points each, from everyday ones to those that only exact arithmetic can decide.

use super::batch::DEVIATION;
use edgeflip::Dimension;
use oorandom::Rand64;

/// The points a, b, c, d: the triangles are (a, b, c) and (b, a, d). In the plane the third coordinate is unused.
pub type Quad = [[f64; 3]; 4];

/// The same in 32-bit floats. The kinds make these.
type Floats = [[f32; 3]; 4];

/// A way to make quads.
pub struct Kind {
    pub name: &'static str,
    /// Whether the coordinates stay in the span that GPU engines decide, even in one mesh with all other such kinds.
    pub in_span: bool,
    /// Whether the kind exists in space only.
    only_space: bool,
    make: fn(&mut Source) -> Floats,
}

const KINDS: [Kind; 18] = [
    Kind::in_span("uniform", |s| s.scattered(Numbers::Uniform)),
    Kind::in_span("lattice", Source::lattice),
    Kind::in_span("lattice of 0.1", Source::tenths),
    Kind::in_span("cocircular", Source::cocircular),
    Kind::in_span("cocircular but for a bit", Source::cocircular_but_for_a_bit),
    Kind::in_span("62 bits", |s| {
        let bits = s.pick([28, 29, 30, 31, 32, 48, 60, 61, 62]);
        s.scattered(Numbers::Bits(bits))
    }),
    Kind::in_span("84 bits", |s| s.scattered(Numbers::Bits(84))),
    Kind::in_span("trapezoids", |s| {
        let numbers = s.numbers_in_span();
        s.trapezoid(numbers)
    }),
    Kind::in_span("almost on the axes", Source::near_axes),
    Kind::in_span("degenerate", |s| {
        let numbers = s.numbers_in_span();
        s.degenerate(numbers)
    }),
    Kind::in_span("one ulp off", Source::one_ulp_off),
    Kind { only_space: true, ..Kind::in_span("near β", Source::near_beta) },
    Kind { only_space: true, ..Kind::in_span("steps", Source::steps) },
    Kind::beyond("all exponents", |s| s.scattered(Numbers::All)),
    Kind::beyond("trapezoids of all exponents", |s| s.trapezoid(Numbers::All)),
    Kind::beyond("degenerate of all exponents", |s| s.degenerate(Numbers::All)),
    Kind {
        only_space: true,
        ..Kind::beyond("right angles of all exponents", |s| s.right_angle(Numbers::All))
    },
    Kind::beyond("random bits", |s| s.scattered(Numbers::RandomBits)),
];

impl Kind {
    const fn in_span(name: &'static str, make: fn(&mut Source) -> Floats) -> Self {
        Self { name, in_span: true, only_space: false, make }
    }

    const fn beyond(name: &'static str, make: fn(&mut Source) -> Floats) -> Self {
        Self { in_span: false, ..Self::in_span(name, make) }
    }

    /// The kinds of a dimension. `beyond`: also the kinds beyond the span of the GPU engines.
    pub fn all(dimension: Dimension, beyond: bool) -> impl Iterator<Item = &'static Self> {
        let fits = move |kind: &&Self| !kind.only_space || dimension == Dimension::Three;
        KINDS.iter().filter(fits).filter(move |kind| kind.in_span || beyond)
    }

    /// Makes one quad.
    pub fn quad(&self, source: &mut Source) -> Quad {
        let quad = (self.make)(source);
        let quad = source.turned(quad).map(|point| point.map(f64::from));
        // Scaling is exact, unless the result is subnormal.
        let scaled = |quad: Quad, scale| quad.map(|point| point.map(|x| x * 2f64.powi(scale)));
        match (self.in_span, source.is_wide) {
            (false, _) => quad,
            (true, false) => scaled(quad, source.scale).map(|point| point.map(|x| f64::from(x as f32))),
            (true, true) => scaled(source.widened(quad), 8 * source.scale),
        }
    }
}

/// The lowest bit of a coordinate in the span, before scaling. The highest bit is below 2^24.
const LOWEST: f32 = 1.0 / (1u64 << 60) as f32;

/// Where coordinates come from.
#[derive(Clone, Copy)]
enum Numbers {
    /// Multiples of 2^-24 from -1 to 1.
    Uniform,
    /// Integers in units of [`LOWEST`] that take at most this number of bits. All but 24 consecutive bits are zero.
    Bits(i32),
    /// Any size, subnormals and the largest included, often with few bits.
    All,
    /// Any bits of a finite number.
    RandomBits,
}

/// Hinges: β in degrees, two normals of equal length whose angle is exactly β, and a direction at right angles to both.
const HINGES: [(f64, [[i32; 3]; 3]); 7] = [
    (0.0, [[1, 1, 0], [1, 1, 0], [1, -1, 0]]),
    (0.0, [[2, 1, 2], [2, 1, 2], [1, 0, -1]]),
    (60.0, [[1, 1, 0], [1, 0, 1], [1, -1, -1]]),
    (90.0, [[1, 0, 0], [0, 1, 0], [0, 0, 1]]),
    (90.0, [[2, 1, 2], [-2, 2, 1], [-1, -2, 2]]),
    (120.0, [[1, 1, 0], [-1, 0, 1], [1, -1, 1]]),
    (180.0, [[1, 0, 0], [-1, 0, 0], [0, 1, 0]]),
];

/// Random numbers and the data that quads are made from.
pub struct Source {
    random: Rand64,
    dimension: Dimension,
    beta: f64,
    scale: i32,
    is_wide: bool,
    /// Integer points with x > 0, y ≥ 0 on a circle around the origin, counter-clockwise.
    arc: Vec<[i32; 2]>,
}

/// The radius of that circle, 5·13·17. No smaller radius has as many integer points.
const RADIUS: i32 = 1105;

impl Source {
    /// A source for a mesh with the threshold β in degrees. Coordinates are multiplied by 2^`scale`; doubles, if
    /// `is_wide`, by 2^(8·`scale`).
    pub fn new(seed: u128, dimension: Dimension, beta: f64, scale: i32, is_wide: bool) -> Self {
        let arc = (0..RADIUS)
            .map(|y| [(RADIUS * RADIUS - y * y).isqrt(), y])
            .filter(|[x, y]| x * x + y * y == RADIUS * RADIUS)
            .collect();
        Self { random: Rand64::new(seed), dimension, beta, scale, is_wide, arc }
    }

    /// A random integer from `low` to `high`, both included.
    fn integer(&mut self, low: i32, high: i32) -> i32 {
        low + self.random.rand_range(0..(high - low + 1) as u64) as i32
    }

    fn pick<T: Copy, const N: usize>(&mut self, choices: [T; N]) -> T {
        choices[self.random.rand_range(0..N as u64) as usize]
    }

    fn chance(&mut self, one_in: u64) -> bool {
        self.random.rand_range(0..one_in) == 0
    }

    /// Numbers in the span. Some have as many bits as the narrower arithmetic of an engine takes, or a few more.
    fn numbers_in_span(&mut self) -> Numbers {
        match self.pick([0, 24, 28, 29, 30, 31, 32, 48, 59, 60, 61, 83]) {
            0 => Numbers::Uniform,
            bits => Numbers::Bits(bits),
        }
    }

    fn number(&mut self, numbers: Numbers) -> f32 {
        match numbers {
            Numbers::Uniform => self.integer(-1 << 24, 1 << 24) as f32 * 2f32.powi(-24),
            Numbers::Bits(bits) => {
                let length = self.integer(1, 24.min(bits));
                let mantissa = self.integer(1 - (1 << length), (1 << length) - 1);
                let shift = if self.chance(2) { bits - length } else { self.integer(0, bits - length) };
                mantissa as f32 * LOWEST * 2f32.powi(shift)
            }
            Numbers::All => match self.integer(0, 15) {
                0 => self.pick([f32::MAX, f32::MIN, f32::MIN_POSITIVE, f32::from_bits(1)]),
                1 => f32::from_bits(self.integer(0, 1000) as u32),
                _ => {
                    let kept = self.integer(0, 23);
                    f32::from_bits(self.number(Numbers::RandomBits).to_bits() >> kept << kept)
                }
            },
            Numbers::RandomBits => loop {
                let x = f32::from_bits(self.random.rand_u64() as u32);
                if x.is_finite() {
                    break x;
                }
            },
        }
    }

    /// A third coordinate. With it, some surfaces are flat and some almost flat.
    fn height(&mut self, numbers: Numbers) -> f32 {
        match numbers {
            _ if self.chance(4) => 0.0,
            Numbers::Uniform => self.number(numbers) * 2f32.powi(-self.integer(0, 12)),
            Numbers::Bits(bits) => {
                let bits = self.integer(1, bits);
                self.number(Numbers::Bits(bits))
            }
            _ => self.number(numbers),
        }
    }

    fn scattered(&mut self, numbers: Numbers) -> Floats {
        [(); 4].map(|()| [self.number(numbers), self.number(numbers), self.height(numbers)])
    }

    fn lattice(&mut self) -> Floats {
        let (width, height) = (self.pick([1, 2, 3, 7]), self.pick([0, 0, 1, 2]));
        [(); 4].map(|()| [width, width, height].map(|end| self.integer(0, end) as f32))
    }

    fn tenths(&mut self) -> Floats {
        let (width, offset) = (self.pick([1, 2, 3, 7]), self.pick([0.0, 1e5, 1e6]));
        let height = self.pick([0, 0, 1]);
        [(); 4].map(|()| [width, width, height].map(|end| self.integer(0, end) as f32 * 0.1 + offset))
    }

    /// Four points of a circle, in the plane or on a tilted plane, moved and scaled without rounding.
    fn cocircular(&mut self) -> Floats {
        let mut indices = [(); 4].map(|()| self.integer(0, 4 * self.arc.len() as i32 - 1));
        if self.chance(2) {
            // The first point is on an axis.
            indices[0] = 0;
        }
        if !self.chance(8) {
            indices.sort_unstable();
        }
        let [a, d, b, c] = indices.map(|index| {
            let [x, y] = self.arc[index as usize % self.arc.len()];
            match index as usize / self.arc.len() {
                0 => [x, y],
                1 => [-y, x],
                2 => [-x, -y],
                _ => [y, -x],
            }
        });
        let is_tilted = self.dimension == Dimension::Three && self.chance(2);
        let reach = self.pick([0, 1000, 1 << 22]);
        let moved = [(); 3].map(|()| self.integer(-reach, reach));
        let unit = 2f32.powi(-self.integer(0, 20));
        [a, b, c, d].map(|[x, y]| {
            // (1, 2, 2) and (2, 1, -2) have the same length and are at right angles.
            let point = if is_tilted { [x + 2 * y, 2 * x + y, 2 * x - 2 * y] } else { [x, y, 0] };
            [0, 1, 2].map(|i| (point[i] + moved[i]) as f32 * unit)
        })
    }

    /// Four points that are cocircular except for one bit, which may be far below the others.
    fn cocircular_but_for_a_bit(&mut self) -> Floats {
        let mut quad = self.cocircular();
        let largest = quad.as_flattened().iter().fold(0f32, |largest, x| largest.max(x.abs()));
        let bit = largest * 2f32.powi(-self.integer(10, 45));
        // Rounded down to a power of two.
        let bit = f32::from_bits(bit.to_bits() & 0x7f80_0000);
        let point = &mut quad[self.integer(0, 3) as usize][..self.dimension.stride()];
        // The coordinate nearest to zero can hold this bit.
        if let Some(x) = point.iter_mut().min_by(|x, y| x.abs().total_cmp(&y.abs())) {
            *x += self.pick([bit, -bit]);
        }
        quad
    }

    /// Rectangles and symmetric trapezoids are cocircular, whatever their numbers are.
    fn trapezoid(&mut self, numbers: Numbers) -> Floats {
        let [x1, x2, y1, y2] = [(); 4].map(|()| self.number(numbers));
        let z = self.height(numbers);
        let corners = match self.integer(0, 3) {
            0 => [[x1, y1], [x2, y1], [x2, y2], [x1, y2]],
            1 => [[-x1, y1], [x1, y1], [x1, y2], [-x1, y2]],
            _ => [[-x1, y1], [x1, y1], [x2, y2], [-x2, y2]],
        };
        let [a, d, b, c] = corners.map(|[x, y]| [x, y, z]);
        let mut quad = [a, b, c, d];
        if self.chance(4) {
            self.nudge(&mut quad, if matches!(numbers, Numbers::All) { 0.0 } else { LOWEST });
        }
        quad
    }

    /// A kite with its corners on the axes, or next to them by tiny distances that decide the verdict.
    fn near_axes(&mut self) -> Floats {
        let size = 2f32.powi(self.integer(-10, 10));
        let sizes = [(); 4].map(|()| if self.chance(4) { 2.0 * size } else { size });
        let [mut a, mut b, mut c, mut d] = [[0.0; 3]; 4];
        (a[0], b[0], d[1], c[1]) = (-sizes[0], sizes[1], -sizes[2], sizes[3]);
        let mut tiny = || {
            let bits = self.integer(1, 50);
            if self.chance(3) { 0.0 } else { self.number(Numbers::Bits(bits)) }
        };
        (a[1], b[1], c[0], d[0]) = (tiny(), tiny(), tiny(), tiny());
        let bends = [tiny(), tiny()];
        (c[2], d[2]) = if self.chance(2) { (0.0, 0.0) } else { (bends[0], bends[1]) };
        [a, b, c, d]
    }

    /// Equal points, points on a line, triangles without an area.
    fn degenerate(&mut self, numbers: Numbers) -> Floats {
        let [mut a, mut b, mut c, mut d] =
            if self.chance(2) { self.lattice() } else { self.scattered(numbers) };
        let line = self.integer(0, 1) as usize;
        match self.integer(0, 9) {
            0 => c = a,
            1 => d = b,
            2 => c = d,
            3 => b = a,
            4 => (c, d) = (a, b),
            5 => (b, c, d) = (a, a, a),
            // All four on one line, in any order.
            6 => {
                [a, b, c, d] =
                    [a, b, c, d].map(|point| if line == 0 { [point[0], a[1], a[2]] } else { [point[0]; 3] })
            }
            7 => {
                let direction = [(); 3].map(|()| self.integer(-3, 3));
                let steps = [(); 4].map(|()| self.integer(0, 5));
                [a, b, c, d] = steps.map(|step| direction.map(|x| (x * step) as f32));
            }
            // Three on one line.
            8 => (b[1], b[2], c[1], c[2]) = (a[1], a[2], a[1], a[2]),
            _ => (c[0], d[0], c[2], d[2]) = (a[0], a[0], a[2], a[2]),
        }
        [a, b, c, d]
    }

    /// Two triangles whose normals differ by β exactly, or by β up to rounding, before the flip or after it.
    fn near_beta(&mut self) -> Floats {
        match self.integer(0, 3) {
            0 => self.rounded_hinge(),
            1 => {
                let numbers = self.numbers_in_span();
                self.right_angle(numbers)
            }
            _ => self.exact_hinge(),
        }
    }

    /// The triangles (x, y, p) and (y, x, q) lie at the hinge: before the flip, or after it.
    fn at_hinge(&mut self, [x, y, p, q]: Floats) -> Floats {
        if self.chance(2) { [x, y, p, q] } else { [p, q, y, x] }
    }

    /// Two triangles whose normals differ by exactly 90°, 0° or 180°, whatever the numbers are.
    fn right_angle(&mut self, numbers: Numbers) -> Floats {
        let [x, y] = [(); 2].map(|()| if self.chance(2) { 0.0 } else { self.number(numbers) });
        let [u, v] = [(); 2].map(|()| self.number(numbers));
        let last = if self.chance(4) { [v, y] } else { [x, v] };
        let hinge = [[x, y], [x, y], [u, y], last].map(|[x, y]| [x, y, self.number(numbers)]);
        self.at_hinge(hinge)
    }

    fn exact_hinge(&mut self) -> Floats {
        let [n1, n2, h] = loop {
            let (beta, hinge) = self.pick(HINGES);
            // Mostly a hinge of this β. Sometimes any other, so that a β without a hinge gets one too.
            if beta == self.beta || self.chance(8) {
                break hinge;
            }
        };
        let cross =
            |u: [i32; 3], v: [i32; 3]| [(1, 2), (2, 0), (0, 1)].map(|(i, j)| u[i] * v[j] - u[j] * v[i]);
        let (e1, e2) = (cross(n1, h), cross(n2, h));
        let reach = self.pick([4, 9, 1000]);
        let length = if self.chance(4) { 1 } else { self.integer(1, 2 * reach) };
        let [along1, along2] = [(); 2].map(|()| self.integer(0, length));
        let [away1, away2] = [(); 2].map(|()| self.integer(1, reach));
        let at = |along: i32, away: i32, e: [i32; 3]| [0, 1, 2].map(|i| (along * h[i] + away * e[i]) as f32);
        self.at_hinge([at(0, 0, e1), at(length, 0, e1), at(along1, away1, e1), at(along2, -away2, e2)])
    }

    fn rounded_hinge(&mut self) -> Floats {
        // Some of the triangles are needles.
        let bits = self.integer(0, 12);
        let length = self.integer(1, 1 << bits) as f32;
        let [along1, along2] = [(); 2].map(|()| self.integer(0, length as i32) as f32);
        let bits = self.integer(0, 11);
        let [away1, away2] = [(); 2].map(|()| self.integer(1, 1 << bits) as f32);
        let hair = self.pick([0.0, 1e-6, -1e-6, 1e-7, -1e-7]);
        let (sin, cos) = libm::sincos(self.beta.to_radians() + hair);
        // Rounded to multiples of 2^-24, so that numbers near zero take few bits.
        let rounded = |x: f64| ((x * 2f64.powi(24)).round() * 2f64.powi(-24)) as f32;
        let away2 = f64::from(away2);
        let q = [along2, rounded(-away2 * cos), rounded(-away2 * sin)];
        self.at_hinge([[0.0; 3], [length, 0.0, 0.0], [along1, away1, 0.0], q])
    }

    /// Diagonals in parallel planes whose distance is the limit for the deviation, or almost the limit, or zero.
    fn steps(&mut self) -> Floats {
        let height = self.pick([DEVIATION, DEVIATION, DEVIATION.next_up(), DEVIATION.next_down(), 0.0]);
        let bits = self.integer(2, 16);
        let length = self.integer(2, 1 << bits);
        let [along1, along2] = [(); 2].map(|()| self.integer(-length / 2, length / 2) as f32);
        let [away1, away2] = [(); 2].map(|()| self.integer(0, length) as f32);
        let end = length as f32;
        [[-end, 0.0, 0.0], [end, 0.0, 0.0], [along1, away1, height], [along2, -away2, height]]
    }

    fn one_ulp_off(&mut self) -> Floats {
        let mut quad = match self.integer(0, 3) {
            0 => self.lattice(),
            1 => self.tenths(),
            2 if self.dimension == Dimension::Three && self.chance(2) => self.near_beta(),
            2 if self.dimension == Dimension::Three => self.steps(),
            _ => self.cocircular(),
        };
        self.nudge(&mut quad, LOWEST);
        quad
    }

    /// Moves one coordinate to the next float, but at least by `least`.
    fn nudge(&mut self, quad: &mut Floats, least: f32) {
        let axis = self.integer(0, self.dimension.stride() as i32 - 1) as usize;
        let x = &mut quad[self.integer(0, 3) as usize][axis];
        let moved = if self.chance(2) { x.next_up() } else { x.next_down() };
        let step = moved - *x;
        if moved.is_finite() {
            *x = if step.abs() < least { *x + least.copysign(step) } else { moved };
        }
    }

    /// The quad with its axes rotated and some of them mirrored. In the plane this gives both windings.
    fn turned(&mut self, quad: Floats) -> Floats {
        let dimensions = self.dimension.stride();
        let mut axes = [0, 1, 2];
        axes[..dimensions].rotate_left(self.random.rand_range(0..dimensions as u64) as usize);
        let signs = [(); 3].map(|()| self.pick([1.0, -1.0]));
        quad.map(|point| [0, 1, 2].map(|i| point[axes[i]] * signs[i]))
    }

    /// The quad unchanged, or in doubles that are not 32-bit floats: off by the last bit, moved, or divided by three.
    fn widened(&mut self, mut quad: Quad) -> Quad {
        let least = f64::from(LOWEST);
        let rounded = |x: f64| (x / least).round() * least;
        match self.integer(0, 3) {
            0 => {}
            1 => {
                let axis = self.integer(0, self.dimension.stride() as i32 - 1) as usize;
                let x = &mut quad[self.integer(0, 3) as usize][axis];
                let step = (x.next_up() - *x).max(least);
                *x += self.pick([step, -step]);
            }
            2 => {
                let reach = 1 << self.integer(0, 22);
                let offset = [(); 3].map(|()| f64::from(self.integer(-reach, reach)) + 1.0 / 3.0);
                quad = quad.map(|point| [0, 1, 2].map(|i| rounded(point[i] / 2.0 + offset[i])));
            }
            _ => quad = quad.map(|point| point.map(|x| rounded(x / 3.0))),
        }
        quad
    }
}
