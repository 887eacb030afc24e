//! Compares constants, layouts and bindings of the host with those of the shaders, as naga reads them.

#![allow(clippy::unwrap_used, clippy::panic, reason = "what fails here is a failed test")]

use super::copies::{CHUNK, PIECE};
use super::device::Device;
use super::faults::Fault;
use super::history::{ALL, AREAS, COUNTS, ENTRIES, ENTRY_WORDS, LISTED, SEVERAL_FANS};
use super::kernels::{Plan, WORKGROUP_SIZE};
use super::params::{NEGATIVE, POSITIVE, Params, UNEMBEDDED};
use super::staging::FEWEST;
use super::{adjacency, compile, programs, sources};
use crate::engine::gpu::cosine::DIGIT_BITS;
use crate::engine::gpu::upload::{Form, SPAN};
use crate::mesh::half_edge::{CREASE, FLAGS, LOCKED};
use crate::phases::state::BLOCKED;
use crate::{Dimension, Error, NONE, Reason};
use pollster::block_on;
use std::collections::HashMap;
use std::mem::offset_of;
use std::time::Instant;
use wgpu::naga;

/// Every shader.
fn all_sources() -> Vec<String> {
    Form::ALL.into_iter().flat_map(sources::phases).chain([sources::adjacency(), sources::probe()]).collect()
}

/// The phases in space.
fn space() -> naga::Module {
    let [_, writes, _] =
        sources::phases(Form { dimension: Dimension::Three, is_fixed: false, has_deviation: true });
    parse(&writes)
}

fn parse(source: &str) -> naga::Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)))
}

/// The global constants that are single numbers.
fn constants(module: &naga::Module) -> HashMap<&str, u64> {
    let value = |constant: &naga::Constant| match module.global_expressions[constant.init] {
        naga::Expression::Literal(naga::Literal::U32(x)) => Some(u64::from(x)),
        _ => None,
    };
    module
        .constants
        .iter()
        .filter_map(|(_, constant)| Some((constant.name.as_deref()?, value(constant)?)))
        .collect()
}

/// Offset and size in bytes of each member of a struct.
fn members(module: &naga::Module, name: &str) -> Vec<(String, usize, usize)> {
    let mut layouter = naga::proc::Layouter::default();
    layouter.update(module.to_ctx()).unwrap();
    let (_, structure) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name)).unwrap();
    let naga::TypeInner::Struct { members, .. } = &structure.inner else { panic!("{name} is no struct") };
    members
        .iter()
        .map(|m| (m.name.clone().unwrap(), m.offset as usize, layouter[m.ty].size as usize))
        .collect()
}

#[test]
fn constants_of_the_phases_agree() {
    let module = space();
    let shader = constants(&module);
    let host = [
        ("NONE", u64::from(NONE)),
        ("BLOCKED", u64::from(BLOCKED)),
        ("CREASE", u64::from(CREASE)),
        ("LOCKED", u64::from(LOCKED)),
        ("FLAGS", u64::from(FLAGS)),
        ("WORKGROUP_SIZE", u64::from(WORKGROUP_SIZE)),
        ("SPAN", u64::from(SPAN)),
        ("COUNTS", COUNTS as u64),
        ("ENTRIES", ENTRIES as u64),
        ("ENTRY_WORDS", ENTRY_WORDS as u64),
        ("REASON_ANGLE", Reason::Angle as u64),
        ("REASON_FOLD", Reason::Fold as u64),
        ("REASON_DUPLICATE", Reason::Duplicate as u64),
        ("REASON_LOCKED", Reason::Locked as u64),
        ("REASON_DEVIATION", Reason::Deviation as u64),
        // The host reads the census and an entry by index.
        ("COUNTED", 0),
        ("LABELLED", 1),
        ("BLOCKED_BY", 2),
        ("FLIPS", 0),
        ("LENGTH", 1),
        ("DUE", 2),
        ("RAN", 3),
        ("LISTED", u64::from(LISTED)),
        ("ALL", u64::from(ALL)),
        ("AREAS", AREAS as u64),
        ("SEVERAL_FANS", SEVERAL_FANS as u64),
        ("NEGATIVE", u64::from(NEGATIVE)),
        ("POSITIVE", u64::from(POSITIVE)),
        ("UNEMBEDDED", u64::from(UNEMBEDDED)),
    ];
    for (name, value) in host {
        assert_eq!(shader.get(name), Some(&value), "{name}");
    }
}

