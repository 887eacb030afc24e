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
    if bytes >= LARGE {
        in_large_pages(place, bytes);
    }
    place
}

/// Bytes of a large page, and of what is worth asking for them.
const PAGE: usize = 1 << 21;
const LARGE: usize = 4 * PAGE;

/// Asks for large pages, where the system gives them to those who ask: many small ones take long to be touched first.
#[cfg(target_os = "linux")]
fn in_large_pages(place: *mut u8, bytes: usize) {
    let before = place.addr().next_multiple_of(PAGE) - place.addr();
    // SAFETY: these pages are parts of the allocation, and what is in them stays.
    unsafe { libc::madvise(place.add(before).cast(), (bytes - before) / PAGE * PAGE, libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn in_large_pages(_: *mut u8, _: usize) {}

/// Gives the line its beginning, which names the file that is read. Before there are threads.
pub fn prepare(input: &str) {
    let _ = START.set(format!("edgeflip: {input}: "));
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    if limit().is_some() {
        // Each thread would set 64 MiB of addresses aside.
        // SAFETY: the call changes a setting of the allocator.
        unsafe { libc::mallopt(libc::M_ARENA_MAX, 1) };
    }
}

/// Ends the process, without an allocation and without destructors.
#[cold]
fn ran_out(bytes: usize) -> ! {
    static IS_ENDING: AtomicBool = AtomicBool::new(false);
    if IS_ENDING.swap(true, Ordering::Relaxed) {
        // Another thread ends it, unless it is this one, here for the second time.
        thread::sleep(PATIENCE);
        end(1);
    }
    remove_temporary_files();
    let mut line = Cursor::new([0; 128]);
    let _ = writeln!(line, "memory ran out: {bytes} more bytes could not be had");
    let length = line.position() as usize;
    errors::say(START.get().map_or(b"edgeflip: ", |start| start.as_bytes()));
    errors::say(&line.get_ref()[..length]);
    end(1)
}

/// Ends the process at once: what else runs in it, such as the driver of a GPU that begins, is not waited for.
#[cfg(unix)]
pub fn end(status: u8) -> ! {
    signal_hook::low_level::exit(status.into())
}

#[cfg(not(unix))]
pub fn end(status: u8) -> ! {
    std::process::exit(status.into())
}

/// Bytes of addresses that the process may have, if that is limited.
#[cfg(target_os = "linux")]
pub fn limit() -> Option<u64> {
    rustix::process::getrlimit(rustix::process::Resource::As).current
}

/// Other systems do not keep to a limit of addresses.
#[cfg(not(target_os = "linux"))]
pub fn limit() -> Option<u64> {
    None
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
    let limit = limit()?;
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

#[cfg(not(target_os = "linux"))]
pub fn too_little_for_a_driver(_: usize) -> Option<String> {
    None
}
