/** The names of errors by which the worker tells the page what to do. */

import { EdgeflipError } from 'edgeflip/files';

/** The WebAssembly module of the worker has crashed. */
export const CRASHED = 'Crashed';
/** The GPU of the worker's run was lost. */
export const LOST = 'Lost';

/**
 * Gives names to the errors that the page handles. Comlink sends the name of an error to the page, but not its code.
 */
export async function naming<T>(work: Promise<T>): Promise<T> {
  try {
    return await work;
  } catch (error) {
    if (!(error instanceof EdgeflipError)) throw error;
    const { code, message } = error;
    if (code === 'internal') throw Object.assign(new Error(`The worker has crashed: ${message}`), { name: CRASHED });
    if (code === 'device-failed') throw Object.assign(new Error(message), { name: LOST });
    throw error;
  }
}
