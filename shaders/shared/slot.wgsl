// Where half-edges go in an iteration, as src/phases/flip.rs.

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
