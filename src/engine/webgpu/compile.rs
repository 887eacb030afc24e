//! Compiles the kernels of plans, in parallel.

#[cfg(target_arch = "wasm32")]
use super::ahead;
use super::faults::{Fault, watch};
use super::kernels::{Entry, Kernels, Plan};
use crate::engine::gpu::upload::Form;
use std::sync::Arc;

/// The kernels of plans, compiled in parallel. A driver compiles on the thread that calls it, and takes long.
#[cfg(not(target_arch = "wasm32"))]
pub(super) async fn compile(plans: &[Plan], device: &wgpu::Device) -> Result<Vec<Kernels>, Fault> {
    let sources: Vec<&String> = plans.iter().flat_map(|plan| &plan.sources).collect();
    let mut modules = at_once(&sources, device, |source| module(source, device))?.into_iter();
    let parts = |plan: &Plan| Parts::new(plan, device, modules.by_ref().take(plan.sources.len()).collect());
    let (parts, caught) = watch(device, || plans.iter().map(parts).collect::<Vec<_>>());
    no_fault(caught.await)?;
    let entries: Vec<_> = (parts.iter().zip(plans))
        .flat_map(|(parts, plan)| plan.entries.iter().map(move |entry| (parts, entry)))
        .collect();
    let mut pipelines =
        at_once(&entries, device, |(parts, entry)| parts.pipeline(entry, device))?.into_iter();
    let kernels = parts.into_iter().zip(plans);
    let mut pipelines_of = |plan: &Plan| pipelines.by_ref().take(plan.entries.len()).collect();
    Ok(kernels.map(|(parts, plan)| Kernels::new(parts.layout, pipelines_of(plan))).collect())
}

/// Calls `make` for each item, each on its own thread.
#[cfg(not(target_arch = "wasm32"))]
fn at_once<T: Sync, R: Send>(
    items: &[T],
    device: &wgpu::Device,
    make: impl Fn(&T) -> R + Sync,
) -> Result<Vec<R>, Fault> {
    let make = |item| {
        let (result, caught) = watch(device, || make(item));
        no_fault(pollster::block_on(caught)).map(|()| result)
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
    let (kernels, caught) = watch(device, || plans.iter().map(|plan| compile_short(plan, device)).collect());
    no_fault(caught.await).map(|()| kernels)
}

/// The kernels of a short plan. The device tells a fault later.
pub(super) fn compile_short(plan: &Plan, device: &wgpu::Device) -> Kernels {
    let modules = plan.sources.iter().map(|source| module(source, device)).collect();
    let parts = Parts::new(plan, device, modules);
    let pipelines = plan.entries.iter().map(|entry| parts.pipeline(entry, device)).collect();
    Kernels::new(parts.layout, pipelines)
}

/// The kernels of some plans, and those of the phases for a form.
///
/// In a browser the tail compiles while the first runs go on. Natively it compiles with the other kernels: a process
/// may end at any time, and drivers do not expect that while they compile.
pub(super) async fn compile_phases(
    mut plans: Vec<Plan>,
    form: Form,
    tail_size: u32,
    device: &wgpu::Device,
) -> Result<(Vec<Kernels>, Arc<Kernels>), Fault> {
    plans.push(Plan::phases(form));
    let tail = Plan::tail(form, tail_size);
    #[cfg(not(target_arch = "wasm32"))]
    plans.push(tail);
    let mut compiled = compile(&plans, device).await?;
    #[cfg(not(target_arch = "wasm32"))]
    let tail = compiled.pop();
    let phases = Arc::new(compiled.remove(compiled.len() - 1));
    #[cfg(not(target_arch = "wasm32"))]
    keep_tail(&phases, tail);
    #[cfg(target_arch = "wasm32")]
    {
        let (phases, device) = (phases.clone(), device.clone());
        wasm_bindgen_futures::spawn_local(async move {
            // Without a tail, every iteration has its own dispatches.
            let compiled = compile(&[tail], &device).await;
            keep_tail(&phases, compiled.ok().and_then(|mut kernels| kernels.pop()));
        });
    }
    Ok((compiled, phases))
}

fn keep_tail(phases: &Kernels, tail: Option<Kernels>) {
    if let Some(pipeline) = tail.and_then(|mut tail| tail.pipelines.pop()) {
        // Nobody else sets it.
        let _ = phases.tail.set(pipeline);
    }
}

fn no_fault(fault: Option<Fault>) -> Result<(), Fault> {
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
        let entries: Vec<_> = plan
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
            .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        Self { layout, pipeline_layout, modules }
    }

    fn pipeline(&self, (source, name, constant): &Entry, device: &wgpu::Device) -> wgpu::ComputePipeline {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(*name),
            layout: Some(&self.pipeline_layout),
            module: &self.modules[*source],
            entry_point: Some(*name),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: constant.as_slice(),
                ..Default::default()
            },
            cache: None,
        })
    }
}
