// Tests how far a flip moves the surface, by exact integers in memory.
#import mesh
#import numbers
#import points

const OFFSETS: u32 = 9u;

// Offsets of a - b, c - d and a - c, of δ, and of the results of the program.
const DIAGONALS: u32 = 126u;
const ALLOWED: u32 = 180u;
const OFFSET: u32 = 581u;

// With e = a - b, f = c - d, p = a - c and V their determinant, by the identity of Desnanot and Jacobi
// V²·f² = (e × f)²·(f × p)² - ((e·f)(f·p) - f²(e·p))²: V² > δ²(e × f)² if
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
