//! What both GPU engines share: the upload, the self-test, and the probe for drivers that end loops too early.

pub(super) mod cosine;
pub(super) mod probe;
pub(super) mod self_test;
pub(super) mod upload;

pub(crate) use self_test::self_test;
pub(crate) use upload::{Form, Upload};
