// Where half-edges go in an iteration, as src/phases/flip.rs.

// Where half-edge `x`, given with its flag, will be after the iteration.
fn slot(entry: u32) -> u32 {
    if entry == NONE {
        return NONE;
    }
    let x = unflagged(entry);
    let g = selected(x / 3u);
    if g == NONE || x != next(selected(g / 3u)) {
        return entry;
    }
    return g | (entry & CREASE);
}
