// Finds the index of a half-edge after the flips of an iteration, as src/phases/flip.rs.
#import mesh
#import state

// A twin entry after the iteration: the new index of its half-edge, with the flags.
fn slot(entry: u32) -> u32 {
    return slot_after(entry, flip_at(entry));
}

// The flip of the triangle of a twin entry, or NONE.
fn flip_at(entry: u32) -> vec2u {
    let x = unflagged(entry);
    var flip = vec2u(NONE);
    if x != NONE {
        flip = flip_of(x / 3u);
    }
    return flip;
}

fn slot_after(entry: u32, flip: vec2u) -> u32 {
    return select(entry, flip.y | (entry & FLAGS), flip.x != NONE && unflagged(entry) == next(flip.x));
}
