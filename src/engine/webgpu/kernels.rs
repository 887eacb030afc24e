//! The kernels, compiled from `shaders/` as `build.rs` leaves them, and their bindings.

use crate::engine::upload::Form;
use crate::mesh::Dimension;
use wgpu::{BindingType, BufferBindingType};

/// Invocations of a workgroup of every kernel.
pub(super) const WORKGROUP_SIZE: u32 = 256;

macro_rules! shaders {
    ($($name:literal)*) => {
        concat!($(include_str!(concat!(env!("OUT_DIR"), "/", $name, ".wgsl"))),*)
    };
}

/// The shaders of the phases, for meshes of one form, in an order in which a reader can follow them: of those kernels
/// that only read lists and history, and of the others.
pub(super) fn phases_sources(form: Form) -> [String; 2] {
    let points = if form.is_fixed { shaders!("fixed") } else { shaders!("floats") };
    let (geometry, creases, embedded) = match form.dimension {
        Dimension::Two => (shaders!("plane"), "", shaders!("embedded")),
        Dimension::Three => (shaders!("space" "narrow"), shaders!("creases" "flag_creases"), ""),
    };
    let deviation = match (form.dimension, form.has_deviation) {
        (Dimension::Two, _) => "",
        (_, false) => shaders!("any_deviation"),
        (_, true) => shaders!("deviation"),
    };
    let numbers = [shaders!("mesh" "exact" "state" "points"), points, geometry, deviation].concat();
    let phases = shaders!("verdict" "star" "guard" "verdicts" "label" "select" "active" "doubts");
    [
        [&numbers, shaders!("reads"), phases, creases, shaders!("sweeps")].concat(),
        [&numbers, shaders!("atomics"), phases, embedded, shaders!("slot" "flip" "frontier" "iteration")]
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
    /// Before the first iteration: the turns of the stars in 2D, the creases in 3D.
    Prepare,
    /// The rest of that.
    Complete,
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
        Self::Complete,
        Self::Mark,
    ];

    /// Those that there are, each at its index.
    fn all(dimension: Dimension) -> &'static [Self] {
        match dimension {
            Dimension::Two => &Self::ALL,
            Dimension::Three => &Self::ALL[..Self::Mark as usize],
        }
    }

    /// The kernels before the first iteration.
    pub(super) fn preparation(dimension: Dimension) -> &'static [Self] {
        &Self::all(dimension)[Self::Prepare as usize..]
    }

    /// The kernels of one iteration.
    pub(crate) const ITERATION: [Self; 4] = [Self::Label, Self::Decide, Self::Select, Self::Flip];

    /// In the sources of [`phases_sources`].
    fn entry(self, dimension: Dimension, tail_size: u32) -> Entry {
        match (self, dimension) {
            (Self::Label, _) => (READS, "label_all", None),
            (Self::Decide, _) => (READS, "decide_all", None),
            (Self::Select, _) => (READS, "select_all", None),
            (Self::Flip, _) => (WRITES, "flip_all", None),
            (Self::Tail, _) => (WRITES, "tail", Some(("TAIL_SIZE", f64::from(tail_size)))),
            (Self::Census, _) => (WRITES, "census", None),
            (Self::Prepare, Dimension::Two) => (WRITES, "count_turns", Some(("EXACT", 0.0))),
            (Self::Complete, Dimension::Two) => (WRITES, "count_turns", None),
            (Self::Mark, _) => (WRITES, "mark_embedded", None),
            (Self::Prepare, Dimension::Three) => (READS, "flag_creases", Some(("EXACT", 0.0))),
            (Self::Complete, Dimension::Three) => (READS, "flag_creases", None),
        }
    }
}

/// Places of the sources that only read lists and history, and that write them.
const READS: usize = 0;
const WRITES: usize = 1;

/// The place of a source, an entry point in it, and one of its constants that is not as the source says.
type Entry = (usize, &'static str, Option<(&'static str, f64)>);

/// The pipelines of one shader, which share their bindings.
pub(super) struct Kernels {
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) pipelines: Vec<wgpu::ComputePipeline>,
}

/// count, allocate, scatter, match_twins, count_corners, count_fans.
pub(super) fn adjacency(device: &wgpu::Device) -> Kernels {
    let (read, write) = (storage(true), storage(false));
    let names = ["count", "allocate", "scatter", "match_twins", "count_corners", "count_fans"];
    let entries = names.map(|name| -> Entry { (0, name, None) });
    kernels(device, &[uniform(false), read, write, write, write, write], &[ADJACENCY], &entries)
}

/// In the order of [`Kernel`]; the tail has so many invocations.
pub(super) fn phases(device: &wgpu::Device, form: Form, tail_size: u32) -> Kernels {
    let sources = phases_sources(form);
    let entries: Vec<_> =
        Kernel::all(form.dimension).iter().map(|kernel| kernel.entry(form.dimension, tail_size)).collect();
    kernels(device, &phases_bindings(), &sources.each_ref().map(String::as_str), &entries)
}

fn phases_bindings() -> [BindingType; 9] {
    let (read, write) = (storage(true), storage(false));
    [uniform(false), uniform(true), read, write, write, write, write, write, write]
}

/// Says how often the filter decides.
#[cfg(test)]
pub(super) fn tiers(device: &wgpu::Device, form: Form) -> Kernels {
    let [_, writes] = phases_sources(form);
    let source = [&writes, include_str!("tiers.wgsl")].concat();
    kernels(device, &phases_bindings(), &[&source], &[(0, "tiers", None)])
}

pub(super) fn probe(device: &wgpu::Device) -> Kernels {
    kernels(device, &[storage(false)], &[PROBE], &[(0, "probe", None)])
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

/// Entry points of shaders that have the same bindings.
fn kernels(device: &wgpu::Device, bindings: &[BindingType], sources: &[&str], entries: &[Entry]) -> Kernels {
    let places: Vec<_> = bindings
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
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &places });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let module = |source: &&str| {
        device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Wgsl((*source).into()),
        })
    };
    let modules: Vec<_> = sources.iter().map(module).collect();
    let pipeline = |(place, name, constant): &Entry| {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(*name),
            layout: Some(&pipeline_layout),
            module: &modules[*place],
            entry_point: Some(*name),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: constant.as_slice(),
                ..Default::default()
            },
            cache: None,
        })
    };
    Kernels { pipelines: entries.iter().map(pipeline).collect(), layout }
}
