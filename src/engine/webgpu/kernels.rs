//! The kernels, compiled from `shaders/`, and their bindings.

#[cfg(target_arch = "wasm32")]
use super::ahead;
use super::faults::{Fault, watch};
use super::sources;
use crate::engine::upload::Form;
use crate::mesh::Dimension;
use wgpu::{BindingType, BufferBindingType};

/// Invocations of a workgroup of every kernel.
pub(super) const WORKGROUP_SIZE: u32 = 256;

/// What is done in an iteration and around it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kernel {
    Label,
    Decide,
    Select,
    Flip,
    Tail,
    Census,
    /// Before the first iteration: the signs of the triangles in 2D, the creases in 3D.
    Prepare,
    /// The turns of the stars, in 2D.
    Turn,
    /// Which stars are embedded, in 2D.
    Mark,
}

impl Kernel {
    const ALL: [Self; 9] = [
        Self::Label,
        Self::Decide,
        Self::Select,
        Self::Flip,
        Self::Tail,
        Self::Census,
        Self::Prepare,
        Self::Turn,
        Self::Mark,
    ];

    /// Those that there are, each at its index.
    fn all(dimension: Dimension) -> &'static [Self] {
        match dimension {
            Dimension::Two => &Self::ALL,
            Dimension::Three => &Self::ALL[..=Self::Prepare as usize],
        }
    }

    /// The kernels before the first iteration; exact arithmetic decides between the first of them and the others.
    pub(super) fn preparation(dimension: Dimension) -> &'static [Self] {
        match dimension {
            Dimension::Two => &[Self::Prepare, Self::Decide, Self::Turn, Self::Mark],
            Dimension::Three => &[Self::Prepare, Self::Decide],
        }
    }

    /// The kernels of one iteration.
    pub(crate) const ITERATION: [Self; 4] = [Self::Label, Self::Decide, Self::Select, Self::Flip];

    /// In the sources of [`sources::phases`].
    fn entry(self, tail_size: u32) -> Entry {
        match self {
            Self::Label => (READS, "label_all", None),
            Self::Decide => (NUMBERS, "decide_all", None),
            Self::Select => (READS, "select_all", None),
            Self::Flip => (WRITES, "flip_all", None),
            Self::Tail => (WRITES, "tail", Some(("TAIL_SIZE", f64::from(tail_size)))),
            Self::Census => (WRITES, "census", None),
            Self::Prepare => (WRITES, "prepare_all", None),
            Self::Turn => (WRITES, "count_turns", None),
            Self::Mark => (WRITES, "mark_embedded", None),
        }
    }
}

/// Places of the sources.
const READS: usize = 0;
const WRITES: usize = 1;
const NUMBERS: usize = 2;

/// The place of a source, an entry point in it, and one of its constants that is not as the source says.
pub(super) type Entry = (usize, &'static str, Option<(&'static str, f64)>);

/// The pipelines of some kernels, which share their bindings.
pub(super) struct Kernels {
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) pipelines: Vec<wgpu::ComputePipeline>,
}

/// What is compiled together: entry points of sources that have the same bindings.
pub(super) struct Plan {
    pub(super) bindings: Vec<BindingType>,
    pub(super) sources: Vec<String>,
    pub(super) entries: Vec<Entry>,
}

impl Plan {
    /// count, allocate, scatter, match_twins, count_corners, count_fans.
    pub(super) fn adjacency() -> Self {
        let (read, write) = (storage(true), storage(false));
        let names = ["count", "allocate", "scatter", "match_twins", "count_corners", "count_fans"];
        Self {
            bindings: vec![uniform(false), read, write, write, write, write],
            sources: vec![sources::adjacency()],
            entries: names.map(|name| (0, name, None)).to_vec(),
        }
    }

    /// In the order of [`Kernel`]; the tail has so many invocations.
    pub(super) fn phases(form: Form, tail_size: u32) -> Self {
        let entry = |kernel: &Kernel| kernel.entry(tail_size);
        let entries = Kernel::all(form.dimension).iter().map(entry).collect();
        Self { bindings: phases_bindings(), sources: sources::phases(form).into(), entries }
    }

    pub(super) fn probe() -> Self {
        Self {
            bindings: vec![storage(false)],
            sources: vec![sources::probe()],
            entries: vec![(0, "probe", None)],
        }
    }

    /// Says how often the filter decides.
    #[cfg(test)]
    pub(super) fn tiers(form: Form) -> Self {
        Self {
            bindings: phases_bindings(),
            sources: vec![sources::tiers(form)],
            entries: vec![(0, "tiers", None)],
        }
    }
}

