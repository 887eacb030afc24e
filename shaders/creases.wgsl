// Creases: the edges of the input over β, as src/phases/crease.rs.

// Whether the edge of the half-edges `h` and `g` is one, as `angle_verdict_on` says it.
fn crease_verdict(h: u32, g: u32) -> u32 {
    let a = position(vertex(h));
    let b = position(vertex(g));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(g)));
    return angle_verdict_on(a, b, c, d);
}