#[test]
fn constants_of_the_rounds_agree() {
    let form = Form { dimension: Dimension::Two, is_fixed: false, has_deviation: false };
    let module = parse(&sources::untangle(form));
    let shader = constants(&module);
    for (name, value) in crate::untangle::CONSTANTS {
        assert_eq!(shader.get(name), Some(&u64::from(value)), "{name}");
    }
    assert_eq!(shader.get("HOME"), Some(&u64::from(super::untangle::ALL_ROUNDS)));
}

#[test]
fn constants_of_exact_arithmetic_agree() {
    let form = Form { dimension: Dimension::Three, is_fixed: false, has_deviation: true };
    let [_, _, space] = sources::phases(form);
    let [_, _, plane] = sources::phases(Form { dimension: Dimension::Two, has_deviation: false, ..form });
    let (space, plane) = (parse(&space), parse(&plane));
    let (space, plane) = (constants(&space), constants(&plane));
    let offsets = [
        ("MANTISSA", programs::MANTISSA),
        ("POWER", programs::POWER),
        ("PQ", programs::PQ),
        ("RS", programs::RS),
        ("N", programs::N),
        ("M", programs::M),
        ("COSINE", programs::COSINE),
        ("LAST", programs::LAST),
        ("OFFSET", programs::LAST),
    ];
    let sizes = [
        ("DIGIT_BITS", DIGIT_BITS),
        ("DECIDERS", programs::DECIDERS),
        ("SLICE", programs::SLICE),
        ("GIVEN_WORDS", programs::GIVEN),
        ("WORDS", programs::WORDS),
        ("TABLE", programs::table().len() as u32),
    ];
    for (name, value) in offsets.into_iter().chain(sizes) {
        assert_eq!(space[name], u64::from(value), "{name}");
    }
    for (name, offset) in [("VALUE", programs::N), ("FIRST", programs::M), ("SECOND", programs::COSINE)] {
        assert_eq!(plane[name], u64::from(offset), "{name}");
    }
}

#[test]
fn constants_of_the_adjacency_agree() {
    let module = parse(&sources::adjacency());
    let shader = constants(&module);
    assert_eq!(shader["NONE"], u64::from(NONE));
    assert_eq!(shader["WORKGROUP_SIZE"], u64::from(WORKGROUP_SIZE));
    assert_eq!(shader["COUNTERS"], adjacency::COUNTERS as u64);
    let counters = ["EDGES", "BOUNDARY", "NON_MANIFOLD", "INCONSISTENT", "UNWALKED"];
    for (name, index) in counters.into_iter().zip(0..) {
        assert_eq!(shader[name], index, "{name}");
    }
    let sizes: Vec<_> = members(&module, "Params").into_iter().map(|(_, at, size)| (at, size)).collect();
    assert_eq!(sizes, [(0, 4), (4, 4), (8, 4)]);
}

#[test]
fn params_have_one_layout() {
    macro_rules! host {
        ($($field:ident),*) => {
            [$((stringify!($field), offset_of!(Params, $field))),*]
        };
    }
    let host = host!(
        signs,
        highest,
        depth,
        vertices,
        triangles,
        first,
        fans,
        fans_length,
        tail,
        cos,
        cos_sign,
        any_angle,
        tail_iterations,
        tail_length,
        list_below,
        embedded,
        winding,
        update,
        changes,
        untangles,
        cos_digits,
        deviation
    );
    let shader = members(&space(), "Params");
    let offsets: Vec<_> = shader.iter().map(|(name, offset, _)| (name.as_str(), *offset)).collect();
    assert_eq!(offsets, host);
    let (_, offset, size) = &shader[shader.len() - 1];
    assert_eq!(offset + size, size_of::<Params>());
}

