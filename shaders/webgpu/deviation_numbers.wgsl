// Tests how far a flip moves the surface, by exact integers in memory.
#import mesh
#import numbers
#import points

const OFFSETS: u32 = 9u;

// Offsets of the diagonals a - b and c - d, of δ, and of the result of the program.
const DIAGONALS: u32 = 126u;
const ALLOWED: u32 = 180u;
const OFFSET: u32 = 581u;

// Let e = a - b, f = c - d, p = a - c, and V the determinant of the three. The identity of Desnanot and Jacobi says
// V²·f² = (e × f)²·(f × p)² - ((e·f)(f·p) - f²(e·p))². So V² > δ²(e × f)² if and only if
// (e × f)²·(f²(p² - δ²) - (f·p)²) > (f²(e·p) - (e·f)(f·p))².
fn exact_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    let grid = min(grid_of(a, b, c, d), deviation_grid());
    put_vector(DIFFERENCES, a, c, grid);
    put_vector(DIAGONALS, a, b, grid);
    put_vector(DIAGONALS + VECTOR, c, d, grid);
    put(ALLOWED, deviation_on(grid));
    run(OFFSETS);
    return select(LABELLED, BLOCKED_BY + REASON_DEVIATION, sign_at(OFFSET) > 0);
}
