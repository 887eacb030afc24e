//! The number of threads of the process.
#![expect(unsafe_code, reason = "rayon reads the number from the environment when it starts its threads")]

use std::env;
use std::num::NonZeroUsize;

/// Limits the threads for work outside a session. Call it before any thread starts.
pub fn limit(count: Option<NonZeroUsize>) {
    if let Some(count) = count {
        // SAFETY: there is no other thread that could read the environment.
        unsafe { env::set_var("RAYON_NUM_THREADS", count.to_string()) };
    }
}
