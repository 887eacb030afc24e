// In the place of narrow.wgsl, where compilers would take twice as long with it.

fn is_known_delaunay(p: Vector, q: Vector, r: Vector, s: Vector, count: u32) -> bool {
    return false;
}
