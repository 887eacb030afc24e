//! A session on a device of the program, whose vertices a compute pass moves in every frame.

use edgeflip::wgpu::{self, util::DeviceExt};
use edgeflip::{Backend, GpuBuffers, GpuDevice, Mesh, Options, Session};
use pollster::block_on;
use std::{error::Error, sync::Arc};

/// Opens a device that measures times, if it can.
pub fn open() -> Result<GpuDevice, Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        ..Default::default()
    };
    let adapter = block_on(instance.request_adapter(&options))?;
    let limits = adapter.limits();
    let times = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
    let descriptor = wgpu::DeviceDescriptor {
        required_features: adapter.features() & times,
        required_limits: limits,
        ..Default::default()
    };
    let (device, queue) = block_on(adapter.request_device(&descriptor))?;
    Ok(GpuDevice { instance, device, queue, adapter: adapter.get_info() })
}

/// How the vertices move.
#[derive(Clone, Copy)]
pub enum Motion {
    /// Along waves.
    Wave {
        /// Added to the phase in each frame, in radians.
        speed: f32,
        /// Waves per unit of length, times 2π.
        number: f32,
        /// In units of length; in space, relative to the distance from the axis.
        height: f32,
    },
    /// By random steps, inside of a square sheet.
    Walk {
        /// The longest step along each axis, in units of length.
        step: f32,
    },
}

/// A mesh that moves.
pub struct Moving {
    /// The session on the GPU.
    pub session: Session,
    /// Its buffers.
    pub gpu: GpuBuffers,
    motion: Motion,
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    uniform: wgpu::Buffer,
    vertices: u32,
    stride: u32,
}

impl Moving {
    /// Makes the mesh Delaunay at rest. `untangle` is the option of the session.
    pub fn new(
        device: &GpuDevice,
        mesh: &Arc<Mesh>,
        motion: Motion,
        untangle: Option<bool>,
    ) -> Result<Self, Box<dyn Error>> {
        let device_of_caller = Some(device.clone());
        let options =
            Options { backend: Backend::Gpu, device: device_of_caller, untangle, ..Options::default() };
        let session = block_on(async {
            let mut session = Session::new(mesh.clone(), options).await?;
            session.run(|_, _| std::ops::ControlFlow::Continue(())).await?;
            Ok::<_, edgeflip::Error>(session)
        })?;
        let gpu = session.gpu().ok_or("the session is not on the GPU")?;
        let GpuDevice { device, .. } = device;
        let module = device.create_shader_module(wgpu::include_wgsl!("motion.wgsl"));
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("motion"),
            layout: None,
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            cache: None,
        });
        let numbers = mesh.positions().to_f32();
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        let rest = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("rest"),
            contents: &bytes,
            usage: wgpu::BufferUsages::STORAGE,
        });
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("motion"),
            size: 32,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let buffers = [&uniform, &rest, &gpu.positions];
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let (vertices, stride) = (mesh.vertex_count() as u32, mesh.dimension().stride() as u32);
        Ok(Self { session, gpu, motion, pipeline, bindings, uniform, vertices, stride })
    }

    /// Submits one frame: the vertices move, and the edges flip. Nothing is read back. `before` and `after` record
    /// commands before the motion and after the flips.
    pub fn frame(
        &mut self,
        frame: u32,
        iterations: u32,
        before: impl FnOnce(&mut wgpu::CommandEncoder),
        after: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<(), edgeflip::Error> {
        let GpuBuffers { device, queue, .. } = &self.gpu;
        let [time, number, height, step] = match self.motion {
            Motion::Wave { speed, number, height } => [speed * frame as f32, number, height, 0.0],
            Motion::Walk { step } => [0.0, 0.0, 0.0, step],
        }
        .map(f32::to_bits);
        let words = [time, number, height, step, frame, self.vertices, self.stride, 0];
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        queue.write_buffer(&self.uniform, 0, &bytes);
        let mut encoder = device.create_command_encoder(&Default::default());
        before(&mut encoder);
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.bindings, &[]);
            pass.dispatch_workgroups(self.vertices.div_ceil(256).min(65_535), 1, 1);
        }
        queue.submit([encoder.finish()]);
        self.session.update(None, iterations)?;
        let mut encoder = device.create_command_encoder(&Default::default());
        after(&mut encoder);
        queue.submit([encoder.finish()]);
        Ok(())
    }

    /// Waits until the GPU has done all that was submitted.
    pub fn wait(&self) -> Result<(), wgpu::PollError> {
        self.gpu.device.poll(wgpu::PollType::wait_indefinitely()).map(drop)
    }
}
