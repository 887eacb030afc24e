/** The threads of the triangulation of points. */

import { buffersOf } from './buffers.js';
import type { Places } from './coordinates.js';
import type { Calls } from './points-thread.js';
import { starter } from './pool.js';

/** Triangulates on threads. Transfers the coordinates and the constraints. */
export type Triangulator = (
  coordinates: Float32Array | Float64Array,
  places: Places,
) => Promise<ReturnType<Calls['triangulate']>>;

const threadsOf = starter<Calls>({
  worker: () => new Worker(new URL('./points-thread.js', import.meta.url), { type: 'module' }),
  url: () => new URL('./points-thread.js', import.meta.url),
});

/** Starts `count` threads of the module, unless they are running. */
export async function triangulatorOn(module: WebAssembly.Module, count: number): Promise<Triangulator> {
  const [pool] = await threadsOf(module, count);
  return (coordinates, { constraints, skipConstraints = false }) => {
    const args: Parameters<Calls['triangulate']> = [coordinates, constraints, skipConstraints];
    return pool.call('triangulate', args, { transfer: buffersOf(args) });
  };
}
