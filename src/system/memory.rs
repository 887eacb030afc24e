//! Checks whether memory is available before a call needs it: an allocation that fails later would end the program. The
//! check does not keep the memory, so another thread may take it.

use crate::Error;
use std::hint::black_box;

/// The check allocates in pieces, since an array has at most `isize::MAX` bytes.
const PIECE: u64 = isize::MAX as u64 / 2 + 1;

/// The limit of WebAssembly with 32-bit addresses.
pub(crate) const LIMIT: Option<u64> = if cfg!(target_pointer_width = "32") { Some(1 << 32) } else { None };

/// Fails if so many bytes are not available now.
///
/// # Errors
/// [`Error::OutOfMemory`].
pub(crate) fn check(bytes: u64) -> Result<(), Error> {
    let mut pieces = Vec::new();
    let mut left = bytes;
    while left > 0 {
        let size = left.min(PIECE);
        let mut piece = Vec::<u8>::new();
        if LIMIT.is_some_and(|limit| bytes > limit) || piece.try_reserve_exact(size as usize).is_err() {
            return Err(Error::OutOfMemory { bytes, limit: LIMIT });
        }
        // Without this, the compiler would remove the unused allocation.
        pieces.push(black_box(piece));
        left -= size;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_many_bytes_are_refused() {
        assert!(check(0).is_ok() && check(1000).is_ok());
        let error = check(1 << 60).unwrap_err();
        assert!(matches!(error, Error::OutOfMemory { bytes, limit: None } if bytes == 1 << 60), "{error}");
    }
}
