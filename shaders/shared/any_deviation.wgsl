// In the place of deviation.wgsl, where diagonals may be any distance apart.

fn filtered_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    return LABELLED;
}

fn exact_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    return LABELLED;
}
