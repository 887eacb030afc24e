// In the place of narrow.wgsl, where compilers would take twice as long with it.

fn narrow_angle_sum_sign(p: Vector, q: Vector, r: Vector, s: Vector, count: u32) -> i32 {
    return 0;
}
