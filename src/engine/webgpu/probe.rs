//! Tests whether a device ends loops too early.

use super::copies::Source;
use super::device::Device;
use super::kernels::Kernels;
use crate::Error;
use crate::engine::gpu::probe::ends_loops_early;
use wgpu::BufferUsages;

impl Device {
    /// Runs `shaders/webgpu/probe.wgsl` and compares its result.
    pub(super) async fn probe_loops(&self, probe: &Kernels) -> Result<bool, Error> {
        let buffer = self.checked(|| self.buffer("probe", 1, BufferUsages::STORAGE)).await?;
        let record = || {
            let bindings = self.bind(&probe.layout, &[(&buffer, None)]);
            let mut encoder = self.device.create_command_encoder(&Default::default());
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&probe.pipelines[0]);
            pass.set_bind_group(0, &bindings, &[]);
            pass.dispatch_workgroups(1, 1, 1);
            drop(pass);
            encoder
        };
        let found = self.submit_and_read(&record, &[Source::new(&buffer, 1)]).await?;
        Ok(ends_loops_early(found.words(0)?[0]))
    }
}
