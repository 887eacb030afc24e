//! A device that a native program has made.

/// A device of the caller, with its instance and its queue. Sessions that share it also share its kernels. The session
/// reads no setting of the device but its limits, and changes none: the handlers of errors and of a lost device stay those
/// of the caller.
#[derive(Clone, Debug, PartialEq)]
pub struct GpuDevice {
    /// The instance that it is of. wgpu tells devices of one instance apart, but not those of two.
    pub instance: wgpu::Instance,
    /// The device. It needs at least the default limits of WebGPU.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// What its adapter tells of itself: [`wgpu::Adapter::get_info`].
    pub adapter: wgpu::AdapterInfo,
}

impl GpuDevice {
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

/// The name of an adapter, and its driver.
pub(super) fn name_of(info: &wgpu::AdapterInfo) -> String {
    let driver = [info.driver.as_str(), &info.driver_info].join(" ");
    let driver = driver.trim();
    if driver.is_empty() { info.name.clone() } else { format!("{}, {driver}", info.name) }
}
