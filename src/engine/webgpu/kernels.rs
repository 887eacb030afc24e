//! The kernels in `shaders/`, and their bindings.

use super::sources;
use crate::Dimension;
use crate::engine::gpu::upload::Form;
use std::sync::OnceLock;
use wgpu::{BindingType, BufferBindingType};

/// Invocations per workgroup of every kernel.
pub(super) const WORKGROUP_SIZE: u32 = 256;

/// The kernels of the phases, without the tail, which runs many short iterations ([`Plan::tail`]).
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kernel {
    Label,
    Decide,
    Select,
    Flip,
    Census,
    /// Counts the triangles whose area is not positive.
    Areas,
    /// Before the first iteration: the signs of the triangles in 2D, the creases in 3D.
    Prepare,
    /// Counts the turns of the stars, in 2D.
    Turn,
    /// Marks the embedded stars, in 2D.
    Mark,
}

impl Kernel {
    const ALL: [Self; 9] = [
        Self::Label,
        Self::Decide,
        Self::Select,
        Self::Flip,
        Self::Census,
        Self::Areas,
        Self::Prepare,
        Self::Turn,
        Self::Mark,
    ];

    /// The kernels of a dimension, each at its index.
    fn all(dimension: Dimension) -> &'static [Self] {
        match dimension {
            Dimension::Two => &Self::ALL,
            Dimension::Three => &Self::ALL[..=Self::Prepare as usize],
        }
    }

    /// The kernels before the first iteration.
    pub(super) fn preparation(dimension: Dimension) -> &'static [Self] {
        match dimension {
            Dimension::Two => &[Self::Prepare, Self::Decide, Self::Turn, Self::Mark],
            Dimension::Three => &[Self::Prepare, Self::Decide],
        }
    }

    /// The kernels of one iteration.
    pub(crate) const ITERATION: [Self; 4] = [Self::Label, Self::Decide, Self::Select, Self::Flip];

    /// Its entry point in the sources of [`sources::phases`].
    fn entry(self) -> Entry {
        match self {
            Self::Label => (READS, "label_all", None),
            Self::Decide => (NUMBERS, "decide_all", None),
            Self::Select => (READS, "select_all", None),
            Self::Flip => (WRITES, "flip_all", None),
            Self::Census => (WRITES, "census", None),
            Self::Areas => (WRITES, "count_areas", None),
            Self::Prepare => (WRITES, "prepare_all", None),
            Self::Turn => (WRITES, "count_turns", None),
            Self::Mark => (WRITES, "mark_embedded", None),
        }
    }
}

// Indices of the sources.
const READS: usize = 0;
const WRITES: usize = 1;
const NUMBERS: usize = 2;

/// The index of a source, an entry point in it, and a value that overrides one of its constants.
pub(super) type Entry = (usize, &'static str, Option<(&'static str, f64)>);

/// The pipelines of kernels that share their bindings.
pub(super) struct Kernels {
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) pipelines: Vec<wgpu::ComputePipeline>,
    /// Only for the kernels of the phases: the tail, once it is compiled.
    pub(super) tail: OnceLock<wgpu::ComputePipeline>,
    /// The same: those that untangle, see [`Plan::untangle`], which the first update compiles.
    pub(super) untangle: OnceLock<Vec<wgpu::ComputePipeline>>,
    /// The kernel of the baseline, once it is compiled.
    #[cfg(feature = "baseline")]
    pub(super) take_selection: OnceLock<wgpu::ComputePipeline>,
}

impl Kernels {
    pub(super) fn new(layout: wgpu::BindGroupLayout, pipelines: Vec<wgpu::ComputePipeline>) -> Self {
        Self {
            layout,
            pipelines,
            tail: OnceLock::new(),
            untangle: OnceLock::new(),
            #[cfg(feature = "baseline")]
            take_selection: OnceLock::new(),
        }
    }
}

/// Entry points that are compiled together and share their bindings.
pub(super) struct Plan {
    pub(super) bindings: Vec<BindingType>,
    pub(super) sources: Vec<String>,
    pub(super) entries: Vec<Entry>,
}

impl Plan {
    /// The kernels of the adjacency, in the order in which `adjacency::record` dispatches them.
    pub(super) fn adjacency() -> Self {
        let (read, write) = (storage(true), storage(false));
        let names = ["clear", "match_twins", "part_many", "walk_fans"];
        Self {
            bindings: vec![uniform(false), read, write, write, write, write],
            sources: vec![sources::adjacency()],
            entries: names.map(|name| (0, name, None)).to_vec(),
        }
    }

    /// The kernels that write the adjacency for the caller, in the order of their dispatches.
    pub(super) fn walks() -> Self {
        let (read, write) = (storage(true), storage(false));
        Self {
            bindings: vec![read, read, write, write],
            sources: vec![sources::walks()],
            entries: ["find_starts", "name_starts"].map(|name| (0, name, None)).to_vec(),
        }
    }

    /// The kernels of the phases, in the order of [`Kernel`].
    pub(super) fn phases(form: Form) -> Self {
        let entries = Kernel::all(form.dimension).iter().map(|kernel| kernel.entry()).collect();
        Self { bindings: phases_bindings(), sources: sources::phases(form).into(), entries }
    }

    /// The tail, with so many invocations. It takes longest to compile, and no mesh needs it in its first iterations.
    pub(super) fn tail(form: Form, size: u32) -> Self {
        let entries = vec![(0, "tail", Some(("TAIL_SIZE", f64::from(size))))];
        Self { bindings: phases_bindings(), sources: vec![sources::writes(form)], entries }
    }

    /// The kernels that untangle a mesh in the plane in updates: half a round, and all rounds in one workgroup, with so many
    /// invocations.
    pub(super) fn untangle(form: Form, size: u32) -> Self {
        let all = Some(("ROUNDS_SIZE", f64::from(size)));
        let entries = vec![(0, "half_round", None), (0, "untangle", all)];
        Self { bindings: phases_bindings(), sources: vec![sources::untangle(form)], entries }
    }

    pub(super) fn probe() -> Self {
        Self {
            bindings: vec![storage(false)],
            sources: vec![sources::probe()],
            entries: vec![(0, "probe", None)],
        }
    }

    /// Takes the selection of the CPU.
    #[cfg(feature = "baseline")]
    pub(super) fn baseline(form: Form) -> Self {
        Self {
            bindings: phases_bindings(),
            sources: vec![sources::baseline(form)],
            entries: vec![(0, "take_selection", None)],
        }
    }

    /// Counts how often the filter decides.
    #[cfg(test)]
    pub(super) fn tiers(form: Form) -> Self {
        Self {
            bindings: phases_bindings(),
            sources: vec![sources::tiers(form)],
            entries: vec![(0, "tiers", None)],
        }
    }
}

fn phases_bindings() -> Vec<BindingType> {
    let (read, write) = (storage(true), storage(false));
    vec![uniform(false), uniform(true), read, write, write, write, write, write, write, uniform(false)]
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
