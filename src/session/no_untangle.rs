//! The modules of the npm package leave the repair out: it would take more than a tenth of the module of the engines, so it
//! belongs into a module of its own.

use crate::{Error, Mesh, Options};
use std::sync::Arc;

/// Nothing is lost where nothing is untangled.
#[derive(Default)]
pub(super) struct Held {
    pub(super) lost: Vec<[u32; 2]>,
}

pub(super) fn at_start(_mesh: &mut Arc<Mesh>, _options: &mut Options) -> Result<Held, Error> {
    Ok(Held::default())
}
