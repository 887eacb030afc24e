// While a mesh moves, some edges cannot be decided: an edge with a number that is not finite, and an edge whose four
// points span too many bits for exact arithmetic. They are left alone. The same limits as in src/engine/gpu/upload.rs.
#import deviation_span if deviation
#import mesh
#import no_deviation_span if any_deviation
#import points

// From this exponent field on, differences may overflow; 255 stands for numbers that are not finite.
const LARGEST_FLOAT_FIELD: u32 = 253u;
const INFINITE_FIELD: u32 = 255u;

// The span of a point: the largest exponent field of its coordinates, and how far their lowest set bit is below
// ABOVE_EXPONENTS. The span of several points has the larger of each.
fn span_of(point: Point) -> vec2u {
    let fields = max((point >> vec3u(23u)) & vec3u(255u), vec3u(1u));
    return vec2u(max(fields.x, max(fields.y, fields.z)), u32(ABOVE_EXPONENTS - unit_exponent(point)));
}

// Whether points of this span are too far apart for exact arithmetic.
fn is_too_wide(span: vec2u) -> bool {
    let bits = i32(span.x) - 127 - (ABOVE_EXPONENTS - i32(span.y));
    return span.x >= LARGEST_FLOAT_FIELD || bits >= i32(SPAN);
}

// DELAUNAY, or why an edge of these points is left alone.
fn left_alone(a: Point, b: Point, c: Point, d: Point) -> u32 {
    let span = max(max(max(span_of(a), span_of(b)), max(span_of(c), span_of(d))), deviation_span());
    let verdict = select(DELAUNAY, LEFT_AS_WIDE, is_too_wide(span));
    return select(verdict, LEFT_AS_INFINITE, span.x == INFINITE_FIELD);
}
