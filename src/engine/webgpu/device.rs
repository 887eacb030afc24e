//! The GPU: one device for all sessions, with the kernels compiled from `shaders/`.

use super::Kernel;
use crate::Error;
use std::sync::{Arc, Mutex};

/// Invocations of a workgroup of every kernel.
pub(super) const WORKGROUP_SIZE: u32 = 256;

/// The shaders of the phases, in an order in which a reader can follow them.
pub(super) const PHASES: &str = concat!(
    include_str!("../../../shaders/state.wgsl"),
    include_str!("../../../shaders/exact.wgsl"),
    include_str!("../../../shaders/plane.wgsl"),
    include_str!("../../../shaders/space.wgsl"),
    include_str!("../../../shaders/star.wgsl"),
    include_str!("../../../shaders/label.wgsl"),
    include_str!("../../../shaders/select.wgsl"),
    include_str!("../../../shaders/flip.wgsl"),
    include_str!("../../../shaders/frontier.wgsl"),
    include_str!("../../../shaders/iteration.wgsl"),
);

/// The shader that builds the adjacency.
pub(super) const ADJACENCY: &str = include_str!("../../../shaders/adjacency.wgsl");

/// The shader that finds drivers whose loops end too early.
pub(super) const PROBE: &str = include_str!("../../../shaders/probe.wgsl");

/// Workgroups that WebGPU allows in one dimension.
const MOST_WORKGROUPS: u32 = 65_535;

/// The pipelines of one shader, which share their bindings.
pub(super) struct Kernels<const N: usize> {
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) pipelines: [wgpu::ComputePipeline; N],
}

/// A buffer that is destroyed when it goes: in a browser the garbage collector would take its time.
pub(super) struct Buffer(wgpu::Buffer);

impl std::ops::Deref for Buffer {
    type Target = wgpu::Buffer;
    fn deref(&self) -> &wgpu::Buffer {
        &self.0
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        self.0.destroy();
    }
}

/// A device and what was compiled for it.
pub(crate) struct Device {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) adapter: String,
    /// As many workgroups as keep the device busy; every kernel strides over what is left.
    most_workgroups: u32,
    /// See `shaders/probe.wgsl`.
    pub(super) ends_loops_early: bool,
    /// Whether the processor plays the GPU, which is slower than the CPU engine.
    pub(crate) is_software: bool,
    failure: Arc<Mutex<Option<String>>>,
    /// count, allocate, scatter, match_twins, count_corners, count_fans.
    pub(super) adjacency: Kernels<6>,
    /// In the order of [`Kernel::ALL`].
    pub(super) phases: Kernels<6>,
}

#[cfg(not(target_arch = "wasm32"))]
static SHARED: Mutex<Option<Handle>> = Mutex::new(None);

/// Sessions share a device, and on a computer threads do.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) type Handle = Arc<Device>;

#[cfg(target_arch = "wasm32")]
thread_local! {
    static SHARED: Mutex<Option<Handle>> = const { Mutex::new(None) };
}

/// In a browser a device belongs to its thread.
#[cfg(target_arch = "wasm32")]
pub(crate) type Handle = std::rc::Rc<Device>;

/// Calls `f` with the place of the shared device.
fn with_shared<T>(f: impl FnOnce(&mut Option<Handle>) -> T) -> T {
    let locked = |shared: &Mutex<Option<Handle>>| {
        f(&mut shared.lock().unwrap_or_else(|poisoned| poisoned.into_inner()))
    };
    #[cfg(not(target_arch = "wasm32"))]
    return locked(&SHARED);
    #[cfg(target_arch = "wasm32")]
    return SHARED.with(locked);
}

impl Device {
    /// The shared device; opened at the first call, and again after a failure.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] where there is none or its compiler refuses the kernels.
    pub(crate) async fn shared() -> Result<Handle, Error> {
        let shared = with_shared(|shared| shared.clone());
        if let Some(device) = shared.filter(|device| device.check().is_ok()) {
            return Ok(device);
        }
        let device = Handle::new(Self::open().await?);
        with_shared(|shared| *shared = Some(device.clone()));
        Ok(device)
    }