/// The kernels of plans, all compiled at the same time: a driver compiles on the thread that asks for it, and takes long.
#[cfg(not(target_arch = "wasm32"))]
pub(super) async fn compile(plans: &[Plan], device: &wgpu::Device) -> Result<Vec<Kernels>, Fault> {
    let sources: Vec<&String> = plans.iter().flat_map(|plan| &plan.sources).collect();
    let mut modules = at_once(&sources, device, |source| module(source, device))?.into_iter();
    let parts = |plan: &Plan| Parts::new(plan, device, modules.by_ref().take(plan.sources.len()).collect());
    let (parts, word) = watch(device, || plans.iter().map(parts).collect::<Vec<_>>());
    told(word.await)?;
    let entries: Vec<_> = (parts.iter().zip(plans))
        .flat_map(|(parts, plan)| plan.entries.iter().map(move |entry| (parts, entry)))
        .collect();
    let mut pipelines =
        at_once(&entries, device, |(parts, entry)| parts.pipeline(entry, device))?.into_iter();
    let kernels = parts.iter().zip(plans).map(|(parts, plan)| Kernels {
        pipelines: pipelines.by_ref().take(plan.entries.len()).collect(),
        layout: parts.layout.clone(),
    });
    Ok(kernels.collect())
}

/// What the device makes of each item, each on a thread of its own.
#[cfg(not(target_arch = "wasm32"))]
fn at_once<T: Sync, R: Send>(
    items: &[T],
    device: &wgpu::Device,
    make: impl Fn(&T) -> R + Sync,
) -> Result<Vec<R>, Fault> {
    let make = |item| {
        let (result, word) = watch(device, || make(item));
        told(pollster::block_on(word)).map(|()| result)
    };
    let make = &make;
    std::thread::scope(|scope| {
        let start = |item| (std::thread::Builder::new().spawn_scoped(scope, move || make(item)), item);
        let threads: Vec<_> = items.iter().map(start).collect();
        let results = threads.into_iter().map(|(thread, item)| match thread {
            Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            // The system has no more threads.
            Err(_) => make(item),
        });
        results.collect()
    })
}

/// The same in a browser.
#[cfg(target_arch = "wasm32")]
pub(super) async fn compile(plans: &[Plan], device: &wgpu::Device) -> Result<Vec<Kernels>, Fault> {
    let _ahead = ahead::compiled(plans, device).await;
    let kernels = |plan: &Plan| {
        let modules = plan.sources.iter().map(|source| module(source, device)).collect();
        let parts = Parts::new(plan, device, modules);
        let pipelines = plan.entries.iter().map(|entry| parts.pipeline(entry, device)).collect();
        Kernels { pipelines, layout: parts.layout }
    };
    let (kernels, word) = watch(device, || plans.iter().map(kernels).collect());
    told(word.await).map(|()| kernels)
}

fn told(fault: Option<Fault>) -> Result<(), Fault> {
    fault.map_or(Ok(()), Err)
}

fn module(source: &str, device: &wgpu::Device) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

/// What pipelines are made of.
struct Parts {
    layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    modules: Vec<wgpu::ShaderModule>,
}

impl Parts {
    fn new(plan: &Plan, device: &wgpu::Device, modules: Vec<wgpu::ShaderModule>) -> Self {
        let places: Vec<_> = plan
            .bindings
            .iter()
            .zip(0u32..)
            .map(|(&ty, binding)| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty,
                count: None,
            })
            .collect();
        let layout = device
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &places });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        Self { layout, pipeline_layout, modules }
    }

    fn pipeline(&self, (place, name, constant): &Entry, device: &wgpu::Device) -> wgpu::ComputePipeline {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(*name),
            layout: Some(&self.pipeline_layout),
            module: &self.modules[*place],
            entry_point: Some(*name),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: constant.as_slice(),
                ..Default::default()
            },
            cache: None,
        })
    }
}

fn phases_bindings() -> Vec<BindingType> {
    let (read, write) = (storage(true), storage(false));
    vec![uniform(false), uniform(true), read, write, write, write, write, write, write, write]
}

fn uniform(has_dynamic_offset: bool) -> BindingType {
    binding(BufferBindingType::Uniform, has_dynamic_offset)
}

fn storage(read_only: bool) -> BindingType {
    binding(BufferBindingType::Storage { read_only }, false)
}

fn binding(ty: BufferBindingType, has_dynamic_offset: bool) -> BindingType {
    BindingType::Buffer { ty, has_dynamic_offset, min_binding_size: None }
}
