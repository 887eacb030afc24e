/** Moves a mesh on the GPU: vertices, flips and picture stay in its buffers. */

import { FlipSession } from 'edgeflip';
import type { IndexedMesh } from 'edgeflip/files';
import type { Sharing } from '../watch/corners.ts';
import source from './kernels.wgsl?raw';
import { bubble, HALF, kept, lengthOf, LONGEST, PUSH, rimOf, SHARPNESS, type Motion, type Step } from './motions.ts';
import { LONG_AGO, type MovingMesh } from './moving-mesh.ts';
import { MovingSurface } from './moving-surface.ts';

/** Workgroups of 256 threads. Each thread loops over further items. */
const MOST_WORKGROUPS = 4096;

export async function moveOnDevice(
  mesh: IndexedMesh,
  motion: Motion,
  device: GPUDevice,
  sharing: Sharing,
): Promise<MovingMesh> {
  const { STORAGE, UNIFORM, COPY_DST } = GPUBufferUsage;
  const { dimension, indices } = mesh;
  const vertices = mesh.positions.length / dimension;
  const session = await FlipSession.create(mesh, { backend: 'webgpu', device, maxNormalAngle: motion.beta });
  const own: GPUBuffer[] = [];
  try {
    await session.run();
    const shared = (await session.gpu())!;
    const bytes = 4 * indices.length;
    const made = (size: number, usage: number, data?: BufferSource) => {
      const buffer = device.createBuffer({ size, usage: usage | COPY_DST });
      own.push(buffer);
      if (data) device.queue.writeBuffer(buffer, 0, data);
      return buffer;
    };
    const uniform = made(64, UNIFORM);
    const start = made(12 * vertices, STORAGE, await startOf(session, mesh, motion));
    const sums = made(12 * vertices, STORAGE);
    const before = made(bytes, STORAGE);
    const flashed = made(bytes, STORAGE, new Float32Array(indices.length).fill(LONG_AGO));
    const buffers = [uniform, start, shared.positions, shared.indices, sums, before, flashed] as GPUBuffer[];
    const { group, pipeline } = await kernelsFor(device, buffers, motion, vertices, indices.length);
    const encoder = device.createCommandEncoder();
    encoder.copyBufferToBuffer(shared.indices as GPUBuffer, 0, before, 0, bytes);
    device.queue.submit([encoder.finish()]);

    const submit = (...kernels: [GPUComputePipeline, items: number][]) => {
      const encoder = device.createCommandEncoder();
      const pass = encoder.beginComputePass();
      pass.setBindGroup(0, group);
      for (const [kernel, items] of kernels) {
        pass.setPipeline(kernel);
        pass.dispatchWorkgroups(Math.min(MOST_WORKGROUPS, Math.ceil(items / 256)));
      }
      pass.end();
      device.queue.submit([encoder.finish()]);
    };
    const triangles = indices.length / 3;
    const surface = MovingSurface.onBuffers(
      sharing,
      shared.positions as GPUBuffer,
      shared.indices as GPUBuffer,
      flashed,
      mesh,
    );
    const { pose, add, relax, flash } = pipeline;
    return {
      engine: 'WebGPU',
      surface,
      async frame(step) {
        device.queue.writeBuffer(uniform, 0, numbersFor(step));
        if (motion.pose) submit([pose, vertices]);
        else submit([add, triangles], [relax, vertices]);
        session.update();
        submit([flash, 3 * triangles]);
        surface.time = step.time;
      },
      settled: () => device.queue.onSubmittedWorkDone(),
      async finish() {
        session.update({ iterations: 64 });
        submit([flash, 3 * triangles]);
      },
      counters: () => session.counters(),
      async mesh() {
        const positions = await read(device, shared.positions as GPUBuffer, 4 * dimension * vertices);
        return { positions, indices: await session.triangles(), dimension };
      },
      free() {
        surface.dispose();
        session.free();
        for (const buffer of own) buffer.destroy();
      },
    };
  } catch (error) {
    session.free();
    for (const buffer of own) buffer.destroy();
    throw error;
  }
}

/** Three numbers per vertex: where it began; or whether it stays, if each frame moves the vertices on. */
async function startOf(session: FlipSession, mesh: IndexedMesh, motion: Motion): Promise<Float32Array<ArrayBuffer>> {
  const { positions, dimension } = mesh;
  const start = new Float32Array((3 * positions.length) / dimension);
  if (motion.pose) {
    for (let i = 0; i < positions.length; i++) start[3 * Math.floor(i / dimension) + (i % dimension)] = positions[i]!;
  } else {
    rimOf(await session.edges(), start.length / 3).forEach((isFixed, v) => (start[3 * v] = isFixed));
  }
  return start;
}

function numbersFor(step: Step): Float32Array<ArrayBuffer> {
  const { drag, time, seconds } = step;
  const { origin = [0, 0, 0], way = [0, 0, 1], by = [0, 0, 0], depth = 0 } = drag ?? {};
  const push = [...bubble(time), PUSH.strength * seconds, PUSH.sharpness];
  return new Float32Array([...origin, depth, ...way, kept(step), ...by, time, ...push]);
}

async function kernelsFor(device: GPUDevice, buffers: GPUBuffer[], motion: Motion, vertices: number, corners: number) {
  const constants = `
    const DIMENSION = ${motion.dimension}u;
    const VERTICES = ${vertices}u;
    const CORNERS = ${corners}u;
    const HALF = ${HALF};
    const LENGTH = ${lengthOf(corners / 3)};
    const LONGEST = ${LONGEST};
    const SHARPNESS = ${SHARPNESS};
    fn pose(start: vec3f, seconds: f32) -> vec3f { ${motion.wgsl ?? 'return start;'} }
  `;
  const module = device.createShaderModule({ code: constants + source });
  const types: GPUBufferBindingType[] = [
    'uniform',
    'read-only-storage',
    'storage',
    'read-only-storage',
    'storage',
    'storage',
    'storage',
  ];
  const bindings = device.createBindGroupLayout({
    entries: types.map((type, binding) => ({ binding, visibility: GPUShaderStage.COMPUTE, buffer: { type } })),
  });
  const layout = device.createPipelineLayout({ bindGroupLayouts: [bindings] });
  const entries = buffers.map((buffer, binding) => ({ binding, resource: { buffer } }));
  const group = device.createBindGroup({ layout: bindings, entries });
  const names = ['move_all', 'add', 'relax', 'flash'];
  const [pose, add, relax, flash] = await Promise.all(
    names.map((entryPoint) => device.createComputePipelineAsync({ layout, compute: { module, entryPoint } })),
  );
  return { group, pipeline: { pose: pose!, add: add!, relax: relax!, flash: flash! } };
}

async function read(device: GPUDevice, buffer: GPUBuffer, size: number): Promise<Float32Array<ArrayBuffer>> {
  const staging = device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = device.createCommandEncoder();
  encoder.copyBufferToBuffer(buffer, 0, staging, 0, size);
  device.queue.submit([encoder.finish()]);
  await staging.mapAsync(GPUMapMode.READ);
  const copy = new Float32Array(staging.getMappedRange().slice(0));
  staging.destroy();
  return copy;
}
