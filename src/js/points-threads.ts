/** The threads of the triangulation of points. */

import { buffersOf } from './buffers.js';
import type { Calls } from './points-thread.js';
import { starter } from './pool.js';

/** Triangulates on threads. Transfers the coordinates. */
export type Triangulator = (coordinates: Float32Array | Float64Array) => Promise<ReturnType<Calls['triangulate']>>;

const threadsOf = starter<Calls>({
  worker: () => new Worker(new URL('./points-thread.js', import.meta.url), { type: 'module' }),
  url: () => new URL('./points-thread.js', import.meta.url),
});

/** Starts `count` threads of the module, unless they are running. */
export async function triangulatorOn(module: WebAssembly.Module, count: number): Promise<Triangulator> {
  const [pool] = await threadsOf(module, count);
  return (coordinates) => pool.call('triangulate', [coordinates], { transfer: buffersOf(coordinates) });
}
