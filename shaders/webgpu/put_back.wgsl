// Put back: a vertex that is out walks to the triangle with its point, and divides it, as src/untangle/frame/put_back.rs.
#import areas
#import claims
#import mesh
#import state

const LONGEST: u32 = 64u;

// Finds the triangle that a vertex claims, and claims its corners; or forgets the claims on them.
fn aim(at: u32, forgets: bool) {
    let one = 3u * atomicLoad(&claims[at]);
    let v = twin_entry(one + 1u);
    let other = 3u * twin_entry(one + 2u);
    var t = twin_entry(select(other + 1u, one, number == HOME));
    while vertex(3u * t) == NONE {
        t = twin_entry(3u * t);
    }
    var walk = vec2u(t, t);
    if number < HOME - STRAYS {
        walk = walk_from(t, v);
    }
    set_twin_entry(other + 1u, walk.x);
    set_twin_entry(other + 2u, walk.y);
    for (var i = 0u; i < 3u && walk.y != NONE; i++) {
        let u = vertex(3u * walk.y + i);
        if forgets {
            atomicStore(&claims[u], NONE);
        } else {
            atomicMin(&claims[u], claim_key(v, 0u));
        }
    }
}

fn is_beyond(h: u32, v: u32) -> bool {
    return area_at(h / 3u, vec3u(vertex(h), vertex(next(h)), v), true) == INVERTED;
}

// Where a walk comes to, and the triangle that has the point of the vertex, or NONE.
fn walk_from(start: u32, v: u32) -> vec2u {
    var t = start;
    var found = NONE;
    var begin = NONE;
    var border = NONE;
    for (var step = 0u; step < LONGEST && found == NONE; step++) {
        let is_along = border != NONE;
        if is_along {
            t = border / 3u;
            begin = NONE;
        }
        let turn = key(t, number + step);
        var to = NONE;
        var side = NONE;
        for (var i = 0u; i < 3u; i++) {
            let h = select(3u * t + (turn % 3u + i) % 3u, border, is_along);
            if to == NONE && h != begin && is_beyond(h, v) {
                to = twin(h);
                side = select(NONE, next(h), to == NONE);
            }
        }
        if is_along {
            let across = twin(border);
            border = select(next(across), side, across == NONE);
        } else {
            found = select(NONE, t, to == NONE && side == NONE);
            border = side;
            begin = to;
            t = select(to / 3u, t, to == NONE);
        }
    }
    return vec2u(t, found);
}

// Puts a vertex into the triangle that it claims, if it has kept its claims.
fn put(at: u32) {
    let one = atomicLoad(&claims[at]);
    let v = twin_entry(3u * one + 1u);
    let other = twin_entry(3u * one + 2u);
    let t = twin_entry(3u * other + 2u);
    var wins = t != NONE;
    var vertices = vec3u();
    var outer = vec3u();
    for (var i = 0u; i < 3u && wins; i++) {
        vertices[i] = vertex(3u * t + i);
        outer[i] = twin_entry(3u * t + i);
        wins = atomicLoad(&claims[vertices[i]]) == claim_key(v, 0u);
    }
    if wins {
        let slots = vec3u(t, one, other);
        for (var i = 0u; i < 3u; i++) {
            set_triangle(slots[i], vec3u(vertices[i], vertices[(i + 1u) % 3u], v));
        }
        for (var i = 0u; i < 3u; i++) {
            join(3u * slots[i], outer[i]);
            join(3u * slots[i] + 1u, 3u * slots[(i + 1u) % 3u] + 2u);
        }
        if has_several_fans(vertices.z) {
            for (var i = fan_entry(vertices.z); fan_entry(i) != NONE; i++) {
                if fan_entry(i) == 3u * t + 2u {
                    topology[params.fans + i] = 3u * other;
                }
            }
        }
        atomicStore(&claims[at], NONE);
    }
}
