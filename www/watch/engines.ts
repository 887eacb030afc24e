/** Starts runs: on the GPU that the page draws with, or in a worker, on WebGL2 or the CPU. */

import { EdgeflipError, type Options } from 'edgeflip';
import { isSoftware } from '../shell/adapter.ts';
import { takeRunner } from './ahead.ts';
import { ArrayTrack } from './array-track.ts';
import { GpuTrack } from './gpu-track.ts';
import { Kernels } from './kernels.ts';
import { Run, sessionOf, statesOf, summaryOf, type Backend, type OpenMesh } from './run.ts';

/** The most triangles with which `auto` starts on the CPU while the GPU compiles its kernels. */
const MOST_ON_CPU = 1_000_000;

/** The GPU that both the flips and the drawing use. */
export interface Gpu {
  device: GPUDevice;
  kernels: Kernels;
  /** Whether the browser emulates it in software. `auto` does not use it then. */
  isSoftware: boolean;
}

/** Opens the GPU of this browser, or returns why there is none. */
export async function openGpu(): Promise<Gpu | string> {
  if (!navigator.gpu) return 'this browser has no WebGPU';
  try {
    const adapter = await navigator.gpu.requestAdapter({ powerPreference: 'high-performance' });
    if (!adapter) return 'WebGPU found no GPU';
    const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
    const device = await adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
    return { device, kernels: new Kernels(device), isSoftware: isSoftware(adapter) };
  } catch (error) {
    return `WebGPU could not be used (${error instanceof Error ? error.message : String(error)})`;
  }
}

/** The GPU that `auto` uses, or why it uses none. */
export function forAuto(gpu: Gpu | string): Gpu | string {
  if (typeof gpu === 'string' || !gpu.isSoftware) return gpu;
  return 'no hardware GPU found; the browser emulates one in software, which is slower';
}

/** Whether a run waits until the GPU is open and has compiled its kernels. */
export function waitsForGpu({ indices }: OpenMesh, backend: Backend): boolean {
  return backend === 'webgpu' || (backend === 'auto' && indices.length > 3 * MOST_ON_CPU);
}

/**
 * Starts a run. `auto` starts on the CPU if the GPU is not open yet (`undefined`) or has not compiled its kernels.
 *
 * @throws an error for the user about the mesh, β or the chosen engine.
 */
export async function beginRun(
  mesh: OpenMesh,
  options: Options & { backend: Backend },
  gpu: Gpu | string | undefined,
  signal: AbortSignal,
): Promise<Run> {
  const { backend } = options;
  const onCpu = (fallback?: string) => inWorker(mesh, { ...options, backend: 'cpu' }, signal, fallback);
  if (backend === 'webgl2' || backend === 'cpu') return inWorker(mesh, options, signal, undefined);
  if (gpu === undefined) return onCpu();
  const usable = backend === 'auto' ? forAuto(gpu) : gpu;
  if (typeof usable === 'string') {
    if (backend === 'webgpu') throw new Error(`The WebGPU engine is not available: ${usable}.`);
    return onCpu(usable);
  }
  const takesGpu = waitsForGpu(mesh, backend) || usable.kernels.areReadyFor(mesh);
  if (!takesGpu) return onCpu();
  try {
    return await onGpu(mesh, options, usable);
  } catch (error) {
    const isOfGpu = error instanceof EdgeflipError && /^(backend|device)-/.test(error.code);
    if (backend === 'webgpu' || !isOfGpu) throw error;
    return onCpu(error.message);
  }
}

/** Starts the run that replaces a run on the CPU, after the GPU has drawn the present picture. */
export async function beginBehind(mesh: OpenMesh, options: Options, gpu: Gpu): Promise<Run> {
  await new Promise(requestAnimationFrame);
  await gpu.device.queue.onSubmittedWorkDone();
  return onGpu(mesh, options, gpu);
}

async function onGpu(mesh: OpenMesh, options: Options, { device, kernels }: Gpu): Promise<Run> {
  await kernels.makeReadyFor(mesh);
  const session = await sessionOf(mesh, { ...options, backend: 'webgpu', device });
  try {
    const shared = await session.gpu();
    if (!shared) throw new Error('the session has no buffers on the GPU');
    const { length } = mesh.indices;
    const stepper = {
      async step() {
        const iteration = await session.step();
        return iteration && { iteration, states: await statesOf(session, length) };
      },
      result: () => summaryOf(session),
      free: () => session.free(),
    };
    const states = await statesOf(session, length);
    const track = await GpuTrack.create(device, shared.indices, length);
    return new Run(false, undefined, stepper, track, states);
  } catch (error) {
    session.free();
    throw error;
  }
}

/** Starts a run in a worker of its own, so that another run can continue meanwhile. The worker ends with the run. */
async function inWorker(
  mesh: OpenMesh,
  options: Options,
  signal: AbortSignal,
  fallback: string | undefined,
): Promise<Run> {
  const client = takeRunner();
  const close = () => client.close();
  signal.addEventListener('abort', close);
  try {
    signal.throwIfAborted();
    const states = await client.call((worker) => worker.open(mesh, options));
    const stepper = {
      step: () => client.call((worker) => worker.step()),
      result: () => client.call((worker) => worker.result()),
      free: close,
    };
    return new Run(true, fallback, stepper, new ArrayTrack(mesh.indices), states);
  } catch (error) {
    close();
    throw error;
  } finally {
    signal.removeEventListener('abort', close);
  }
}
