// Finds the index of a half-edge after the flips of an iteration, as src/phases/flip.rs.
#import mesh
#import state

// A twin entry after the iteration: the new index of its half-edge, with the flags.
fn slot(entry: u32) -> u32 {
    let x = unflagged(entry);
    var result = entry;
    if x != NONE {
        let flip = flip_of(x / 3u);
        if flip.x != NONE && x == next(flip.x) {
            result = flip.y | (entry & FLAGS);
        }
    }
    return result;
}
