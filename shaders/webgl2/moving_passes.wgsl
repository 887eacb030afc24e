// The passes that count the areas and what updates do, and that keep which triangles updates change.
#import areas
#import mesh
#import state

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

// Whether a triangle is inverted, flat or undecided: 1 in the component of that.
@fragment
fn areas_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let t = index_at(fragment);
    var area = POSITIVE_AREA;
    if t < params[0].x {
        area = area_of(t, leaves_some());
    }
    return vec4u(vec4u(area) == vec4u(INVERTED, FLAT, UNDECIDED_AREA, NONE));
}
