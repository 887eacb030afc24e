// Counts whether a driver runs as many rounds of a loop as the loop says. llvmpipe ends every loop of an invocation once
// 65,535 rounds have been made in all of its loops, silently; the work must then be cut into smaller pieces.

const ROUNDS: u32 = 100000u;

// The sum of no closed form that a compiler knows.
fn rounds() -> u32 {
    var x = 1u;
    for (var i = 0u; i < ROUNDS; i++) {
        x = x * 1664525u + 1013904223u;
        x ^= x >> 13u;
    }
    return x;
}
