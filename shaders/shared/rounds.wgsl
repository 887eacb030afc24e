// Tests whether a driver runs all rounds of a loop. In llvmpipe, all loops of an invocation together have 65,535
// rounds. After that, every loop ends silently. For such drivers, the work must be cut into smaller pieces.

const ROUNDS: u32 = 100000u;

// A recurrence that no compiler can replace by a closed form.
fn rounds() -> u32 {
    var x = 1u;
    for (var i = 0u; i < ROUNDS; i++) {
        x = x * 1664525u + 1013904223u;
        x ^= x >> 13u;
    }
    return x;
}
