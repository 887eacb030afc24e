//! A GPU device, and the kernels compiled for it.

#[cfg(target_arch = "wasm32")]
use super::browser;
#[cfg(target_arch = "wasm32")]
use super::buffer::Busy;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use super::buffer::Sent;
use super::buffer::{Buffer, Kept};
use super::compile;
use super::faults::{Caught, Fault, refuse, unavailable, watch};
use super::history::Batches;
use super::kernels::{Kernels, Plan, WORKGROUP_SIZE};
#[cfg(not(target_arch = "wasm32"))]
use super::own_device;
use super::pool;
use super::programs;
use crate::Error;
use crate::engine::gpu::self_test::Tested;
use crate::engine::gpu::upload::Form;
#[cfg(all(target_arch = "wasm32", feature = "js"))]
use std::cell::RefCell;
#[cfg(target_arch = "wasm32")]
use std::rc::Rc;
#[cfg(test)]
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::sync::{Arc, Mutex};
#[cfg(not(target_arch = "wasm32"))]
use std::task::{Context, Poll, Waker};
use wgpu::BufferUsages;

/// Workgroups that WebGPU allows in one dimension.
pub(super) const MOST_WORKGROUPS: u32 = 65_535;

/// The most invocations of the tail. Few lists of a tail are longer.
const LARGEST_TAIL: u32 = 1024;

/// A device, and what was compiled for it.
pub(crate) struct Device {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) adapter: String,
    /// As the caller has given it.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) given: Option<own_device::GpuDevice>,
    pub(super) is_software: bool,
    /// Enough workgroups to keep the device busy. Every kernel loops over the remaining items.
    most_workgroups: u32,
    /// Invocations of the tail.
    tail_size: u32,
    /// See `shaders/shared/rounds.wgsl`.
    pub(super) ends_loops_early: bool,
    pub(crate) tested: Tested,
    pub(super) batches: Batches,
    failure: Failure,
    /// The programs of exact arithmetic.
    pub(super) programs: Buffer,
    pub(super) adjacency: Kernels,
    /// The kernels of the phases that a mesh has needed.
    phases: Mutex<Phases>,
    /// Staging buffers for the next reads.
    pub(super) kept_for_reads: Kept,
    /// The buffers of sessions that have ended.
    pool: pool::Shared,
    /// Staging buffers for the next writes, mapped.
    #[cfg(target_arch = "wasm32")]
    pub(super) kept_for_writes: Rc<Kept>,
    #[cfg(target_arch = "wasm32")]
    pub(super) busy_for_writes: Busy,
    #[cfg(all(target_arch = "wasm32", feature = "js"))]
    pub(super) sent: RefCell<(Sent, Vec<Caught>)>,
    #[cfg(test)]
    pub(super) asked: Asked,
}

/// Counts of calls to a device.
#[cfg(test)]
#[derive(Default)]
pub(super) struct Asked {
    pub(super) submissions: AtomicU32,
    /// Buffers that were mapped. The host waits for each.
    pub(super) maps: AtomicU32,
}

/// The kernels of the phases, by form.
type Phases = [Option<Arc<Kernels>>; Form::COUNT];

/// The first error since the device was opened, as the device reported it.
type Failure = Arc<Mutex<Option<String>>>;

fn report(failure: &Failure, message: String) {
    failure.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).get_or_insert(message);
}

/// The size of a buffer of so many words.
pub(super) fn bytes_for(words: usize) -> u64 {
    4 * words.max(4) as u64
}

fn descriptor(label: &str, words: usize, usage: BufferUsages) -> wgpu::BufferDescriptor<'_> {
    wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes_for(words),
        usage: usage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    }
}

/// The buffer with the programs of exact arithmetic.
fn programs(device: &wgpu::Device, queue: &wgpu::Queue) -> Buffer {
    let table = programs::table();
    let descriptor = descriptor("programs", 4 * table.len(), BufferUsages::UNIFORM);
    let buffer = Buffer::new(device.create_buffer(&descriptor));
    queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&table));
    buffer
}

