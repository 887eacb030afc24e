//! Failures: the exit status and the message of a program that ends without a result.

use crate::args::Args;
use edgeflip::Error;
use std::path::Path;

/// Why the program ends without a result: the exit status and one line for standard error.
pub struct Failure {
    pub status: u8,
    pub line: String,
}

/// What messages about files end with, and the same with a flag.
const ENDS: [[&str; 2]; 4] = [
    ["external_files allows it", "--external-files allows it"],
    ["max_bytes sets the limit", "--max-bytes sets the limit"],
    ["a terrain needs plane", "a terrain needs --plane"],
    ["untangle may mend that", "--untangle may mend that"],
];

impl Failure {
    /// The failure for an error of a run with these options.
    pub fn of_run(args: &Args, error: &Error) -> Self {
        let Error::Option { option, message } = error else { return Self::of(&args.input, error) };
        if let Some(list) = args.list(option) {
            return Self { status: 1, line: format!("{}: {}", list.display(), with_flag(message)) };
        }
        // The number of threads was checked, so the system could not start them.
        let status = if *option == "threads" { 1 } else { 2 };
        let flag = match *option {
            "ignore_attributes" => "ignore-attribute".to_owned(),
            option => option.replace('_', "-"),
        };
        Self { status, line: format!("option --{flag}: {message}") }
    }

    /// The failure for an error with `path`. An error that has its own path, or none, is not prefixed with `path`.
    pub fn of(path: &Path, error: &Error) -> Self {
        let line = match error {
            &Error::FileTooLarge { limit, .. } => {
                let error = Error::FileTooLarge { limit, option: "--max-bytes" };
                format!("{}: {error}", path.display())
            }
            Error::Parse { place, message } => {
                format!("{}: {place}: {}", path.display(), with_flag(message))
            }
            Error::Io { .. }
            | Error::UnknownFormat { .. }
            | Error::BackendUnavailable { .. }
            | Error::Device { .. } => error.to_string(),
            _ => format!("{}: {error}", path.display()),
        };
        let status = match error {
            Error::BackendUnavailable { .. } | Error::BackendLimit { .. } | Error::Device { .. } => 3,
            _ => 1,
        };
        Self { status, line }
    }
}

/// A message of the library whose end names the flag instead of the option.
fn with_flag(message: &str) -> String {
    let end = ENDS.iter().find_map(|[end, flag]| Some((message.strip_suffix(end)?, *flag)));
    let (start, end) = end.unwrap_or((message, ""));
    format!("{start}{end}")
}
