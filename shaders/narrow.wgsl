// The angle sum in space in few digits: most edges that the filter leaves are ties, or nearly, of numbers that are not
// far apart.

// x, y and z in up to 3 digits.
alias Narrow = array<vec4i, 3>;

fn narrow_of(v: Vector) -> Narrow {
    return Narrow(v[0], v[2], v[4]);
}

// The sign of the angle sum, given differences with `count` digits in use: 0 where those are too many.
fn narrow_angle_sum_sign(p: Vector, q: Vector, r: Vector, s: Vector, count: u32) -> i32 {
    var sign = 0;
    if count <= 3u {
        sign = select(1, -1, is_narrow_angle_sum_negative(narrow_of(p), narrow_of(q), narrow_of(r), narrow_of(s)));
    }
    return sign;
}

// As `is_angle_sum_negative`, of the vectors themselves.
fn is_narrow_angle_sum_negative(p: Narrow, q: Narrow, r: Narrow, s: Narrow) -> bool {
    let pq = narrow_dot(p, q);
    let rs = narrow_dot(r, s);
    let n1_square = narrow_sum(narrow_dot(p, p), narrow_dot(q, q), pq, negated_small(pq));
    let n2_square = narrow_sum(narrow_dot(s, s), narrow_dot(r, r), rs, negated_small(rs));
    let first = medium_sign(n1_square) * small_sign(rs);
    let second = medium_sign(n2_square) * small_sign(pq);
    var sum = first + second;
    if first * second < 0 {
        let zero = Small();
        let square2 = narrow_sum(rs, rs, zero, zero);
        let square1 = negated_medium(narrow_sum(pq, pq, zero, zero));
        sum = first * sum_of_medium_products_sign(n1_square, square2, n2_square, square1);
    }
    return sum < 0;
}

fn narrow_dot(u: Narrow, v: Narrow) -> Small {
    return narrow_sum_of_products(u[0], v[0], u[1], v[1], u[2], v[2]);
}

// x·u + y·v + z·w of digits of differences, which 7 digits hold.
fn narrow_sum_of_products(x: vec4i, u: vec4i, y: vec4i, v: vec4i, z: vec4i, w: vec4i) -> Small {
    var result = Small();
    var left_u = u;
    var left_v = v;
    var left_w = w;
    var turned_u = vec4i();
    var turned_v = vec4i();
    var turned_w = vec4i();
    var carry = 0;
    for (var column = 0u; column < 8u; column++) {
        turned_u = vec4i(left_u.x, turned_u.xyz);
        turned_v = vec4i(left_v.x, turned_v.xyz);
        turned_w = vec4i(left_w.x, turned_w.xyz);
        left_u = vec4i(left_u.yzw, 0);
        left_v = vec4i(left_v.yzw, 0);
        left_w = vec4i(left_w.yzw, 0);
        carry += dot(x, turned_u) + dot(y, turned_v) + dot(z, turned_w);
        let digit = digit_of(carry);
        carry = (carry - digit) >> DIGIT_BITS;
        result = moved_down_small(result, digit);
    }
    return result;
}

// x·u + y·v of dot products, which 13 digits hold.
fn narrow_sum(x: Small, u: Small, y: Small, v: Small) -> Medium {
    return sum_of_products(x, u, y, v, Small(), Small(), 6u);
}

fn small_sign(x: Small) -> i32 {
    return highest_sign(x[1], highest_sign(x[0], 0));
}

// The sign of x·u + y·v of degree 8 in differences with 3 digits, which 27 digits hold. A column is below 32·2^24.
fn sum_of_medium_products_sign(x: Medium, u: Medium, y: Medium, v: Medium) -> i32 {
    var result = 0;
    var left_u = u;
    var left_v = v;
    var turned_u = Medium();
    var turned_v = Medium();
    var carry = 0;
    for (var column = 0u; column < 27u; column++) {
        turned_u = moved_up_medium(turned_u, left_u[0].x);
        turned_v = moved_up_medium(turned_v, left_v[0].x);
        left_u = moved_down_medium(left_u, 0);
        left_v = moved_down_medium(left_v, 0);
        carry += column_medium(x, turned_u) + column_medium(y, turned_v);
        let digit = digit_of(carry);
        carry = (carry - digit) >> DIGIT_BITS;
        result = select(result, sign(digit), digit != 0);
    }
    return result;
}
