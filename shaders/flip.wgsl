// Flip with Update in place: rotate the two triangles of each selected edge and repair the twins around, as
// src/phases/flip.rs.

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
    let x = unflagged(outer);
    if x != NONE && selected(x / 3u) == NONE {
        twins[x] = inner | (outer & FLAGS);
    }
}

// Moves the anchor at word `i` of the fans' table.
fn move_anchor(i: u32) {
    let at = params.fans + i;
    topology[at] = slot(topology[at]);
}
