//! The self-test: an engine has to flip a small mesh as the CPU does, before it gets other meshes.

use super::upload::{Form, Upload};
use crate::engine::{Answer, Cpu, Engine};
use crate::mesh::Mesh;
use crate::phases::Thresholds;
use crate::system::threads::Threads;
use crate::{EngineKind, Error, Positions, cos_degrees};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Vertices along a side of the test mesh.
const SIDE: u16 = 9;

/// The limit for the deviation in the test mesh.
const DEVIATION: f32 = 0.005;

/// The forms of meshes for which a device has passed the self-test.
#[derive(Default)]
pub(crate) struct Tested([AtomicBool; Form::COUNT]);

impl Tested {
    pub(crate) fn has_passed(&self, form: Form) -> bool {
        self.0[form.index()].load(Ordering::Relaxed)
    }
}

/// Makes an engine for a mesh.
pub(crate) type Make<'a> = dyn Fn(Upload) -> Answer<'static, Box<dyn Engine>> + 'a;

/// Runs the test mesh on an engine from `make`, and compares the counts, the flips of each iteration and the triangles
/// with those of the CPU. Does nothing if the device has passed the self-test for this form.
///
/// # Errors
/// [`Error::BackendUnavailable`] if they differ; those of `make` and of the engine.
pub(crate) async fn self_test(
    tested: &Tested,
    backend: EngineKind,
    form: Form,
    make: &Make<'_>,
) -> Result<(), Error> {
    if tested.has_passed(form) {
        return Ok(());
    }
    let mesh = Arc::new(test_mesh(form)?);
    let thresholds = thresholds(form);
    let mut engine = make(Upload::new(backend, mesh.clone(), thresholds)?).await?;
    let mut cpu = Cpu::new(mesh, thresholds, Threads::default());
    let is_counted = engine.census().await? == cpu.count();
    let is_same = is_counted
        && engine.iterate(u32::MAX).await? == cpu.iterate(u32::MAX).await?
        && engine.triangles().await? == cpu.triangles
        && engine.census().await? == cpu.count();
    if !is_same {
        let message = "it failed its self-test: its flips differ from those of the cpu".to_owned();
        return Err(Error::BackendUnavailable { backend, message });
    }
    tested.0[form.index()].store(true, Ordering::Relaxed);
    Ok(())
}

/// With these thresholds the test mesh has both labelled and blocked edges.
fn thresholds(form: Form) -> Thresholds {
    let mut thresholds = Thresholds { cos: cos_degrees(20.0), ..Thresholds::default() };
    if form.has_deviation {
        thresholds.deviation = DEVIATION;
    }
    thresholds
}

/// A turned lattice, whose nearly cocircular squares need exact arithmetic: right angles along the axes would not. Its
/// upper half is sheared, so that edges there have to flip. In space, the lattice also has a step.
fn test_mesh(form: Form) -> Result<Mesh, Error> {
    let (mut doubles, mut triangles) = (Vec::new(), Vec::new());
    for vertex in 0..SIDE * SIDE {
        let (i, j) = (vertex % SIDE, vertex / SIDE);
        let (x, y) = (f64::from(i), f64::from(j));
        let shear = (y - f64::from(SIDE / 2)).max(0.0);
        let step = if i > 5 { 0.02 * x * y } else { 0.0 };
        let along = x + 3.7 * shear;
        let point = [0.09 * along - 0.04 * y, 0.04 * along + 0.09 * y, step];
        doubles.extend_from_slice(&point[..form.dimension.stride()]);
        if i + 1 < SIDE && j + 1 < SIDE {
            let [p, q, r, s] = [0, 1, SIDE + 1, SIDE].map(|step| u32::from(vertex + step));
            triangles.extend_from_slice(&[p, q, r, p, r, s]);
        }
    }
    let positions = Positions::F64(doubles);
    let positions = if form.is_fixed { positions } else { positions.to_f32().into() };
    Mesh::new(form.dimension, positions, triangles)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "what fails here is a failed test")]

    use super::*;
    use crate::{Dimension, Reason};
    use pollster::block_on;

    fn made(cpu: Cpu) -> Answer<'static, Box<dyn Engine>> {
        Box::pin(std::future::ready(Ok(Box::new(cpu) as Box<dyn Engine>)))
    }

    #[test]
    fn the_mesh_flips_in_several_iterations_and_has_ties_and_blocked_edges() {
        for form in Form::ALL {
            let upload =
                Upload::new(EngineKind::Gpu, Arc::new(test_mesh(form).unwrap()), thresholds(form)).unwrap();
            assert!(upload.form() == form);
            let mut cpu = Cpu::new(upload.mesh, upload.thresholds, Threads::default());
            assert!(block_on(cpu.iterate(u32::MAX)).unwrap().len() > 2);
            let blocked = cpu.count().blocked;
            assert_eq!(blocked[Reason::Angle] > 0, form.dimension == Dimension::Three);
            assert_eq!(blocked[Reason::Deviation] > 0, form.has_deviation);
        }
    }

    #[test]
    fn an_engine_passes_once_or_is_refused() {
        let tested = Tested::default();
        for form in Form::ALL {
            let right = |upload: Upload| made(Cpu::new(upload.mesh, upload.thresholds, Threads::default()));
            let wrong = |upload: Upload| {
                let mesh = upload.mesh;
                let upright = mesh.positions().to_f32();
                let leaning = upright
                    .chunks(form.dimension.stride())
                    .flat_map(|p| [&[p[0] + p[1]], &p[1..]].concat())
                    .collect::<Vec<f32>>();
                let sheared = Mesh::new(form.dimension, leaning, mesh.triangles().to_vec()).unwrap();
                made(Cpu::new(Arc::new(sheared), upload.thresholds, Threads::default()))
            };
            let refused = block_on(self_test(&tested, EngineKind::Gpu, form, &wrong));
            assert!(matches!(refused, Err(Error::BackendUnavailable { backend: EngineKind::Gpu, .. })));
            block_on(self_test(&tested, EngineKind::Gpu, form, &right)).unwrap();
            // A device that has passed is not tested again.
            block_on(self_test(&tested, EngineKind::Gpu, form, &wrong)).unwrap();
        }
    }
}
