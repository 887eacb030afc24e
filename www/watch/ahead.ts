/** Starts what the tool waits for while its code is still loading: the GPU, and the workers that read and run a mesh. */

import { WorkerClient } from './worker-client.ts';

/** The GPU of this browser, and a device on it; `undefined` if there is none. */
type Found = { adapter: GPUAdapter; device: GPUDevice } | undefined;

let gpu: Promise<Found> | undefined;
let reader: WorkerClient | undefined;
let runner: WorkerClient | undefined;

/** Call it before the tool starts. Who takes something later gets its error. */
export function startAhead(): void {
  reader ??= new WorkerClient();
  reader.call((worker) => worker.loadFiles()).catch(() => {});
  runner ??= new WorkerClient();
  runner.call((worker) => worker.load()).catch(() => {});
  // Last, because a browser may take a while before it even returns the promise.
  gpu ??= request();
  gpu.catch(() => {});
}

/**
 * The device that was requested ahead, or another one.
 *
 * @throws if the browser fails.
 */
export function takeGpu(): Promise<Found> {
  const taken = gpu ?? request();
  gpu = undefined;
  return taken;
}

/** The worker that can read files soonest. */
export function takeReader(): WorkerClient {
  const taken = reader ?? new WorkerClient();
  reader = undefined;
  return taken;
}

/** The worker that can run an engine soonest. */
export function takeRunner(): WorkerClient {
  const taken = runner ?? new WorkerClient();
  runner = undefined;
  return taken;
}

async function request(): Promise<Found> {
  const adapter = await navigator.gpu?.requestAdapter({ powerPreference: 'high-performance' });
  if (!adapter) return undefined;
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  const device = await adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
  return { adapter, device };
}
