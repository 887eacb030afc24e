/** Where the flips happen: on the GPU that the page draws with, or in a worker, on WebGL2 or the CPU. */

import { wrap, type Remote } from 'comlink';
import { EdgeflipError, type Options } from 'edgeflip';
import { ArrayTrack } from './array-track.ts';
import { CRASHED } from './crash.ts';
import type { Desk } from './desk.ts';
import { GpuTrack } from './gpu-track.ts';
import { Kernels } from './kernels.ts';
import { Run, sessionOf, statesOf, summaryOf, type Backend, type OpenMesh } from './run.ts';

/** So many triangles at most the CPU takes before a GPU has compiled its programs. */
const BEGUN_SOON = 1_000_000;

/** A GPU that both the flips and the drawing use. */
export interface Gpu {
  device: GPUDevice;
  kernels: Kernels;
  /** Whether the processor plays it: `auto` leaves it alone then. */
  isSoftware: boolean;
}

/** The GPU of this browser, or why there is none. */
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

/** Older browsers say it of the adapter, newer ones of its information. */
function isSoftware(adapter: GPUAdapter & { isFallbackAdapter?: boolean }): boolean {
  const { isFallbackAdapter }: { isFallbackAdapter?: boolean } = adapter.info;
  return isFallbackAdapter ?? adapter.isFallbackAdapter ?? false;
}

/** The GPU that `auto` takes, or why it takes none. */
export function forAuto(gpu: Gpu | string): Gpu | string {
  if (typeof gpu === 'string' || !gpu.isSoftware) return gpu;
  return 'no hardware GPU found; the browser emulates one in software, which is slower';
}

/** A worker with the desk that it answers at. */
export class Office {
  readonly #worker = new Worker(new URL('./desk.ts', import.meta.url), { type: 'module' });
  readonly #desk: Remote<Desk> = wrap<Desk>(this.#worker);
  readonly #failed: Promise<never>;
  #fail: (error: Error) => void = () => {};

  constructor() {
    this.#failed = new Promise((_, reject) => (this.#fail = reject));
    this.#failed.catch(() => {});
    this.#worker.onerror = ({ message }) =>
      this.#fail(new Error(`The page’s worker failed: ${message || 'it could not be loaded'}`));
  }

  /** Asks the desk. Closing the office ends the wait too. */
  async ask<T>(question: (desk: Remote<Desk>) => Promise<T>): Promise<T> {
    try {
      return await Promise.race([question(this.#desk), this.#failed]);
    } catch (error) {
      // A WebAssembly module that has crashed stays so.
      if (error instanceof Error && error.name === CRASHED) this.#fail(error);
      throw error;
    }
  }

  /** Stops whatever goes on in it. */
  close(): void {
    this.#worker.terminate();
    // Comlink holds the worker until its proxies are collected, and they would be held by the worker through this.
    this.#worker.onerror = null;
    this.#fail(new Cancelled());
  }
}

/** What a call ends with whose worker has been closed. */
export class Cancelled extends Error {}

/** The worker of the first run. */
let first: Office | undefined;

/** Starts it, with its engine, while there is no mesh yet. */
export function startWorker(): void {
  first = new Office();
  // The run tries again, and says what is wrong.
  first.ask((desk) => desk.load()).catch(() => {});
}

/** Whether a run waits until the GPU has been looked for, and compiles. */
export function waitsForGpu({ indices }: OpenMesh, backend: Backend): boolean {
  return backend === 'webgpu' || (backend === 'auto' && indices.length > 3 * BEGUN_SOON);
}

/**
 * Begins a run. `auto` begins on the CPU while the GPU is looked for, which `undefined` stands for, or has not compiled.
 *
 * @throws an error that can be shown, about the mesh, β or the backend that was asked for.
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

/** Begins the run that takes the place of one on the CPU, once the picture on screen has been drawn. */
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
    if (!shared) throw new Error('the session shows no buffers');
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

/** The run has a worker of its own, so that another one can go on beside it, and ends with it. */
async function inWorker(
  mesh: OpenMesh,
  options: Options,
  signal: AbortSignal,
  fallback: string | undefined,
): Promise<Run> {
  const office = first ?? new Office();
  first = undefined;
  const close = () => office.close();
  signal.addEventListener('abort', close);
  try {
    signal.throwIfAborted();
    const states = await office.ask((desk) => desk.open(mesh, options));
    const stepper = {
      step: () => office.ask((desk) => desk.step()),
      result: () => office.ask((desk) => desk.result()),
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
