//! Ends the program when memory runs out: with one line on standard error, without temporary files, and with status 1.
//!
//! When an allocation fails, in any dependency or thread, Rust would end the process by SIGABRT. This allocator ends it
//! first. So no allocation ever returns an error, and no destructor runs: temporary files are kept in a list.
#![expect(unsafe_code, reason = "the trait for allocators is unsafe; each function hands its arguments on")]

use crate::errors;
use edgeflip::io::remove_temporary_files;
use std::alloc::{GlobalAlloc, Layout, System};
use std::fmt::Arguments;
use std::io::{Cursor, Write};
use std::panic;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

#[global_allocator]
static ALLOCATOR: Allocator = Allocator;

/// How long a thread may take to end the process.
const PATIENCE: Duration = Duration::from_secs(5);

/// The start of the line.
static START: OnceLock<String> = OnceLock::new();

/// The system's allocator. A failed allocation ends the process.
struct Allocator;

// SAFETY: the system's allocator keeps the contract, and a null pointer is never returned.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller keeps the contract of this function, which is the same.
        checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        checked(unsafe { System.realloc(pointer, layout, size) }, size)
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }
}

fn checked(pointer: *mut u8, bytes: usize) -> *mut u8 {
    if pointer.is_null() {
        ran_out(format_args!("{bytes} more bytes are not available"));
    }
    if bytes >= LARGE {
        in_large_pages(pointer, bytes);
    }
    pointer
}

/// Bytes of a large page, and of the smallest allocation that uses them.
const PAGE: usize = 1 << 21;
const LARGE: usize = 4 * PAGE;

/// Requests large pages for an allocation: the first access to many small pages takes long.
#[cfg(target_os = "linux")]
fn in_large_pages(pointer: *mut u8, bytes: usize) {
    let before = pointer.addr().next_multiple_of(PAGE) - pointer.addr();
    // SAFETY: these pages are inside the allocation, and the call keeps their content.
    unsafe { libc::madvise(pointer.add(before).cast(), (bytes - before) / PAGE * PAGE, libc::MADV_HUGEPAGE) };
}

#[cfg(not(target_os = "linux"))]
fn in_large_pages(_: *mut u8, _: usize) {}

/// Sets the start of the line, which names the input file. Call it before any thread starts.
pub fn prepare(input: &str) {
    let _ = START.set(format!("edgeflip: {input}: "));
    // Rust panics, and then ends the process, if a new thread gets no memory for its signal handlers.
    let hook = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if info.location().is_some_and(|location| location.file().ends_with("stack_overflow.rs")) {
            ran_out(format_args!("a new thread got no stack"));
        }
        hook(info);
    }));
    #[cfg(all(target_os = "linux", target_env = "gnu"))]
    if limit().is_some() {
        // Each thread would reserve 64 MiB of addresses.
        // SAFETY: the call changes a setting of the allocator.
        unsafe { libc::mallopt(libc::M_ARENA_MAX, 1) };
    }
}

/// Ends the process, without an allocation and without destructors.
#[cold]
fn ran_out(what: Arguments) -> ! {
    static IS_ENDING: AtomicBool = AtomicBool::new(false);
    if IS_ENDING.swap(true, Ordering::Relaxed) {
        // The process is ending already, mostly in another thread. If this thread has come here twice, it waits in vain
        // and then ends the process.
        thread::sleep(PATIENCE);
        end(1);
    }
    remove_temporary_files();
    let mut line = Cursor::new([0; 128]);
    let _ = writeln!(line, "memory ran out: {what}");
    let length = line.position() as usize;
    errors::say(START.get().map_or(b"edgeflip: ", |start| start.as_bytes()));
    errors::say(&line.get_ref()[..length]);
    end(1)
}

/// Ends the process at once, without waiting for other code in it, such as a GPU driver that is starting.
#[cfg(unix)]
pub fn end(status: u8) -> ! {
    signal_hook::low_level::exit(status.into())
}

#[cfg(not(unix))]
pub fn end(status: u8) -> ! {
    std::process::exit(status.into())
}

/// The limit of the process's address space in bytes, if there is one.
#[cfg(target_os = "linux")]
pub fn limit() -> Option<u64> {
    rustix::process::getrlimit(rustix::process::Resource::As).current
}

/// Other systems do not enforce a limit of the address space.
#[cfg(not(target_os = "linux"))]
pub fn limit() -> Option<u64> {
    None
}

/// Bytes of addresses that a GPU driver may need before it has a mesh, and for each triangle, in buffers and staging
/// buffers. A driver without enough memory may end the process: Mesa's software driver did with up to 910 MB left.
#[cfg(target_os = "linux")]
const DRIVER: u64 = 1 << 30;
#[cfg(target_os = "linux")]
const TRIANGLE: u64 = 128;

/// Why not to use a GPU: its driver might get too little memory.
#[cfg(target_os = "linux")]
pub fn too_little_for_a_driver(triangles: usize) -> Option<String> {
    let limit = limit()?;
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let taken = status.lines().find_map(|line| line.strip_prefix("VmSize:")?.trim().strip_suffix(" kB"))?;
    let left = limit.saturating_sub(1024 * taken.parse::<u64>().ok()?);
    let wanted = DRIVER + TRIANGLE * triangles as u64;
    (left < wanted).then(|| {
        format!("a GPU driver may need {wanted} bytes, and the limit of memory (ulimit -v) leaves {left}")
    })
}

#[cfg(not(target_os = "linux"))]
pub fn too_little_for_a_driver(_: usize) -> Option<String> {
    None
}
