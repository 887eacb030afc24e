// Lets every edge pass the test of the deviation: stands in for deviation.wgsl and for the exact arithmetic behind it where
// the user sets no limit.
#import mesh
#import points

fn filtered_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    return LABELLED;
}

fn exact_deviation(a: Point, b: Point, c: Point, d: Point) -> u32 {
    return LABELLED;
}
