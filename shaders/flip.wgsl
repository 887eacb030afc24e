// Flip with Update: rotate the two triangles of each selected edge in place and repair the twins around, as
// src/phases/flip.rs.

// Where half-edge `x` will be after the iteration.
fn slot(x: u32) -> u32 {
    if x == NONE {
        return NONE;
    }
    let g = selected(x / 3u);
    if g == NONE || x != next(selected(g / 3u)) {
        return x;
    }
    return g;
}

// Reads the twins of its own two triangles only; writes those, and the entries of the neighbours that are
// not selected themselves.
fn flip_edge(h: u32, g: u32) {
    let hn = next(h);
    let hp = prev(h);
    let gn = next(g);
    let gp = prev(g);
    let outer_hn = twins[hn];
    let outer_hp = twins[hp];
    let outer_gn = twins[gn];
    let outer_gp = twins[gp];
    let c = triangles[hp];
    let d = triangles[gp];
    triangles[hn] = d;
    triangles[gn] = c;
    twins[hn] = gn;
    twins[gn] = hn;
    update(h, outer_gn);
    update(hp, outer_hp);
    update(g, outer_hn);
    update(gp, outer_gp);
}

fn update(inner: u32, outer: u32) {
    twins[inner] = slot(outer);
    if outer != NONE && selected(outer / 3u) == NONE {
        twins[outer] = inner;
    }
}

// Moves the anchor at word `i` of the fans' table.
fn move_anchor(i: u32) {
    let at = params.fans + i;
    topology[at] = slot(topology[at]);
}
