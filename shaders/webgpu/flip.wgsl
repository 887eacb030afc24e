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
    let flips = array(flip_at(outer_g.x), flip_at(outer_h.y), flip_at(outer_h.x), flip_at(outer_g.y));
    triangles[hn] = d;
    triangles[gn] = c;
    set_twin_entry(hn, gn);
    set_twin_entry(gn, hn);
    set_twin_entry(h, slot_after(outer_g.x, flips[0]));
    set_twin_entry(hp, slot_after(outer_h.y, flips[1]));
    set_twin_entry(g, slot_after(outer_h.x, flips[2]));
    set_twin_entry(gp, slot_after(outer_g.y, flips[3]));
    turn_to(outer_g.x, h, flips[0]);
    turn_to(outer_h.y, hp, flips[1]);
    turn_to(outer_h.x, g, flips[2]);
    turn_to(outer_g.y, gp, flips[3]);
}

// Writes the new twin of the half-edge on the other side, unless its triangle flips.
fn turn_to(outer: u32, inner: u32, flip: vec2u) {
    if outer != NONE && flip.x == NONE {
        set_twin_entry(unflagged(outer), inner | (outer & FLAGS));
    }
}

// Moves the anchor at word `i` of the fans' table.
fn move_anchor(i: u32) {
    let at = params.fans + i;
    topology[at] = slot(topology[at]);
}
