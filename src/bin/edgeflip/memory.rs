//! What happens where memory runs out: one line says so, no temporary file stays, and the status is 1.
//!
//! Rust ends the process by SIGABRT where an allocation fails, in whatever dependency or thread. This allocator ends it
//! first. So no allocation of the program ever fails, and what has a destructor has to be registered elsewhere.
#![expect(unsafe_code, reason = "the trait for allocators is unsafe; each function hands its arguments on")]

use crate::errors;
use edgeflip::io::remove_temporary_files;
use std::alloc::{GlobalAlloc, Layout, System};
use std::io::{Cursor, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

/// How long a thread may take to end the process.
const PATIENCE: Duration = Duration::from_secs(5);

/// What the line begins with.
static START: OnceLock<String> = OnceLock::new();

/// The system's allocator, or the end.
struct Allocator;

// SAFETY: the system's allocator keeps the contract, and a null pointer is never handed on.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the contract of this function, which is the same.
        had(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        had(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        had(unsafe { System.realloc(place, layout, size) }, size)
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(place, layout) }
    }
}

fn had(place: *mut u8, bytes: usize) -> *mut u8 {
    if place.is_null() {
        ran_out(bytes);
    }
    place
}

/// Gives the line its beginning, which names the file that is read.
pub fn prepare(input: &str) {
    let _ = START.set(format!("edgeflip: {input}: "));
}

/// Ends the process, without an allocation and without destructors.
#[cold]
fn ran_out(bytes: usize) -> ! {
    static IS_ENDING: AtomicBool = AtomicBool::new(false);
    if IS_ENDING.swap(true, Ordering::Relaxed) {
        // Another thread ends it, unless it is this one, here for the second time.
        thread::sleep(PATIENCE);
        end();
    }
    remove_temporary_files();
    let mut line = Cursor::new([0; 128]);
    let _ = writeln!(line, "memory ran out: {bytes} more bytes could not be had");
    let length = line.position() as usize;
    errors::say(START.get().map_or(b"edgeflip: ", |start| start.as_bytes()));
    errors::say(&line.get_ref()[..length]);
    end()
}

#[cfg(unix)]
fn end() -> ! {
    signal_hook::low_level::exit(1)
}

#[cfg(not(unix))]
fn end() -> ! {
    std::process::exit(1)
}

/// Bytes of addresses that the driver of a GPU may want before there is a mesh, and for each triangle, in its buffers and
/// on the way there. Where it cannot have them it may end the process: Mesa's software driver did with up to 910 MB left.
#[cfg(target_os = "linux")]
const DRIVER: u64 = 1 << 30;
#[cfg(target_os = "linux")]
const TRIANGLE: u64 = 128;

/// Why no GPU is to be looked for: its driver might not get its memory.
#[cfg(target_os = "linux")]
pub fn too_little_for_a_driver(triangles: usize) -> Option<String> {
    use rustix::process::{Resource, getrlimit};
    let limit = getrlimit(Resource::As).current?;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let taken = status.lines().find_map(|line| line.strip_prefix("VmSize:")?.trim().strip_suffix(" kB"))?;
    let left = limit.saturating_sub(1024 * taken.parse::<u64>().ok()?);
    let wanted = DRIVER + TRIANGLE * triangles as u64;
    (left < wanted).then(|| {
        format!(
            "the driver of a GPU may need {wanted} bytes, and the limit of memory (ulimit -v) leaves {left}"
        )
    })
}

/// Other systems do not keep to a limit of addresses.
#[cfg(not(target_os = "linux"))]
pub fn too_little_for_a_driver(_: usize) -> Option<String> {
    None
}
