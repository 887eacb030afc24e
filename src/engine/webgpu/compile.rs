//! Kernels out of plans: all are compiled at the same time.

#[cfg(target_arch = "wasm32")]
use super::ahead;
use super::faults::{Fault, watch};
use super::kernels::{Entry, Kernels, Plan};

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
