// The passes that count what updates do, and that keep which triangles they change.
#import left_alone if floats
#import mesh
#import plane if plane
#import plane_digits if plane
#import points
#import state
#import still if fixed

// The number of the update, in each triangle that the last iteration has flipped.
@fragment
fn change_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    if selected(index_at(fragment)) == NONE {
        discard;
    }
    return vec4u(params[7].y);
}

// The flips of all updates. `counts` has twice the flips of each iteration of the last update, `totals` the flips of
// the updates before.
@fragment
fn total_pass() -> @location(0) vec4u {
    var flips = 0u;
    let end = textureDimensions(counts).x;
    for (var column = 0u; column < end; column++) {
        flips += textureLoad(counts, vec2u(column, 0u), 0).x / 2u;
    }
    let before = textureLoad(totals, vec2u(), 0).xy;
    let low = before.x + flips;
    return vec4u(low, before.y + select(0u, 1u, low < flips), 0u, 0u);
}

// 1 if a triangle in the plane is not positive: it does not have the strict sign of its component, or it is left alone.
@fragment
fn turned_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let t = index_at(fragment);
    var is_positive = true;
    if t < params[0].x {
        let a = position(vertex(3u * t));
        let b = position(vertex(3u * t + 1u));
        let c = position(vertex(3u * t + 2u));
        let winding = select(1, -1, is_clockwise(t));
        let is_left = leaves_some() && is_too_wide(max(span_of(a), max(span_of(b), span_of(c))));
        is_positive = !is_left && winding * sign_of_triangle(a, b, c) > 0;
    }
    return vec4u(select(1u, 0u, is_positive), 0u, 0u, 0u);
}
