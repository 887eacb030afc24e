//! Compiles the kernels of plans, in parallel.

#[cfg(target_arch = "wasm32")]
use super::ahead;
use super::faults::{Fault, watch};
use super::kernels::{Entry, Kernels, Plan};

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
    let kernels = parts.iter().zip(plans).map(|(parts, plan)| Kernels {
        pipelines: pipelines.by_ref().take(plan.entries.len()).collect(),
        layout: parts.layout.clone(),
    });
    Ok(kernels.collect())
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
    let kernels = |plan: &Plan| {
        let modules = plan.sources.iter().map(|source| module(source, device)).collect();
        let parts = Parts::new(plan, device, modules);
        let pipelines = plan.entries.iter().map(|entry| parts.pipeline(entry, device)).collect();
        Kernels { pipelines, layout: parts.layout }
    };
    let (kernels, caught) = watch(device, || plans.iter().map(kernels).collect());
    no_fault(caught.await).map(|()| kernels)
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
