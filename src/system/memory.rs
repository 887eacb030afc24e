//! Asks whether there is memory before it is needed: where a run finds that there is none, it can tell nobody. What is
//! asked for is not kept, so others may take it in between.

use crate::Error;
use std::hint::black_box;

/// An array has fewer bytes than half of the addresses, so memory is asked for in pieces.
const PIECE: u64 = isize::MAX as u64 / 2 + 1;

/// What WebAssembly with 32-bit addresses can have.
pub(crate) const LIMIT: Option<u64> = if cfg!(target_pointer_width = "32") { Some(1 << 32) } else { None };

/// Refuses to begin what takes up to so many bytes, where there are not so many now.
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
        // The compiler leaves out memory that nobody uses.
        pieces.push(black_box(piece));
        left -= size;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_nobody_has_is_refused() {
        assert!(check(0).is_ok() && check(1000).is_ok());
        let error = check(1 << 60).unwrap_err();
        assert!(matches!(error, Error::OutOfMemory { bytes, limit: None } if bytes == 1 << 60), "{error}");
    }
}