    async fn open() -> Result<Self, Error> {
        let unavailable = |message: String| Error::BackendUnavailable { backend: "gpu", message };
        #[cfg(target_arch = "wasm32")]
        if !has_navigator_gpu() {
            return Err(unavailable("there is no WebGPU here (navigator.gpu)".to_owned()));
        }
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = instance
            .request_adapter(&options)
            .await
            .map_err(|error| unavailable(format!("no adapter was found ({error})")))?;
        let info = adapter.get_info();
        let offered = adapter.limits();
        let limits = wgpu::Limits {
            max_buffer_size: offered.max_buffer_size,
            max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
            ..wgpu::Limits::default()
        };
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
        let (device, queue) =
            adapter.request_device(&descriptor).await.map_err(|error| unavailable(error.to_string()))?;

        let failure = Arc::new(Mutex::new(None));
        let report = |message: String, failure: &Mutex<Option<String>>| {
            if let Ok(mut failure) = failure.lock() {
                failure.get_or_insert(message);
            }
        };
        let uncaptured = failure.clone();
        device
            .on_uncaptured_error(Arc::new(move |error: wgpu::Error| report(error.to_string(), &uncaptured)));
        let lost = failure.clone();
        device.set_device_lost_callback(move |reason, message| {
            report(format!("device lost ({reason:?}): {message}"), &lost);
        });

        let uniform = |has_dynamic_offset| binding(wgpu::BufferBindingType::Uniform, has_dynamic_offset);
        let (read, write) = (storage(true), storage(false));
        let adjacency = kernels(
            &device,
            ADJACENCY,
            &[uniform(false), read, write, write, write, write],
            ["count", "allocate", "scatter", "match_twins", "count_corners", "count_fans"],
        );
        let phases = kernels(
            &device,
            PHASES,
            &[uniform(false), uniform(true), read, write, write, write, write, write, write],
            Kernel::ALL.map(Kernel::name),
        );
        let driver = [info.driver.as_str(), info.driver_info.as_str()].join(" ");
        let driver = driver.trim();
        #[cfg(not(target_arch = "wasm32"))]
        let name = info.name.clone();
        #[cfg(target_arch = "wasm32")]
        let name = browser_name(&device).unwrap_or_default();
        let mut result = Self {
            device,
            queue,
            adapter: if driver.is_empty() { name } else { format!("{name}, {driver}") },
            most_workgroups: if info.device_type == wgpu::DeviceType::Cpu { 64 } else { 4096 },
            ends_loops_early: false,
            is_software: info.device_type == wgpu::DeviceType::Cpu,
            failure,
            adjacency,
            phases,
        };
        result.ends_loops_early =
            result.probe_loops().await.map_err(|error| unavailable(error.to_string()))?;
        if result.ends_loops_early {
            result.most_workgroups = MOST_WORKGROUPS;
        }
        Ok(result)
    }

