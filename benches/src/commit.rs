//! The commit of a benchmark.

use std::process::Command;

/// The commit that this program was built from, if it is known.
pub fn commit() -> String {
    let named = std::env::var("EDGEFLIP_COMMIT").ok().or(option_env!("EDGEFLIP_COMMIT").map(str::to_owned));
    let asked = || {
        let git = Command::new("git").args(["describe", "--always", "--dirty"]).output().ok()?;
        git.status.success().then(|| String::from_utf8_lossy(&git.stdout).trim().to_owned())
    };
    named.or_else(asked).unwrap_or_else(|| "unknown".to_owned())
}
