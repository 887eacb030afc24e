// Tests edges in space by exact integers as digits.
#import any_deviation if any_deviation
#import deviation if deviation
#import deviation_digits if deviation
#import digits
#import mesh
#import points
#import space
#import state
#import vector_digits

// The verdict on any edge: by a filter that is slower and decides more, then by integers.
fn exact_verdict_on(a: Point, b: Point, c: Point, d: Point, winding: i32) -> u32 {
    var signs = filtered_signs(a, b, c, d, true);
    if verdict_of(signs) == UNDECIDED {
        signs = exact_signs(a, b, c, d, signs);
    }
    var verdict = verdict_of(signs);
    if verdict == LABELLED {
        verdict = filtered_deviation(a, b, c, d);
    }
    if verdict == UNDECIDED {
        verdict = exact_deviation(a, b, c, d);
    }
    return verdict;
}

// The signs. Integers decide the undecided ones that matter.
fn exact_signs(a: Point, b: Point, c: Point, d: Point, filtered: Signs) -> Signs {
    let grid = grid_of(a, b, c, d);
    let from_ac = exact_differences(a, c, grid);
    let from_bc = exact_differences(b, c, grid);
    let from_ad = exact_differences(a, d, grid);
    let from_bd = exact_differences(b, d, grid);
    let widest = from_ac[0] | from_ac[1] | from_ac[2] | from_bc[0] | from_bc[1] | from_bc[2]
        | from_ad[0] | from_ad[1] | from_ad[2] | from_bd[0] | from_bd[1] | from_bd[2];
    let count = digits_in_use(widest);
    let p = vector_of(from_ac);
    let q = vector_of(from_bc);
    let r = vector_of(from_ad);
    let s = vector_of(from_bd);
    let pp = dot_of(p, p, count);
    let pq = dot_of(p, q, count);
    let qq = dot_of(q, q, count);
    let rr = dot_of(r, r, count);
    let rs = dot_of(r, s, count);
    let ss = dot_of(s, s, count);
    // The squares of the old normals n1 = p × q and n2 = s × r.
    let n1_square = determinant(pp, qq, pq, pq, count);
    let n2_square = determinant(ss, rr, rs, rs, count);
    var signs = filtered;
    if signs.x == 0 {
        signs.x = select(1, -1, is_angle_sum_negative(n1_square, rs, n2_square, pq, count));
    }
    if verdict_of(signs) == UNDECIDED {
        let pr = dot_of(p, r, count);
        let ps = dot_of(p, s, count);
        let qr = dot_of(q, r, count);
        let qs = dot_of(q, s, count);
        // The old normals, then the new ones, m1 = r × p and m2 = q × s.
        var n_square = n1_square;
        var m_square = n2_square;
        var cosine = determinant(ps, qr, pr, qs, count);
        for (var round = 0u; round < 2u; round++) {
            if select(signs.y, signs.z, round == 1u) == 0 {
                if round == 1u {
                    n_square = determinant(rr, pp, pr, pr, count);
                    m_square = determinant(qq, ss, qs, qs, count);
                    cosine = determinant(qr, ps, rs, pq, count);
                }
                let angle = select(1, -1, exceeds_angle(n_square, m_square, cosine));
                signs = select(Signs(signs.x, angle, signs.zw), Signs(signs.xy, angle, signs.w), round == 1u);
            }
        }
        if signs.w == 0 {
            let turned = min(
                min(large_sign(determinant(pr, pq, pp, qr, count)), large_sign(determinant(pq, qs, ps, qq, count))),
                min(large_sign(determinant(rs, pr, ps, rr, count)), large_sign(determinant(qs, rs, ss, qr, count))),
            );
            signs.w = select(1, -1, turned < 0);
        }
    }
    return signs;
}

// Whether √(n1²)·dot2 + √(n2²)·dot1 < 0: by the squares, with the signs of what was squared.
fn is_angle_sum_negative(n1_square: Large, dot2: Medium, n2_square: Large, dot1: Medium, count: u32) -> bool {
    let first = large_sign(n1_square) * medium_sign(dot2);
    let second = large_sign(n2_square) * medium_sign(dot1);
    var sum = first + second;
    if first * second < 0 {
        let zero = Medium();
        let square2 = sum_of_medium_products(dot2, dot2, zero, zero, count);
        let square1 = negated_large(sum_of_medium_products(dot1, dot1, zero, zero, count));
        sum = first * sum_of_large_products_sign(n1_square, square2, n2_square, square1, 8u * count + 3u);
    }
    return sum < 0;
}

// Whether n·m < k|n||m|, given n², m² and n·m.
fn exceeds_angle(n_square: Large, m_square: Large, cosine: Large) -> bool {
    let left_sign = large_sign(cosine);
    let right_sign = cos_sign() * large_sign(n_square) * large_sign(m_square);
    var difference_sign = left_sign - right_sign;
    if left_sign * right_sign > 0 {
        // With |k| = mantissa / 2^shift: (n·m·2^shift)² against (n²·mantissa)·(m²·mantissa).
        let left = scaled(cosine, cos_power());
        let right_n = scaled(n_square, cos_mantissa());
        let right_m = negated_large(scaled(m_square, cos_mantissa()));
        difference_sign = left_sign * sum_of_large_products_sign(left, left, right_n, right_m, 73u);
    }
    return difference_sign < 0;
}
