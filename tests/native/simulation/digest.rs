//! `digests.txt`: what every engine must reproduce, one line per mesh.

use super::Simulation;
use edgeflip::{Reason, Reasons};
use std::fmt;
use std::path::PathBuf;

/// FNV-1a with 64 bits over the little-endian bytes of the words so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(u64);

impl Default for Digest {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Digest {
    /// Feed the input's triangles first, then those after each iteration.
    pub fn feed(&mut self, triangles: &[u32]) {
        for byte in triangles.iter().flat_map(|word| word.to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{:016x}", self.0)
    }
}

/// A line of `digests.txt`: what a run of the named mesh must give.
#[derive(Clone, Debug, PartialEq)]
pub struct Expected {
    pub name: String,
    pub beta: f64,
    pub iterations: usize,
    pub flips: u64,
    /// Sum over the iterations.
    pub labelled: u64,
    pub remaining: Reasons,
    pub digest: Digest,
}

impl Expected {
    /// First line of the file.
    pub const HEADER: &str = "# mesh, beta, iterations, flips, labelled edges, left, FNV-1a of all triangles";

    pub fn new(name: &str, beta: f64, run: &Simulation) -> Self {
        Self {
            name: name.into(),
            beta,
            iterations: run.iterations.len(),
            flips: run.flips(),
            labelled: run.labelled(),
            remaining: run.remaining,
            digest: run.digest,
        }
    }

    fn parse(line: &str) -> Option<Self> {
        let mut words = line.split_whitespace();
        let mut word = || words.next();
        Some(Self {
            name: word()?.into(),
            beta: word()?.parse().ok()?,
            iterations: word()?.parse().ok()?,
            flips: word()?.parse().ok()?,
            labelled: word()?.parse().ok()?,
            remaining: parse_reasons(word()?)?,
            digest: Digest(u64::from_str_radix(word()?, 16).ok()?),
        })
    }
}

/// `angle=3,fold=1`, or `-` for none.
fn parse_reasons(text: &str) -> Option<Reasons> {
    let mut reasons = Reasons::default();
    for entry in text.split(',').filter(|&entry| entry != "-") {
        let (name, edges) = entry.split_once('=')?;
        let reason = Reason::ALL.into_iter().find(|reason| reason.name() == name)?;
        reasons[reason] = edges.parse().ok()?;
    }
    Some(reasons)
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let reasons: Vec<_> = self.remaining.iter().map(|(r, n)| format!("{}={n}", r.name())).collect();
        let reasons = if reasons.is_empty() { "-".into() } else { reasons.join(",") };
        let Self { name, beta, iterations, flips, labelled, digest, .. } = self;
        write!(f, "{name:28} {beta:>3} {iterations:>5} {flips:>7} {labelled:>8} {reasons:32} {digest}")
    }
}

/// The path of `digests.txt`.
pub fn digests_path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/digests.txt")
}

/// All lines of `digests.txt`, in the order of `meshes::all()`.
#[allow(clippy::panic, reason = "a file that cannot be read must stop the test")]
pub fn expected() -> Vec<Expected> {
    let lines = include_str!("../../digests.txt").lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| Expected::parse(line).unwrap_or_else(|| panic!("digests.txt: {line}"))).collect()
}
