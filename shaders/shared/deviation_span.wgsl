// The span of the limit for the deviation: exact arithmetic takes its lowest bit as that of a coordinate. Its highest bit
// does not count, see `deviation_on`.
#import points

fn deviation_span() -> vec2u {
    return vec2u(0u, u32(ABOVE_EXPONENTS - deviation_grid()));
}
