// Tests an interior edge, as `verdict` in src/phases/label.rs, without the guard.
#import left_alone if floats
#import mesh
#import plane if plane
#import plane_digits if plane
#import points
#import space if space
#import space_digits if space
#import state
#import still if fixed

// The verdict on the geometry of the interior edge of the half-edges `h` and `g`, and on its flags.
fn geometric_verdict(h: u32, g: u32) -> u32 {
    let a = position(vertex(h));
    let b = position(vertex(g));
    let c = position(vertex(prev(h)));
    let d = position(vertex(prev(g)));
    let entry = twin_entry(h);
    let winding = select(1, -1, is_clockwise(h / 3u));
    var verdict = DELAUNAY;
    if leaves_some() {
        verdict = left_alone(a, b, c, d);
    }
    if verdict == DELAUNAY {
        verdict = filtered_verdict_on(a, b, c, d, winding);
    }
    if verdict == UNDECIDED {
        verdict = exact_verdict_on(a, b, c, d, winding);
    }
    if verdict != DELAUNAY && verdict < LEFT_AS_INFINITE && (entry & FLAGS) != 0u {
        verdict = BLOCKED_BY + select(REASON_ANGLE, REASON_LOCKED, (entry & LOCKED) != 0u);
    }
    return verdict;
}
