// The passes that flag creases, in space, before the first iteration on new positions.
#import creases
#import left_alone if floats
#import mesh
#import points
#import space
#import space_digits
#import state
#import still if fixed

// 1 if a half-edge is the lower one of a crease, else 0.
@fragment
fn crease_pass(@builtin(position) fragment: vec4f) -> @location(0) u32 {
    let h = index_at(fragment);
    var is_over = 0u;
    if h < 3u * params[0].x {
        let g = twin(h);
        if g != NONE && h < g {
            is_over = select(0u, 1u, is_crease(h, g));
        }
    }
    return is_over;
}

fn is_crease(h: u32, g: u32) -> bool {
    let a = position(vertex(h));
    let b = position(vertex(g));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(g)));
    var verdict = DELAUNAY;
    if leaves_some() {
        verdict = left_alone(a, b, c, d);
    }
    if verdict == DELAUNAY {
        verdict = filtered_crease(a, b, c, d);
    }
    if verdict == UNDECIDED {
        // Only the angle before the flip is undecided.
        verdict = verdict_of(exact_signs(a, b, c, d, Signs(-1, 0, 1, 1)));
    }
    return verdict == BLOCKED_BY + REASON_ANGLE;
}

// Sets the flag in the twins of creases, and clears it in all others. Locked edges keep their own flag.
@fragment
fn flag_pass(@builtin(position) fragment: vec4f) -> @location(0) vec4u {
    let t = index_at(fragment);
    var entries = vec4u(NONE);
    if t < params[0].x {
        entries = vec4u(flagged(3u * t), flagged(3u * t + 1u), flagged(3u * t + 2u), NONE);
    }
    return entries;
}

fn flagged(h: u32) -> u32 {
    let entry = twin_entry(h);
    let is_over = textureLoad(verdicts, texel_at(min(h, unflagged(entry))), 0).x == 1u;
    return select(select(entry & ~CREASE, entry | CREASE, is_over), NONE, entry == NONE);
}