#[test]
fn shaders_stay_within_the_limits_of_every_browser() {
    for source in all_sources() {
        let module = parse(&source);
        let capabilities = naga::valid::Capabilities::default();
        let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), capabilities);
        validator.validate(&module).unwrap();
        let storage = |(_, variable): &(_, &naga::GlobalVariable)| {
            matches!(variable.space, naga::AddressSpace::Storage { .. })
        };
        assert!(module.global_variables.iter().filter(storage).count() <= 8);
        for entry in &module.entry_points {
            assert!(entry.workgroup_size[0] <= 256);
            // WGSL grants a function 8192 bytes of variables.
            let mut layouter = naga::proc::Layouter::default();
            layouter.update(module.to_ctx()).unwrap();
            for function in module.functions.iter().map(|(_, f)| f).chain([&entry.function]) {
                let bytes: u32 = function.local_variables.iter().map(|(_, v)| layouter[v.ty].size).sum();
                assert!(bytes <= 8192, "{:?}: {bytes} bytes", function.name);
            }
        }
    }
}

/// The most SPIR-V words of a kernel. A driver has to compile them before the first result.
const MOST_WORDS: usize = 18_900;

/// `cargo test --release --lib one_by_one -- --nocapture` prints how long each kernel compiles on this machine's
/// device. `__GL_SHADER_DISK_CACHE=0` or `MESA_SHADER_CACHE_DISABLE=true` turns off the cache of the driver.
#[test]
fn kernels_are_short_one_by_one() {
    let (adapter, is_software) = block_on(Device::find_adapter()).unwrap();
    let gpu = block_on(Device::open(adapter, is_software, None, || {})).unwrap();
    println!("{}\n\n| kernels | kernel | SPIR-V words | ms |\n|---|---|---:|---:|", gpu.adapter);
    let form = |dimension, has_deviation| Form { dimension, is_fixed: false, has_deviation };
    let plans = [
        ("plane", Plan::phases(form(Dimension::Two, false))),
        ("space", Plan::phases(form(Dimension::Three, false))),
        ("deviation", Plan::phases(form(Dimension::Three, true))),
        ("plane", Plan::tail(form(Dimension::Two, false), WORKGROUP_SIZE)),
        ("plane", Plan::untangle(form(Dimension::Two, false), WORKGROUP_SIZE)),
        ("space", Plan::tail(form(Dimension::Three, false), WORKGROUP_SIZE)),
        ("deviation", Plan::tail(form(Dimension::Three, true), WORKGROUP_SIZE)),
        ("adjacency", Plan::adjacency()),
    ];
    for (name, Plan { bindings, sources, entries }) in plans {
        for entry in entries {
            let words = spirv_words(&sources[entry.0], entry.1);
            let one = Plan { bindings: bindings.clone(), sources: sources.clone(), entries: vec![entry] };
            let start = Instant::now();
            let compiled = block_on(compile::compile(std::slice::from_ref(&one), &gpu.device));
            let ms = start.elapsed().as_secs_f64() * 1e3;
            assert!(compiled.is_ok(), "{name}: {}", entry.1);
            println!("| {name} | {} | {words} | {ms:.0} |", entry.1);
            assert!(words <= MOST_WORDS, "{name}: {} has {words} words", entry.1);
        }
    }
}

/// The SPIR-V words of one entry point and the functions that it calls.
fn spirv_words(source: &str, entry: &str) -> usize {
    let mut module = parse(source);
    module.entry_points.retain(|point| point.name == entry);
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    let mut validator = naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::default(),
    );
    // Overridable constants get their default values.
    let info = validator.validate(&module).unwrap();
    let (module, info) =
        naga::back::pipeline_constants::process_overrides(&module, &info, None, &Default::default()).unwrap();
    naga::back::spv::write_vec(&module, &info, &naga::back::spv::Options::default(), None).unwrap().len()
}

