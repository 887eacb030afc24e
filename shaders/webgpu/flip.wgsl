// Flip and update, in the same buffers: rewrites the two triangles of each selected edge and the twins around it, as
// src/phases/flip.rs. It reads the twins of its own two triangles only. It writes these, and the entries of neighbours
// without a selected edge. All reads come before all writes.
#import mesh
#import slot
#import state

fn flip_edge(h: u32, g: u32, outer_h: vec2u, outer_g: vec2u) {
    let hn = next(h);
    let hp = prev(h);
    let gn = next(g);
    let gp = prev(g);
    let c = triangles[hp];
    let d = triangles[gp];
    let slots = vec4u(slot(outer_g.x), slot(outer_h.y), slot(outer_h.x), slot(outer_g.y));
    let are_still = vec4<bool>(is_still(outer_g.x), is_still(outer_h.y), is_still(outer_h.x), is_still(outer_g.y));
    triangles[hn] = d;
    triangles[gn] = c;
    set_twin_entry(hn, gn);
    set_twin_entry(gn, hn);
    set_twin_entry(h, slots.x);
    set_twin_entry(hp, slots.y);
    set_twin_entry(g, slots.z);
    set_twin_entry(gp, slots.w);
    turn_to(outer_g.x, h, are_still.x);
    turn_to(outer_h.y, hp, are_still.y);
    turn_to(outer_h.x, g, are_still.z);
    turn_to(outer_g.y, gp, are_still.w);
}

// Whether an entry has a half-edge whose triangle does not flip.
fn is_still(entry: u32) -> bool {
    let x = unflagged(entry);
    return x != NONE && flip_of(x / 3u).x == NONE;
}

// Writes the new twin of the half-edge on the other side.
fn turn_to(outer: u32, inner: u32, is_still: bool) {
    if is_still {
        set_twin_entry(unflagged(outer), inner | (outer & FLAGS));
    }
}

// Moves the anchor at word `i` of the fans' table.
fn move_anchor(i: u32) {
    let at = params.fans + i;
    topology[at] = slot(topology[at]);
}
