//! Drivers that end loops too early (see `rounds.wgsl`), and the limit for meshes on them.

/// The most triangles at one vertex on a driver that ends loops too early.
pub(in crate::engine) const SHORT_STAR: u32 = 20_000;

/// Whether a device ends loops too early. `answer` is its result of `rounds` (`rounds.wgsl`).
pub(in crate::engine) fn ends_loops_early(answer: u32) -> bool {
    let expected = (0..100_000).fold(1u32, |x, _| {
        let x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        x ^ (x >> 13)
    });
    answer != expected
}
