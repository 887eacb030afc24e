//! What happens at a signal that ends the program: no temporary file stays.
#![expect(unsafe_code, reason = "how a signal is handled can only be asked for by a call of C")]

use edgeflip::io::remove_temporary_files;
use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXFSZ};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;
use std::ffi::c_int;
use std::mem::MaybeUninit;
use std::ptr;
use std::sync::{Arc, Mutex, OnceLock};
use std::thread;

/// Bytes of the stack of the thread that waits for signals.
const STACK: usize = 1 << 17;

/// From now on each of these signals removes the temporary files, and then ends the program as it always does, so that
/// a shell sees it. Those that are ignored, as SIGHUP is by nohup, stay so. A file that becomes larger than it may be is an
/// error of writing instead of a signal.
pub fn watch() {
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let watched: Vec<c_int> =
        [SIGINT, SIGTERM, SIGQUIT, SIGHUP].into_iter().filter(|&signal| !is_ignored(signal)).collect();
    let place = Arc::new(OnceLock::<Mutex<Signals>>::new());
    let theirs = place.clone();
    let thread = thread::Builder::new().stack_size(STACK).spawn(move || {
        // It allocates nothing: for the first allocation of a thread glibc sets 64 MiB of addresses aside.
        let Ok(mut signals) = theirs.wait().lock() else { return };
        for signal in signals.forever() {
            remove_temporary_files();
            let _ = emulate_default_handler(signal);
        }
    });
    // Where no thread can be had, or no handler, the signals do what they did.
    if thread.is_ok()
        && let Ok(signals) = Signals::new(watched)
    {
        let _ = place.set(Mutex::new(signals));
    }
}

fn is_ignored(signal: c_int) -> bool {
    let mut action = MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: without a new action the call changes nothing but what it writes to the place that it is given.
    let answer = unsafe { libc::sigaction(signal, ptr::null(), action.as_mut_ptr()) };
    // SAFETY: it has written there if it has not failed.
    answer == 0 && unsafe { action.assume_init() }.sa_sigaction == libc::SIG_IGN
}
