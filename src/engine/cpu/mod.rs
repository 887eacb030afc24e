//! The CPU engine: the fast form of the phases, and Lawson's algorithm, which flips one edge after another.

mod lawson;
mod phases;
mod region;

pub(crate) use lawson::Lawson;
pub(crate) use phases::Cpu;
