// Where half-edges go in an iteration, as src/phases/flip.rs.

// Where half-edge `x`, given with its flags, will be after the iteration.
fn slot(entry: u32) -> u32 {
    let x = unflagged(entry);
    var g = NONE;
    if x != NONE {
        g = selected(x / 3u);
    }
    var place = entry;
    if g != NONE {
        place = select(entry, g | (entry & FLAGS), x == next(selected(g / 3u)));
    }
    return place;
}
