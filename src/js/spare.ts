/**
 * Memory for results that a GPU writes, from a worker. The system provides new memory page by page, at the first write
 * to each. For a large result that takes longer than the GPU needs, so a worker does it meanwhile. The worker starts with
 * the first large mesh. Until it has answered, and wherever it cannot be started, the page makes the memory itself.
 */

import { EdgeflipError } from './error.js';
import type { IndexedMesh } from './mesh.js';
import { Remote } from './remote.js';
import type { GpuSettings } from './settings.js';
import type { Calls } from './thread.js';
import { script } from './threads.js';
import { whyCpu } from './wasm/edgeflip.js';

/** What decides whether a mesh goes to a GPU, besides its size. */
interface Shape {
  dimension: IndexedMesh['dimension'];
  isDouble: boolean;
}

let worker: Remote<Calls> | undefined;
let isReady = false;

function start(): void {
  const started: Remote<Calls> = new Remote<Calls>(script, (message = 'it could not be loaded') => {
    isReady = false;
    started.end(new EdgeflipError('load-failed', `the worker has ended: ${message}`));
  });
  worker = started;
  started.call('reserve', [1]).then(
    () => (isReady = true),
    () => undefined,
  );
}

/**
 * Memory for so many indices, the result of a mesh that goes to a GPU; the promise may have none. `undefined` for other
 * meshes, and if no worker can make it, or not yet.
 */
export function spareFor(
  indices: number,
  { dimension, isDouble }: Shape,
  settings: GpuSettings,
): Promise<Uint32Array | undefined> | undefined {
  const { backend = 'auto', order, leavesCpu, device } = settings;
  // On a device of the page, triangles mostly stay.
  if (device || order === 'any' || (backend !== 'auto' && backend !== 'webgpu')) return undefined;
  const isSure = leavesCpu || backend === 'webgpu';
  if (!isSure && whyCpu(indices / 3, dimension, isDouble, 1, settings) !== undefined) return undefined;
  try {
    if (!worker) start();
    return isReady ? worker!.call('reserve', [indices]).catch(() => undefined) : undefined;
  } catch {
    return undefined;
  }
}
