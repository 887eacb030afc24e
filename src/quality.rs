//! Angles, their histogram, and the audit: an independent check of a result.
