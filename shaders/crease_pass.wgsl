// The entry point of the creases over textures, before the first iteration on a surface.

@fragment
fn crease_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let t = index_at(fragment);
    if t >= params[0].x {
        return vec4u(NONE);
    }
    return vec4u(crease_entry(3u * t), crease_entry(3u * t + 1u), crease_entry(3u * t + 2u), 0u);
}

fn crease_entry(h: u32) -> u32 {
    let g = twin(h);
    if g == NONE {
        return NONE;
    }
    return creased(h, g);
}
