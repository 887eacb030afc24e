//! The CPU engine: the phases in their fast form, and Lawson's algorithm, which flips one edge after another.

mod lawson;
mod phases;
mod region;

pub(crate) use lawson::Lawson;
pub(crate) use phases::Cpu;
