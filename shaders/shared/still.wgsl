// Fixed-point numbers come from the host, which has checked them.
#import mesh
#import points

fn span_of(point: Point) -> vec2u {
    return vec2u();
}

fn deviation_span() -> vec2u {
    return vec2u();
}

fn is_too_wide(span: vec2u) -> bool {
    return false;
}

fn left_alone(a: Point, b: Point, c: Point, d: Point) -> u32 {
    return DELAUNAY;
}