/// Submits one copy to a device and waits for it, on another thread. The first submission to a device takes long.
/// Beside the compilation of the kernels, it costs no extra time. Errors are ignored: later calls get them too.
#[cfg(not(target_arch = "wasm32"))]
fn wake(device: &wgpu::Device, queue: &wgpu::Queue) -> std::io::Result<std::thread::JoinHandle<()>> {
    let (device, queue) = (device.clone(), queue.clone());
    std::thread::Builder::new().spawn(move || {
        let ask = || {
            let [from, to] =
                [BufferUsages::COPY_SRC, BufferUsages::COPY_DST | BufferUsages::MAP_READ].map(|usage| {
                    let (label, size) = (Some("wake"), 16);
                    let descriptor = wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false };
                    Buffer::new(device.create_buffer(&descriptor))
                });
            let mut encoder = device.create_command_encoder(&Default::default());
            encoder.copy_buffer_to_buffer(&from, 0, &to, 0, 16);
            queue.submit([encoder.finish()]);
            to.map_async(wgpu::MapMode::Read, .., |_| ());
            let _ = device.poll(wgpu::PollType::wait_indefinitely());
        };
        drop(watch(&device, ask));
    })
}

#[cfg(not(target_arch = "wasm32"))]
fn no_adapter(error: wgpu::RequestAdapterError) -> Error {
    unavailable(format!("no adapter was found ({error})"))
}

/// A browser does not say why.
#[cfg(target_arch = "wasm32")]
fn no_adapter(_: wgpu::RequestAdapterError) -> Error {
    unavailable("no adapter was found".to_owned())
}

fn refused_kernels(fault: Fault) -> Error {
    unavailable(format!("it refuses the kernels: {fault}"))
}

#[cfg(test)]
impl Device {
    /// Submissions, and buffers mapped.
    pub(crate) fn asked(&self) -> [u32; 2] {
        [&self.asked.submissions, &self.asked.maps].map(|count| count.load(Relaxed))
    }
}

impl Device {
    /// # Errors
    /// [`Error::BackendUnavailable`] where the browser has no WebGPU.
    #[cfg(target_arch = "wasm32")]
    pub(super) fn look_for_webgpu() -> Result<(), Error> {
        if browser::has_webgpu() {
            return Ok(());
        }
        Err(unavailable("there is no WebGPU here (navigator.gpu)".to_owned()))
    }

    /// An adapter, and whether it is software.
    pub(super) async fn find_adapter() -> Result<(wgpu::Adapter, bool), Error> {
        #[cfg(target_arch = "wasm32")]
        Self::look_for_webgpu()?;
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = instance.request_adapter(&options).await.map_err(no_adapter)?;
        let is_software = adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        Ok((adapter, is_software))
    }

    /// Opens the adapter, and compiles the kernels that every mesh needs and those of `form`. The device calls
    /// `on_loss` when it is lost.
    pub(super) async fn open(
        adapter: wgpu::Adapter,
        is_software: bool,
        form: Option<Form>,
        on_loss: fn(),
    ) -> Result<Self, Error> {
        let offered = adapter.limits();
        let limits = wgpu::Limits {
            max_buffer_size: offered.max_buffer_size,
            max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
            max_compute_invocations_per_workgroup: offered.max_compute_invocations_per_workgroup,
            max_compute_workgroup_size_x: offered.max_compute_workgroup_size_x,
            ..wgpu::Limits::default()
        };
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
        let (device, queue) =
            adapter.request_device(&descriptor).await.map_err(|error| unavailable(error.to_string()))?;
        #[cfg(not(target_arch = "wasm32"))]
        let name = own_device::name_of(&adapter.get_info());
        #[cfg(target_arch = "wasm32")]
        let name = browser::GpuDevice::of(&device).map_or_else(String::new, |raw| raw.adapter_name());
        Self::compile(device, queue, name, is_software, form, Some(on_loss)).await
    }

