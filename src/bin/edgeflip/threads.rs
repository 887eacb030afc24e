//! How many threads the process has.
#![expect(unsafe_code, reason = "rayon reads the number from the environment when it starts its threads")]

use std::env;
use std::num::NonZeroUsize;

/// What is not done by the threads of a session is done by so many too. Before there are any.
pub fn limit(count: Option<NonZeroUsize>) {
    if let Some(count) = count {
        // SAFETY: there is no other thread that could read the environment.
        unsafe { env::set_var("RAYON_NUM_THREADS", count.to_string()) };
    }
}
