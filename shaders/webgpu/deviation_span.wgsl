// The span of the limit for the deviation: exact arithmetic takes it as a coordinate.
#import span
#import state

fn deviation_span() -> vec2u {
    return span_of(vec3u(params.deviation.x));
}
