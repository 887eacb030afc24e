//! Failures: the exit status and the message of a program that ends without a result.

use edgeflip::Error;
use std::path::Path;

/// Why the program ends without a result: the exit status and one line for standard error.
pub struct Failure {
    pub status: u8,
    pub line: String,
}

impl Failure {
    /// The failure for an error with `path`. An error that has its own path, or none, is not prefixed with `path`.
    pub fn of(path: &Path, error: &Error) -> Self {
        let line = match error {
            &Error::FileTooLarge { limit, .. } => {
                let error = Error::FileTooLarge { limit, option: "--max-bytes" };
                format!("{}: {error}", path.display())
            }
            Error::Io { .. }
            | Error::UnknownFormat { .. }
            | Error::Option { .. }
            | Error::BackendUnavailable { .. }
            | Error::Device { .. } => error.to_string(),
            _ => format!("{}: {error}", path.display()),
        };
        let status = match error {
            // The range was checked, so the system could not start the threads.
            Error::Option { option: "threads", .. } => 1,
            Error::Option { .. } => 2,
            Error::BackendUnavailable { .. } | Error::BackendLimit { .. } | Error::Device { .. } => 3,
            _ => 1,
        };
        Self { status, line }
    }
}
