//! The CPU engine: the fast form of the phases, and Lawson's algorithm, which flips one edge after another.

mod answers;
mod engine;
mod lawson;
mod motion;
mod moving;
mod region;
#[cfg(test)]
mod tests;

pub(crate) use engine::Cpu;
pub(crate) use lawson::Lawson;
