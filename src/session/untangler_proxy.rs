//! The repair of triangles that have turned over is in a module of its own, which is loaded when a mesh needs it: a call
//! that needs it fails and changes nothing, and `src/js/untangle.ts` loads the module and calls again. This calls the
//! exports of `src/wasm/untangle.rs`.

use super::repaired::Repaired;
use crate::mesh::areas::Areas;
use crate::mesh::winding::Outline;
use crate::system::threads::Threads;
use crate::{Error, Mesh, Positions};
use js_sys::Object;
use std::cell::RefCell;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// Keeps a `JsUntangler` for each key, as long as the key is in use.
    #[wasm_bindgen(typescript_type = "import('../untangler.js').UntangleModule")]
    pub type UntangleModule;
    #[wasm_bindgen(method, catch)]
    fn repaired(
        this: &UntangleModule,
        key: &Object,
        singles: &[f32],
        doubles: &[f64],
        triangles: &[u32],
        twins: &[u32],
        locked_edges: &[u32],
        locks: usize,
        lost: &[u32],
    ) -> Result<Vec<u32>, JsValue>;
}

thread_local! {
    static MODULE: RefCell<Option<UntangleModule>> = const { RefCell::new(None) };
}

/// Sets the module.
pub(crate) fn set_untangler(module: UntangleModule) {
    MODULE.set(Some(module));
}

/// Repairs a mesh in the plane whose boundary and components stay.
#[derive(Default)]
pub(super) struct Untangler {
    key: Object,
}

impl Untangler {
    /// Whether a mesh with these twins, and `lost` locked edges, may need other triangles. Then this is ready for them.
    ///
    /// # Errors
    /// [`Error::Thrown`] if the module is missing: `src/js/untangle.ts` knows the exception.
    pub(super) fn is_needed(&self, mesh: &Mesh, twins: &[u32], lost: usize) -> Result<bool, Error> {
        if MODULE.with_borrow(Option::is_some) {
            return Ok(true);
        }
        // Components of both orientations look tangled. They do not need the module.
        let winding = Outline::new(mesh.triangles(), twins).winding(mesh);
        let triangles = (mesh.dimension(), mesh.positions(), mesh.triangles());
        if lost == 0 && Areas::of(triangles, &winding, false, &Threads::one()) == Areas::default() {
            return Ok(false);
        }
        Err(Error::Thrown { exception: "untangler".into() })
    }

    /// As the function of the other module; after [`Untangler::is_needed`].
    ///
    /// # Errors
    /// [`Error::Thrown`] if the module fails.
    pub(super) fn repaired(
        &mut self,
        mesh: &Mesh,
        twins: &[u32],
        (locked_edges, locks): (&[[u32; 2]], usize),
        lost: &[[u32; 2]],
    ) -> Result<Option<Repaired>, Error> {
        let triangles = mesh.triangles();
        let (singles, doubles): (&[f32], &[f64]) = match mesh.positions() {
            Positions::F32(numbers) => (numbers, &[]),
            Positions::F64(numbers) => (&[], numbers),
        };
        let (locked_edges, lost) = (locked_edges.as_flattened(), lost.as_flattened());
        let words = MODULE.with_borrow(|module| match module {
            Some(module) => {
                module.repaired(&self.key, singles, doubles, triangles, twins, locked_edges, locks, lost)
            }
            None => Ok(Vec::new()),
        });
        let words = words.map_err(|exception| Error::Thrown { exception })?;
        Ok(Repaired::of_words(words))
    }
}
