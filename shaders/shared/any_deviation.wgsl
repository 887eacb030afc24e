// Replaces deviation.wgsl and its exact arithmetic if the user sets no limit: every edge passes.
#import mesh
#import points

fn filtered_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    return LABELLED;
}

fn exact_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    return LABELLED;
}
