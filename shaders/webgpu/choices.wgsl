// The choices of the triangles, and the flips that they make.
#import mesh
#import mutual
#import state

// The choice of Label for each triangle, then the choice of Select, see `flip_of`.
@group(0) @binding(5) var<storage, read_write> choices: array<u32>;

fn best(t: u32) -> u32 {
    return choices[t];
}

// The two half-edges of the selected edge of triangle `t`, its own one first; NONE if no edge is selected. The choice
// of Select has the other half-edge, and in the bits of the flags the index of its own half-edge in the triangle,
// 0 to 2. Without Select, the edge is selected that is the best of both its triangles.
fn flip_of(t: u32) -> vec2u {
    var flip = vec2u(NONE);
    if has_selection() {
        let entry = choices[params.triangles + t];
        flip = select(vec2u(3u * t + (entry >> 30u), entry & ~FLAGS), flip, entry == NONE);
    } else {
        let h = mutual(t);
        flip = vec2u(h, select(best(t), NONE, h == NONE));
    }
    return flip;
}

fn set_flip(h: u32, g: u32) {
    choices[params.triangles + h / 3u] = g | ((h % 3u) << 30u);
}

fn clear_flip(t: u32) {
    choices[params.triangles + t] = NONE;
}