    /// Notes that the caller has given the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub(super) fn of_caller(self, given: &own_device::GpuDevice) -> Self {
        Self { given: Some(given.clone()), ..self }
    }

    /// Compiles the kernels that every mesh needs and those of `form`. Without `on_loss`, the handlers of the device
    /// belong to the caller.
    ///
    /// # Errors
    /// Those of [`Device::shared`].
    pub(super) async fn compile(
        device: wgpu::Device,
        queue: wgpu::Queue,
        adapter: String,
        is_software: bool,
        form: Option<Form>,
        on_loss: Option<fn()>,
    ) -> Result<Self, Error> {
        let failure = Failure::default();
        // In a browser this handler belongs to the page.
        #[cfg(not(target_arch = "wasm32"))]
        if on_loss.is_some() {
            let uncaptured = failure.clone();
            device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
                report(&uncaptured, error.to_string());
            }));
        }
        if let Some(on_loss) = on_loss {
            let lost = failure.clone();
            device.set_device_lost_callback(move |reason, message| {
                report(&lost, format!("device lost ({reason:?}): {message}"));
                on_loss();
            });
        }
        let limits = device.limits();
        let largest = limits.max_compute_invocations_per_workgroup.min(limits.max_compute_workgroup_size_x);
        let (most_workgroups, tail_size) =
            if is_software { (64, WORKGROUP_SIZE) } else { (2048, largest.min(LARGEST_TAIL)) };
        let plans = vec![Plan::adjacency(), Plan::probe()];
        #[cfg(not(target_arch = "wasm32"))]
        let waking = wake(&device, &queue);
        let compiled = match form {
            Some(form) => {
                let compiled = compile::compile_phases(plans, form, tail_size, &device).await;
                compiled.map(|(kernels, phases)| (kernels, Some(phases)))
            }
            None => compile::compile(&plans, &device).await.map(|kernels| (kernels, None)),
        };
        #[cfg(not(target_arch = "wasm32"))]
        drop(waking.map(std::thread::JoinHandle::join));
        let (mut compiled, for_form) = compiled.map_err(refused_kernels)?;
        let mut phases = Phases::default();
        if let Some(form) = form {
            phases[form.index()] = for_form;
        }
        let (probe, adjacency) = (compiled.remove(1), compiled.remove(0));
        let (programs, caught) = watch(&device, || programs(&device, &queue));
        if let Some(fault) = caught.await {
            return Err(unavailable(fault.to_string()));
        }
        let mut result = Self {
            device,
            queue,
            adapter,
            #[cfg(not(target_arch = "wasm32"))]
            given: None,
            is_software,
            most_workgroups,
            tail_size,
            ends_loops_early: false,
            tested: Tested::default(),
            batches: Batches::default(),
            failure,
            programs,
            adjacency,
            phases: Mutex::new(phases),
            kept_for_reads: Kept::default(),
            pool: pool::Shared::default(),
            #[cfg(target_arch = "wasm32")]
            kept_for_writes: Rc::default(),
            #[cfg(target_arch = "wasm32")]
            busy_for_writes: Busy::default(),
            #[cfg(all(target_arch = "wasm32", feature = "js"))]
            sent: RefCell::default(),
            #[cfg(test)]
            asked: Asked::default(),
        };
        result.ends_loops_early = result.probe_loops(&probe).await?;
        if result.ends_loops_early {
            result.most_workgroups = MOST_WORKGROUPS;
        }
        Ok(result)
    }

    /// Whether a mesh of a form can start at once: nothing has failed, the kernels are compiled and tested, and the
    /// device is not a software GPU, unless `takes_software`.
    pub(crate) fn is_ready(&self, form: Form, takes_software: bool) -> bool {
        self.check().is_ok() && self.tested.has_passed(form) && (takes_software || !self.is_software)
    }

    /// The kernels of the phases, compiled at the first call. Two concurrent first calls may both compile them.
    ///
    /// # Errors
    /// [`Error::BackendUnavailable`] if the device's compiler refuses them.
    pub(super) async fn phases(&self, form: Form) -> Result<Arc<Kernels>, Error> {
        let known = || self.phases.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(kernels) = &known()[form.index()] {
            return Ok(kernels.clone());
        }
        let compiled = compile::compile_phases(Vec::new(), form, self.tail_size, &self.device).await;
        let (_, kernels) = compiled.map_err(refused_kernels)?;
        Ok(known()[form.index()].get_or_insert(kernels).clone())
    }

    /// Fails if any of our calls has failed since the device was opened, or if the device is lost.
    ///
    /// # Errors
    /// [`Error::Device`] with the first error of the device.
    pub(super) fn check(&self) -> Result<(), Error> {
        let failure = self.failure.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        failure.clone().map_or(Ok(()), |message| Err(Error::Device { message }))
    }

    /// Records an error. Returns the first one of the device.
    pub(super) fn report(&self, message: String) -> Error {
        let mut failure = self.failure.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        Error::Device { message: failure.get_or_insert(message).clone() }
    }

    /// Records a fault, and checks the device.
    pub(super) fn judge(&self, fault: Option<Fault>) -> Result<(), Error> {
        if let Some(fault) = fault {
            report(&self.failure, fault.to_string());
        }
        self.check()
    }

    /// Records a fault when the device tells it, for calls that nobody waits for.
    pub(super) fn keep_watch(&self, mut caught: Caught) {
        let failure = self.failure.clone();
        #[cfg(target_arch = "wasm32")]
        wasm_bindgen_futures::spawn_local(async move {
            if let Some(fault) = caught.as_mut().await {
                report(&failure, fault.to_string());
            }
        });
        // A native device tells at once.
        #[cfg(not(target_arch = "wasm32"))]
        if let Poll::Ready(Some(fault)) = caught.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            report(&failure, fault.to_string());
        }
    }

    /// Makes calls to the device, and waits for their faults.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub(super) async fn checked<T>(&self, calls: impl FnOnce() -> T) -> Result<T, Error> {
        let (result, caught) = watch(&self.device, calls);
        self.judge(caught.await).map(|()| result)
    }

    /// The same for calls that make the buffers of a mesh.
    ///
    /// # Errors
    /// [`Error::BackendLimit`] where there is no memory for the buffers; the device stays usable. [`Error::Device`].
    pub(super) async fn allocated<T>(&self, calls: impl FnOnce() -> T) -> Result<T, Error> {
        let (result, caught) = watch(&self.device, calls);
        self.judge_allocation(caught.await).map(|()| result)
    }

    pub(super) fn judge_allocation(&self, fault: Option<Fault>) -> Result<(), Error> {
        match fault {
            Some(Fault::OutOfMemory) => {
                self.pool.close();
                refuse(format!("{} has no memory left for the mesh", self.adapter))
            }
            fault => self.judge(fault),
        }
    }

    /// The size limit of a binding, in bytes.
    pub(super) fn largest_binding(&self) -> u64 {
        let limits = self.device.limits();
        limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
    }

    /// A buffer of at least `words` words, which may hold anything. It can be copied from and to. It is never empty: a
    /// binding cannot be.
    pub(super) fn buffer(&self, label: &str, words: usize, usage: BufferUsages) -> Buffer {
        let descriptor = descriptor(label, words, usage);
        let kept = self.pool.take(descriptor.size, descriptor.usage);
        let raw = kept.unwrap_or_else(|| self.device.create_buffer(&descriptor));
        Buffer::pooled(raw, self.pool.clone())
    }

    /// Binds buffers in the order of the layout. A size binds only so many bytes; `None` binds the whole buffer.
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
}
