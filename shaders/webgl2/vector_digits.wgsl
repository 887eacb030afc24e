// Computes with vectors of exact integers as digits: dot products and their determinants.
#import digits
#import points

// x, y and z, of the digits of a Small each.
alias Vector = array<vec4i, 6>;

fn vector_of(differences: Differences) -> Vector {
    let x = digits_of(differences[0]);
    let y = digits_of(differences[1]);
    let z = digits_of(differences[2]);
    return Vector(x[0], x[1], y[0], y[1], z[0], z[1]);
}

fn dot_of(u: Vector, v: Vector, count: u32) -> Medium {
    return sum_of_products(
        Small(u[0], u[1]),
        Small(v[0], v[1]),
        Small(u[2], u[3]),
        Small(v[2], v[3]),
        Small(u[4], u[5]),
        Small(v[4], v[5]),
        count,
    );
}

// u·v - x·y, for dot products of normals by the Binet–Cauchy identity
// (u × v)·(x × y) = (u·x)(v·y) - (u·y)(v·x).
fn determinant(u: Medium, v: Medium, x: Medium, y: Medium, count: u32) -> Large {
    return sum_of_medium_products(u, v, x, negated_medium(y), count);
}