    /// Runs `shaders/probe.wgsl` and compares.
    async fn probe_loops(&self) -> Result<bool, Error> {
        let probe = kernels(&self.device, PROBE, &[storage(false)], ["probe"]);
        let buffer = self.buffer("probe", 1, wgpu::BufferUsages::STORAGE);
        let bindings = self.bind(&probe.layout, &[(&buffer, None)]);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&probe.pipelines[0]);
        pass.set_bind_group(0, &bindings, &[]);
        pass.dispatch_workgroups(1, 1, 1);
        drop(pass);
        let found = self.submit_and_read(encoder, &buffer, 1).await?;
        let expected = (0..100_000).fold(1u32, |x, _| {
            let x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            x ^ (x >> 13)
        });
        Ok(found[0] != expected)
    }

    /// Whether anything has failed since the device was opened.
    ///
    /// # Errors
    /// [`Error::Device`] with what the driver said first.
    pub(super) fn check(&self) -> Result<(), Error> {
        let failure = self.failure.lock().ok().and_then(|failure| failure.clone());
        failure.map_or(Ok(()), |message| Err(Error::Device { message }))
    }

    /// Bytes that one binding can hold.
    pub(super) fn largest_binding(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
    }

    /// A buffer of `words` words of zeros, readable by copies. Never empty: a binding cannot be.
    pub(super) fn buffer(&self, label: &str, words: usize, usage: wgpu::BufferUsages) -> Buffer {
        Buffer(self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size: 4 * words.max(4) as u64,
            usage: usage | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        }))
    }

    /// Binds whole buffers in the order of the layout, except those with a size given in bytes.
    pub(super) fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        buffers: &[(&Buffer, Option<u64>)],
    ) -> wgpu::BindGroup {
        let entries: Vec<_> = buffers
            .iter()
            .zip(0u32..)
            .map(|(&(buffer, size), binding)| wgpu::BindGroupEntry {
                binding,
                resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer,
                    offset: 0,
                    size: size.and_then(wgpu::BufferSize::new),
                }),
            })
            .collect();
        let descriptor = wgpu::BindGroupDescriptor { label: None, layout, entries: &entries };
        self.device.create_bind_group(&descriptor)
    }

    /// Workgroups for `items` invocations.
    pub(super) fn workgroups(&self, items: u32) -> u32 {
        items.div_ceil(WORKGROUP_SIZE).clamp(1, self.most_workgroups)
    }

    /// Submits the commands and reads `words` words from the start of `buffer` behind them.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn submit_and_read(
        &self,
        mut encoder: wgpu::CommandEncoder,
        buffer: &Buffer,
        words: usize,
    ) -> Result<Vec<u32>, Error> {
        let size = 4 * words as u64;
        let staging = Buffer(self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read-back"),
            size: size.max(4),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        }));
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, size);
        self.queue.submit([encoder.finish()]);
        let (sender, receiver) = futures_channel::oneshot::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only if the caller has given up waiting.
            let _ = sender.send(result);
        });
        let failed = |error: &dyn std::fmt::Display| {
            self.check().err().unwrap_or_else(|| Error::Device { message: error.to_string() })
        };
        #[cfg(not(target_arch = "wasm32"))]
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        receiver.await.map_err(|error| failed(&error))?.map_err(|error| failed(&error))?;
        self.check()?;
        let view = staging.get_mapped_range(..).map_err(|error| failed(&error))?;
        // The browser's view need not be aligned.
        let mut result = bytemuck::pod_collect_to_vec(&view);
        result.truncate(words);
        Ok(result)
    }
}

/// Whether wgpu can look for an adapter. Its instance panics outside of a window or a worker, as in Node.
#[cfg(target_arch = "wasm32")]
fn has_navigator_gpu() -> bool {
    let get = |object: &js_sys::Object, key: &str| {
        js_sys::Reflect::get(object, &key.into())
            .ok()
            .filter(|value| !value.is_falsy())
            .map(js_sys::Object::from)
    };
    let global = js_sys::global();
    ["Window", "WorkerGlobalScope"].into_iter().any(|scope| get(&global, scope).is_some())
        && get(&global, "navigator").and_then(|navigator| get(&navigator, "gpu")).is_some()
}

/// Vendor and architecture, such as `nvidia ampere`: what a browser says of a GPU.
#[cfg(target_arch = "wasm32")]
fn browser_name(device: &wgpu::Device) -> Option<String> {
    let info = js_sys::Reflect::get(device.as_webgpu()?.as_ref(), &"adapterInfo".into()).ok()?;
    let word = |key: &str| js_sys::Reflect::get(&info, &key.into()).ok()?.as_string();
    let words = [word("vendor")?, word("architecture")?, word("description")?];
    Some(words.join(" ").trim().to_owned())
}

fn storage(read_only: bool) -> wgpu::BindingType {
    binding(wgpu::BufferBindingType::Storage { read_only }, false)
}

fn binding(ty: wgpu::BufferBindingType, has_dynamic_offset: bool) -> wgpu::BindingType {
    wgpu::BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None }
}

fn kernels<const N: usize>(
    device: &wgpu::Device,
    source: &str,
    bindings: &[wgpu::BindingType],
    names: [&str; N],
) -> Kernels<N> {
    let entries: Vec<_> = bindings
        .iter()
        .zip(0u32..)
        .map(|(&ty, binding)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        })
        .collect();
    let layout =
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipelines = names.map(|name| {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(name),
            compilation_options: Default::default(),
            cache: None,
        })
    });
    Kernels { layout, pipelines }
}
