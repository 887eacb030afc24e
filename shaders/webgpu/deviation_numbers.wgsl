// Tests how far a flip moves the surface, by exact integers.
#import mesh
#import numbers
#import points

const OFFSETS: u32 = 8u;

// The offset of the result of this program.
const OFFSET: u32 = 488u;

// Let p = a - c, e = a - b, f = c - d, and V the determinant of the three. The identity of Desnanot and Jacobi says
// V²·f² = (e × f)²·(f × p)² - ((e·f)(f·p) - f²(e·p))². So V² > δ²(e × f)² if and only if
// (e × f)²·(f²(p² - δ²) - (f·p)²) > (f²(e·p) - (e·f)(f·p))².
fn exact_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    let grid = min(grid_of(a, b, c, d), deviation_grid());
    let number = lane / GIVEN_WORDS;
    var u = a;
    var v = c;
    if number >= 6u {
        u = c;
        v = d;
    } else if number >= 3u {
        v = b;
    }
    var given = exact_difference(u, v, number % 3u, grid);
    if number >= 9u {
        given = deviation_on(grid);
    }
    put_given(given_digit(given));
    run(OFFSETS);
    return select(LABELLED, BLOCKED_BY + REASON_DEVIATION, sign_at(OFFSET) > 0);
}
