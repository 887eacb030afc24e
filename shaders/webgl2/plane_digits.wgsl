// Tests edges in the plane by exact integers as digits.
#import digits
#import mesh
#import plane
#import points

fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var verdict = close_verdict_on(a, b, c, d, winding);
    if verdict == UNDECIDED {
        verdict = wide_verdict_on(a, b, c, d, winding);
    }
    return verdict;
}

fn wide_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    let grid = grid_of(a, b, c, d);
    let p = exact_differences(a, c, grid);
    let q = exact_differences(b, c, grid);
    let r = exact_differences(a, d, grid);
    let s = exact_differences(b, d, grid);
    let count = digits_in_use(p[0] | p[1] | q[0] | q[1] | r[0] | r[1] | s[0] | s[1]);
    let px = digits_of(p[0]);
    let py = digits_of(p[1]);
    let qx = digits_of(q[0]);
    let qy = digits_of(q[1]);
    let rx = digits_of(r[0]);
    let ry = digits_of(r[1]);
    let sx = digits_of(s[0]);
    let sy = digits_of(s[1]);
    let zero = Small();
    let cross1 = sum_of_products(px, qy, py, negated_small(qx), zero, zero, count);
    let dot1 = sum_of_products(px, qx, py, qy, zero, zero, count);
    let cross2 = sum_of_products(sx, ry, sy, negated_small(rx), zero, zero, count);
    let dot2 = sum_of_products(sx, rx, sy, ry, zero, zero, count);
    var verdict = DELAUNAY;
    if winding * large_sign(sum_of_medium_products(cross1, dot2, dot1, cross2, count)) < 0 {
        let area1 = medium_sign(sum_of_products(rx, py, ry, negated_small(px), zero, zero, count));
        let area2 = medium_sign(sum_of_products(qx, sy, qy, negated_small(sx), zero, zero, count));
        verdict = select(LABELLED, BLOCKED_BY + REASON_FOLD, min(winding * area1, winding * area2) <= 0);
    }
    return verdict;
}
