//! The kernels, compiled from `shaders/` as `build.rs` leaves them, and their bindings.

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
