// The span of coordinates: of which bits exact arithmetic has to take care.
#import points

// Larger than the exponent of the lowest set bit of any number.
const ABOVE_EXPONENTS: i32 = 1000;

// The largest exponent field of some numbers, and how far their lowest set bit is below ABOVE_EXPONENTS. The span of
// several points has the larger of each.
fn span_of(point: Point) -> vec2u {
    let fields = max((point >> vec3u(23u)) & vec3u(255u), vec3u(1u));
    return vec2u(max(fields.x, max(fields.y, fields.z)), u32(ABOVE_EXPONENTS - unit_exponent(point)));
}
