// Says where a half-edge is after the flips of an iteration, as src/phases/flip.rs.
#import mesh
#import state

// Where half-edge `x`, given with its flags, will be after the iteration.
fn slot(entry: u32) -> u32 {
    let x = unflagged(entry);
    var place = entry;
    if x != NONE {
        let flip = flip_of(x / 3u);
        if flip.x != NONE && x == next(flip.x) {
            place = flip.y | (entry & FLAGS);
        }
    }
    return place;
}
