//! Angles, their histogram and other measures, and the audit: an independent check of a result.

mod angles;
mod audit;
mod audit_exact;
mod components;
mod edges;
mod measures;
mod paths;
mod problems;
mod surface;

pub use angles::{AngleHistogram, Angles, angles};
#[cfg(all(target_arch = "wasm32", feature = "js-audit"))]
pub(crate) use audit::audit_named;
pub use audit::{Audit, MAX_LISTED, Violation, audit, audit_outcome};
pub use measures::{Measures, distance, measures, moved};
#[cfg(all(target_arch = "wasm32", feature = "js-audit"))]
pub(crate) use paths::Named;
pub use problems::{Problems, problems};
pub use surface::RemainingEdge;
