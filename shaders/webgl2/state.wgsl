// The state of a mesh in textures, as the WebGL2 engine binds it: one element per texel, row after row. A fragment
// reads any texel of the state before its pass, and writes the texel of its own triangle in another texture.
#import digits
#import mesh

// Three words per texel: positions, as floats.wgsl and fixed_point.wgsl define them; vertices; twins. The fourth word
// of a triangle is 1 where its component is clockwise.
@group(0) @binding(0) var positions: texture_2d<u32>;
@group(0) @binding(1) var triangles: texture_2d<u32>;
@group(0) @binding(2) var twins: texture_2d<u32>;
// One word per texel.
@group(0) @binding(3) var bests: texture_2d<u32>;
@group(0) @binding(4) var selections: texture_2d<u32>;
// The table of the fans.
@group(0) @binding(5) var fans: texture_2d<u32>;
// One half-edge per texel: the verdict on the geometry of its edge, if it is the lower half-edge.
@group(0) @binding(6) var verdicts: texture_2d<u32>;
// Four counts per texel.
@group(0) @binding(7) var counts: texture_2d<u32>;
// One texel: the flips of all updates, as a low and a high word.
@group(0) @binding(9) var totals: texture_2d<u32>;

// (triangles, vertices, the iteration, bits of the column in an index), (words in the table of the fans, whether β is
// 180°, the sign of cos β, cos β rounded to f32), then the digits of its mantissa and power, as in digits.wgsl, then
// the limit for the deviation: the words of a coordinate, and rounded to f32 for the filter; then (the first iteration
// on the present positions, the number of the update while the mesh moves, whether some edge may have to be left alone).
@group(0) @binding(8) var<uniform> params: array<vec4u, 8>;

fn texel_at(i: u32) -> vec2u {
    let bits = params[0].w;
    return vec2u(i & ((1u << bits) - 1u), i >> bits);
}

// The index of the fragment's texel.
fn index_at(fragment: vec4f) -> u32 {
    return (u32(fragment.y) << params[0].w) + u32(fragment.x);
}

// One of the first three components.
fn component(v: vec4u, k: u32) -> u32 {
    return select(select(v.x, v.y, k == 1u), v.z, k == 2u);
}

fn with_component(v: vec4u, k: u32, x: u32) -> vec4u {
    return vec4u(select(v.x, x, k == 0u), select(v.y, x, k == 1u), select(v.z, x, k == 2u), v.w);
}

fn vertex(h: u32) -> u32 {
    return component(textureLoad(triangles, texel_at(h / 3u), 0), h % 3u);
}

// The half-edge on the other side, with its flags, or NONE.
fn twin_entry(h: u32) -> u32 {
    return component(textureLoad(twins, texel_at(h / 3u), 0), h % 3u);
}

fn twin(h: u32) -> u32 {
    return unflagged(twin_entry(h));
}

fn best(t: u32) -> u32 {
    return textureLoad(bests, texel_at(t), 0).x;
}

fn selected(t: u32) -> u32 {
    return textureLoad(selections, texel_at(t), 0).x;
}

// The two half-edges of the selected edge of triangle `t`, its own one first; NONE if no edge is selected.
fn flip_of(t: u32) -> vec2u {
    let g = selected(t);
    var h = NONE;
    if g != NONE {
        h = selected(g / 3u);
    }
    return vec2u(h, g);
}

// Words of a position, one for each axis.
fn coordinates(i: u32) -> vec3u {
    return textureLoad(positions, texel_at(i), 0).xyz;
}

fn is_clockwise(t: u32) -> bool {
    return textureLoad(triangles, texel_at(t), 0).w == 1u;
}

// This engine does not know the embedded stars.
fn is_embedded(v: u32) -> bool {
    return false;
}

fn is_strict() -> bool {
    return false;
}

fn has_fans() -> bool {
    return params[1].x > 0u;
}

// A word of the table of the fans, see src/mesh/star.rs.
fn fan_entry(i: u32) -> u32 {
    return textureLoad(fans, texel_at(i), 0).x;
}

fn has_any_angle() -> bool {
    return params[1].y == 1u;
}

fn cos_rounded() -> f32 {
    return bitcast<f32>(params[1].w);
}

fn cos_sign() -> i32 {
    return bitcast<i32>(params[1].z);
}

fn cos_mantissa() -> Small {
    return Small(bitcast<vec4i>(params[2]), bitcast<vec4i>(params[3]));
}

fn cos_power() -> Small {
    return Small(bitcast<vec4i>(params[4]), bitcast<vec4i>(params[5]));
}

fn deviation() -> vec4u {
    return params[6];
}

fn is_first_iteration() -> bool {
    return params[0].z == params[7].x;
}

fn leaves_some() -> bool {
    return params[7].z == 1u;
}