/// Chromium's compiler (seen in 156, on SwiftShader) does not clear a variable declared in a loop without a value: the
/// variable keeps its value from the round before. Functions are inlined into loops, so every variable needs a value.
#[test]
fn variables_have_an_initial_value() {
    for line in all_sources().iter().flat_map(|source| source.lines()) {
        let in_function = line.starts_with("    ") && line.trim_start().starts_with("var ");
        assert!(!in_function || line.contains(" = "), "{}", line.trim());
    }
}

/// On a device of its own, which is unusable afterwards.
#[test]
fn an_error_of_a_call_is_reported() {
    let gpu = block_on(async {
        let (adapter, is_software) = Device::find_adapter().await?;
        Device::open(adapter, is_software, None, || {}).await
    })
    .unwrap();
    assert!(block_on(gpu.checked(|| gpu.buffer("small", 4, wgpu::BufferUsages::STORAGE))).is_ok());
    let no_usage_fits = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE;
    let refused = block_on(gpu.checked(|| gpu.buffer("wrong", 4, no_usage_fits)));
    assert!(matches!(refused, Err(Error::Device { .. })));
    assert!(matches!(gpu.check(), Err(Error::Device { .. })));
}

#[test]
fn words_come_back_as_they_were_written() {
    let device = block_on(Device::shared(true, None)).unwrap();
    for words in [0, 1, PIECE - 1, PIECE, 2 * PIECE + 1, CHUNK, CHUNK + PIECE + 3, 3 * CHUNK + 5] {
        assert!(come_back(&device, words, 0x9e37_79b9), "{words} words");
    }
}

fn come_back(device: &Device, words: usize, factor: u32) -> bool {
    let written: Vec<u32> = (0..words as u32).map(|i| i.wrapping_mul(factor)).collect();
    let back = block_on(async {
        let buffer = device.buffer("words", words, wgpu::BufferUsages::STORAGE);
        device.checked(|| device.write(&buffer, &written)).await?;
        device.read(&buffer, words).await
    });
    back.unwrap() == written
}

/// Two threads that read at the same time get different staging buffers.
#[test]
fn threads_share_the_kept_buffers() {
    let device = block_on(Device::own()).unwrap();
    std::thread::scope(|scope| {
        for thread in 1..5 {
            let device = &device;
            scope.spawn(move || {
                for round in 1..20 {
                    assert!(come_back(device, 5000 * thread * (round % 5), 2 * round as u32 + 1));
                }
            });
        }
    });
    let kept: Vec<_> = std::iter::from_fn(|| device.kept_for_reads.take(0)).collect();
    assert!((1..=4).contains(&kept.len()));
    assert!(come_back(&device, 1, 7) && device.kept_for_reads.take(0).unwrap().size() == FEWEST);
    assert!(device.kept_for_reads.take(0).is_none());
}

#[test]
fn buffers_are_kept_for_the_next_session() {
    let device = block_on(Device::own()).unwrap();
    let buffer = |words| device.buffer("words", words, wgpu::BufferUsages::STORAGE);
    let first = buffer(1 << 20);
    let raw = (*first).clone();
    drop(first);
    assert!(*buffer(1 << 20) == raw, "the same size");
    drop(buffer(4));
    assert!(*buffer(1 << 20) == raw, "a small one came between");
    drop(buffer(1 << 21));
    let other = buffer(1 << 20);
    assert!(*other != raw, "a large one came between");
    let given = other.given();
    drop(other);
    assert!(*buffer(1 << 20) != given, "the caller has it");
    let refused = device.judge_allocation(Some(Fault::OutOfMemory));
    assert!(matches!(refused, Err(Error::BackendLimit { .. })));
    let last = buffer(1 << 20);
    let raw = (*last).clone();
    drop(last);
    assert!(*buffer(1 << 20) != raw, "the memory was exhausted");
}
