// Creases: the edges of the input over β, as src/phases/crease.rs.

// The entry for `g` on the other side of `h`, flagged if the angle between the normals is larger than β.
fn creased(h: u32, g: u32) -> u32 {
    let a = position(vertex(h));
    let b = position(vertex(g));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(g)));
    return select(g, g | CREASE, is_over_angle(a, b, c, d));
}
