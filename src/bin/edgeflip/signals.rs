//! Removes temporary files when a signal ends the program.
#![expect(unsafe_code, reason = "only a C call tells how a signal is handled")]

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

/// From now on, each of these signals removes the temporary files and then ends the program by the same signal, so that
/// a shell sees it. Signals that are ignored, such as SIGHUP under nohup, stay ignored. A file that exceeds the size
/// limit causes a write error instead of a signal.
pub fn watch() {
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let watched: Vec<c_int> =
        [SIGINT, SIGTERM, SIGQUIT, SIGHUP].into_iter().filter(|&signal| !is_ignored(signal)).collect();
    let slot = Arc::new(OnceLock::<Mutex<Signals>>::new());
    let slot_of_thread = slot.clone();
    let thread = thread::Builder::new().stack_size(STACK).spawn(move || {
        // This thread does not allocate: for its first allocation, glibc would reserve 64 MiB of addresses.
        let Ok(mut signals) = slot_of_thread.wait().lock() else { return };
        for signal in signals.forever() {
            remove_temporary_files();
            let _ = emulate_default_handler(signal);
        }
    });
    // Without a thread or a handler, the signals keep their default effect.
    if thread.is_ok()
        && let Ok(signals) = Signals::new(watched)
    {
        let _ = slot.set(Mutex::new(signals));
    }
}

fn is_ignored(signal: c_int) -> bool {
    let mut action = MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: without a new action, the call only writes to the pointer that it gets.
    let answer = unsafe { libc::sigaction(signal, ptr::null(), action.as_mut_ptr()) };
    // SAFETY: the call has written the action if it has not failed.
    answer == 0 && unsafe { action.assume_init() }.sa_sigaction == libc::SIG_IGN
}
