//! The kernels, compiled from `shaders/` as `build.rs` leaves them, and their bindings.

#[cfg(target_arch = "wasm32")]
use super::ahead;
use super::faults::{Fault, watch};
use crate::Dimension;
use crate::engine::gpu::upload::Form;
use wgpu::{BindingType, BufferBindingType};

/// Invocations of a workgroup of every kernel.
pub(super) const WORKGROUP_SIZE: u32 = 256;

macro_rules! shaders {
    ($($name:literal)*) => {
        concat!($(include_str!(concat!(env!("OUT_DIR"), "/", $name, ".wgsl"))),*)
    };
}

/// The shaders of the phases, for meshes of one form, in an order in which a reader can follow them: of the kernels that only
/// read lists and history, of those that write them, and of exact arithmetic.
pub(super) fn phases_sources(form: Form) -> [String; 3] {
    let points = if form.is_fixed { shaders!("points" "fixed") } else { shaders!("points" "floats") };
    let (geometry, numbers, creases, preparation) = match form.dimension {
        Dimension::Two => (shaders!("plane"), shaders!("plane_numbers"), "", shaders!("embedded")),
        Dimension::Three => (
            shaders!("space"),
            shaders!("space_numbers"),
            shaders!("creases" "flag_creases"),
            shaders!("prepare_creases"),
        ),
    };
    let (deviation, far) = match (form.dimension, form.has_deviation) {
        (Dimension::Two, _) => ("", ""),
        (_, false) => (shaders!("any_deviation"), ""),
        (_, true) => (shaders!("deviation"), shaders!("deviation_numbers")),
    };
    let common = [shaders!("mesh" "state"), points, geometry, deviation].concat();
    let phases = shaders!("star" "guard" "verdicts" "label" "active" "doubts");
    [
        [&common, shaders!("reads"), phases, shaders!("select" "sweeps")].concat(),
        [
            &common,
            shaders!("atomics"),
            phases,
            creases,
            preparation,
            shaders!("select" "slot" "flip" "frontier" "iteration" "census"),
        ]
        .concat(),
        [&common, shaders!("reads"), phases, creases, shaders!("numbers"), far, numbers, shaders!("decide")]
            .concat(),
    ]
}

/// The shader that builds the adjacency.
pub(super) const ADJACENCY: &str = shaders!("adjacency");

/// The shader that finds drivers whose loops end too early.
pub(super) const PROBE: &str = shaders!("rounds" "probe");

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

    /// In the sources of [`phases_sources`].
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
            sources: vec![ADJACENCY.to_owned()],
            entries: names.map(|name| (0, name, None)).to_vec(),
        }
    }

    /// In the order of [`Kernel`]; the tail has so many invocations.
    pub(super) fn phases(form: Form, tail_size: u32) -> Self {
        let entry = |kernel: &Kernel| kernel.entry(tail_size);
        let entries = Kernel::all(form.dimension).iter().map(entry).collect();
        Self { bindings: phases_bindings(), sources: phases_sources(form).into(), entries }
    }

    pub(super) fn probe() -> Self {
        Self {
            bindings: vec![storage(false)],
            sources: vec![PROBE.to_owned()],
            entries: vec![(0, "probe", None)],
        }
    }

    /// Says how often the filter decides.
    #[cfg(test)]
    pub(super) fn tiers(form: Form) -> Self {
        let [_, writes, _] = phases_sources(form);
        let source = [&writes, include_str!("tiers.wgsl")].concat();
        Self { bindings: phases_bindings(), sources: vec![source], entries: vec![(0, "tiers", None)] }
    }
}

/// The kernels of plans, all compiled at the same time: a driver compiles on the thread that asks for it, and takes long.
#[cfg(not(target_arch = "wasm32"))]
pub(super) async fn compile(plans: &[Plan], device: &wgpu::Device) -> Result<Vec<Kernels>, Fault> {
    let (parts, word) =
        watch(device, || plans.iter().map(|plan| Parts::new(plan, device)).collect::<Vec<_>>());
    told(word.await)?;
    let compile = |parts: &Parts, entry| {
        let (pipeline, word) = watch(device, || parts.pipeline(entry, device));
        told(pollster::block_on(word)).map(|()| pipeline)
    };
    std::thread::scope(|scope| {
        let start =
            |parts, entry| std::thread::Builder::new().spawn_scoped(scope, move || compile(parts, entry));
        let all: Vec<Vec<_>> = (parts.iter().zip(plans))
            .map(|(parts, plan)| plan.entries.iter().map(|entry| (start(parts, entry), entry)).collect())
            .collect();
        let kernels = parts.iter().zip(all).map(|(parts, threads)| {
            let pipelines = threads.into_iter().map(|(thread, entry)| match thread {
                Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
                // The system has no more threads.
                Err(_) => compile(parts, entry),
            });
            Ok(Kernels { pipelines: pipelines.collect::<Result<_, _>>()?, layout: parts.layout.clone() })
        });
        kernels.collect()
    })
}

/// The same in a browser.
#[cfg(target_arch = "wasm32")]
pub(super) async fn compile(plans: &[Plan], device: &wgpu::Device) -> Result<Vec<Kernels>, Fault> {
    let _ahead = ahead::compiled(plans, device).await;
    let kernels = |plan: &Plan| {
        let parts = Parts::new(plan, device);
        let pipelines = plan.entries.iter().map(|entry| parts.pipeline(entry, device)).collect();
        Kernels { pipelines, layout: parts.layout }
    };
    let (kernels, word) = watch(device, || plans.iter().map(kernels).collect());
    told(word.await).map(|()| kernels)
}

fn told(fault: Option<Fault>) -> Result<(), Fault> {
    fault.map_or(Ok(()), Err)
}

/// What pipelines are made of.
struct Parts {
    layout: wgpu::BindGroupLayout,
    pipeline_layout: wgpu::PipelineLayout,
    modules: Vec<wgpu::ShaderModule>,
}

impl Parts {
    fn new(plan: &Plan, device: &wgpu::Device) -> Self {
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
        let module = |source: &String| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: None,
                source: wgpu::ShaderSource::Wgsl(source.as_str().into()),
            })
        };
        Self { layout, pipeline_layout, modules: plan.sources.iter().map(module).collect() }
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
