//! Angles, their histogram and other measures, and the audit: an independent check of a result.

mod angles;
mod audit;
mod audit_exact;
mod edges;
mod measures;
mod paths;
mod surface;

pub use angles::{AngleHistogram, Angles, angles};
pub use audit::{Audit, MAX_LISTED, Violation, audit};
pub use measures::{Measures, distance, measures, moved};
pub use surface::RemainingEdge;
