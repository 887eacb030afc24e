// Creases: the edges of the input over β, as src/phases/crease.rs.

// The entry of half-edge `h`, flagged if the angle between the normals is larger than β, and only then.
fn creased(h: u32, entry: u32) -> u32 {
    let g = unflagged(entry);
    let a = position(vertex(h));
    let b = position(vertex(g));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(g)));
    return select(entry & ~CREASE, entry | CREASE, is_over_angle(a, b, c, d));
}
