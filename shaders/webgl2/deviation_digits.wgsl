// Tests how far a flip moves the surface, by exact integers as digits.
#import digits
#import mesh
#import points
#import vector_digits

// Let e = a - b, f = c - d, p = a - c, and V the determinant of the three. The identity of Desnanot and Jacobi says
// V²·f² = (e × f)²·(f × p)² - ((e·f)(f·p) - f²(e·p))². So V² > δ²(e × f)² if and only if
// (e × f)²·(f²(p² - δ²) - (f·p)²) > (f²(e·p) - (e·f)(f·p))².
fn exact_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    let grid = min(grid_of(a, b, c, d), deviation_grid());
    let from_ab = exact_differences(a, b, grid);
    let from_cd = exact_differences(c, d, grid);
    let from_ac = exact_differences(a, c, grid);
    let most = deviation_on(grid);
    let widest = from_ab[0] | from_ab[1] | from_ab[2] | from_cd[0] | from_cd[1] | from_cd[2]
        | from_ac[0] | from_ac[1] | from_ac[2] | most;
    let count = digits_in_use(widest);
    let e = vector_of(from_ab);
    let f = vector_of(from_cd);
    let p = vector_of(from_ac);
    let allowed = digits_of(most);
    let zero = Small();
    let square = sum_of_products(allowed, negated_small(allowed), zero, zero, zero, zero, count);
    let ef = dot_of(e, f, count);
    let ff = dot_of(f, f, count);
    let fp = dot_of(f, p, count);
    let pp = dot_of(p, p, count);
    let beyond = Medium(pp[0] + square[0], pp[1] + square[1], pp[2] + square[2], pp[3] + square[3]);
    let normal = determinant(dot_of(e, e, count), ff, ef, ef, count);
    let distance = determinant(ff, beyond, fp, fp, count);
    let offset = determinant(ff, dot_of(e, p, count), ef, fp, count);
    let sign = sum_of_large_products_sign(normal, distance, offset, negated_large(offset), 8u * count + 3u);
    return select(LABELLED, BLOCKED_BY + REASON_DEVIATION, sign > 0);
}
