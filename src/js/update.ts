/** Reads the options of an update once: checks their types and copies them. */

import { EdgeflipError } from './error.js';
import { copyTo, type Source, sourceOf } from './gather.js';
import { isWhole, read, shown } from './given.js';
import type { Heights } from './heights.js';
import { type AllPlaces, spaceOf } from './mesh.js';
import type { Floats } from './plane.js';
import { namesOf, optionsOf } from './names.js';
import { type Hold, MOST_ITERATIONS } from './settings.js';
import type { SessionBuffers } from './session-buffers.js';
import type { UpdateOptions } from './types.js';

/** The options of an update without a buffer: in a worker, which none can enter, all. */
export type WorkerUpdateOptions = Pick<UpdateOptions, 'positions' | 'iterations'>;

/** The options of an update, read. */
export interface Update {
  /** All coordinates, with those that a plane leaves out. */
  positions: Floats | undefined;
  buffer: Source | undefined;
  iterations: number;
}

const UPDATE_OPTIONS = namesOf<UpdateOptions>({
  positions: true,
  buffer: true,
  offset: true,
  stride: true,
  iterations: true,
});

export const WORKER_UPDATE_OPTIONS = namesOf<WorkerUpdateOptions>({ positions: true, iterations: true });

/** Iterations of an update, if the caller gives no number. */
const ITERATIONS = 4;

/**
 * The options of an update.
 *
 * @throws {@link EdgeflipError} `invalid-option`, `invalid-input`, `ragged-array`, `position-count`.
 */
export function updateOf(
  options: UpdateOptions,
  layout: AllPlaces,
  hold: Hold,
  known: readonly string[] = UPDATE_OPTIONS,
): Update {
  return read('the options', () => {
    const given = optionsOf(options, known) as UpdateOptions;
    const { positions, buffer, iterations = ITERATIONS } = given;
    // Positions have the stride and the offset of the mesh.
    if (buffer === undefined) optionsOf(given, WORKER_UPDATE_OPTIONS);
    if (!isWhole(iterations) || iterations > MOST_ITERATIONS) {
      const message = `option iterations: ${shown(iterations)} is not a whole number from 0 to ${MOST_ITERATIONS}`;
      throw new EdgeflipError('invalid-option', message);
    }
    if (positions !== undefined && buffer !== undefined) {
      throw new EdgeflipError('invalid-option', 'options positions and buffer: give only one of them');
    }
    return {
      positions: positions === undefined ? undefined : spaceOf(positions, layout, hold),
      buffer: buffer === undefined ? undefined : sourceOf(given, layout),
      iterations,
    };
  });
}

/**
 * Gives the engine of a session the positions on its device that the page has written to a buffer.
 *
 * @throws {@link EdgeflipError} `invalid-option`.
 */
export function takeOnDevice(
  { gpu, backend }: { readonly gpu?: SessionBuffers | undefined; readonly backend: string },
  buffer: Source | undefined,
  { dimension, vertices }: AllPlaces,
  heights: Heights | undefined,
): void {
  if (!gpu) {
    if (!buffer) return;
    const message = `option buffer: the session is on ${backend}, not on a device that has buffers`;
    throw new EdgeflipError('invalid-option', message);
  }
  if (heights) heights.moveOn(gpu, buffer);
  else if (buffer) copyTo(gpu.device, buffer, gpu.positions, [0, 1, 2].slice(0, dimension), vertices);
}
