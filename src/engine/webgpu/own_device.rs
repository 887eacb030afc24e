//! A device that a native program has made.

/// A device of the caller, with its queue. Sessions that share it also share its kernels. The session reads no setting of
/// the device but its limits, and changes none: the handlers of errors and of a lost device stay those of the caller.
#[derive(Clone, Debug, PartialEq)]
pub struct GpuDevice {
    /// The device. It needs at least the default limits of WebGPU.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// What its adapter tells of itself: [`wgpu::Adapter::get_info`].
    pub adapter: wgpu::AdapterInfo,
}

impl GpuDevice {
    pub(super) fn is_of(&self, device: &wgpu::Device) -> bool {
        self.device == *device
    }

    pub(super) fn is_software(&self) -> bool {
        self.adapter.device_type == wgpu::DeviceType::Cpu
    }

    /// Calls to a lost device tell of the loss themselves.
    pub(super) async fn loss(&self) -> Option<String> {
        None
    }

    pub(super) async fn adopt(&self) -> Result<(wgpu::Device, wgpu::Queue), String> {
        Ok((self.device.clone(), self.queue.clone()))
    }

    pub(super) fn adapter_name(&self) -> String {
        name_of(&self.adapter)
    }
}

/// What a program needs to write the positions on the GPU, and to draw from the buffers. See
/// [`Session::gpu`](crate::Session::gpu).
#[derive(Clone, Debug, PartialEq)]
pub struct GpuBuffers {
    /// The device of the session.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// f32, 2 or 3 per vertex, without gaps. Its usage includes `STORAGE`, `VERTEX`, `COPY_SRC` and `COPY_DST`.
    pub positions: wgpu::Buffer,
    /// u32, 3 per triangle. Its usage includes `STORAGE`, `INDEX`, `COPY_SRC` and `COPY_DST`. Only read it.
    pub triangles: wgpu::Buffer,
}

/// The name of an adapter, and its driver.
pub(super) fn name_of(info: &wgpu::AdapterInfo) -> String {
    let driver = [info.driver.as_str(), &info.driver_info].join(" ");
    let driver = driver.trim();
    if driver.is_empty() { info.name.clone() } else { format!("{}, {driver}", info.name) }
}
