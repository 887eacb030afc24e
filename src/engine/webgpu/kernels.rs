//! The kernels, compiled from `shaders/`, and their bindings.

use crate::engine::upload::Form;
use crate::mesh::Dimension;
use wgpu::{BindingType, BufferBindingType};

/// Invocations of a workgroup of every kernel.
pub(super) const WORKGROUP_SIZE: u32 = 256;

macro_rules! shaders {
    ($($name:literal)*) => {
        concat!($(include_str!(concat!("../../../shaders/", $name, ".wgsl"))),*)
    };
}

/// The shaders of the phases, for meshes of one form, in an order in which a reader can follow them.
pub(super) fn phases_source(form: Form) -> String {
    let numbers = shaders!("mesh" "exact" "state" "points");
    let points = if form.is_fixed { shaders!("fixed") } else { shaders!("floats") };
    let geometry = match form.dimension {
        Dimension::Two => shaders!("plane"),
        Dimension::Three => shaders!("space" "creases" "flag_creases"),
    };
    let phases = shaders!("verdict" "star" "guard" "label" "select" "slot" "flip" "frontier" "iteration");
    [numbers, points, geometry, phases].concat()
}

/// The shader that builds the adjacency.
pub(super) const ADJACENCY: &str = shaders!("adjacency");

/// The shader that finds drivers whose loops end too early.
pub(super) const PROBE: &str = shaders!("rounds" "probe");

/// The kernels of `iteration.wgsl`.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kernel {
    Label,
    Select,
    Flip,
    Tail,
    Census,
    FlagCreases,
}

impl Kernel {
    const ALL: [Self; 6] =
        [Self::Label, Self::Select, Self::Flip, Self::Tail, Self::Census, Self::FlagCreases];

    /// The entry point.
    fn name(self) -> &'static str {
        match self {
            Self::Label => "label_all",
            Self::Select => "select_all",
            Self::Flip => "flip_all",
            Self::Tail => "tail",
            Self::Census => "census",
            Self::FlagCreases => "flag_creases",
        }
    }
}

/// The pipelines of one shader, which share their bindings.
pub(super) struct Kernels {
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) pipelines: Vec<wgpu::ComputePipeline>,
}

/// count, allocate, scatter, match_twins, count_corners, count_fans.
pub(super) fn adjacency(device: &wgpu::Device) -> Kernels {
    let (read, write) = (storage(true), storage(false));
    let names = ["count", "allocate", "scatter", "match_twins", "count_corners", "count_fans"];
    kernels(device, ADJACENCY, &[uniform(false), read, write, write, write, write], &names)
}

/// In the order of [`Kernel`]; the last is there for surfaces only.
pub(super) fn phases(device: &wgpu::Device, form: Form) -> Kernels {
    let names = Kernel::ALL.map(Kernel::name);
    let names = if form.dimension == Dimension::Two { &names[..5] } else { &names[..] };
    kernels(device, &phases_source(form), &phases_bindings(), names)
}

fn phases_bindings() -> [BindingType; 9] {
    let (read, write) = (storage(true), storage(false));
    [uniform(false), uniform(true), read, write, write, write, write, write, write]
}

/// Says how often the filter decides.
#[cfg(test)]
pub(super) fn tiers(device: &wgpu::Device, form: Form) -> Kernels {
    let source = [&phases_source(form), include_str!("tiers.wgsl")].concat();
    kernels(device, &source, &phases_bindings(), &["tiers"])
}

pub(super) fn probe(device: &wgpu::Device) -> Kernels {
    kernels(device, PROBE, &[storage(false)], &["probe"])
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

fn kernels(device: &wgpu::Device, source: &str, bindings: &[BindingType], names: &[&str]) -> Kernels {
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
    let pipeline = |&name: &&str| {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
            layout: Some(&pipeline_layout),
            module: &module,
            entry_point: Some(name),
            compilation_options: Default::default(),
            cache: None,
        })
    };
    Kernels { pipelines: names.iter().map(pipeline).collect(), layout }
}
