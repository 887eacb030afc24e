/** How the worker says what an error means for the page: by the name of what it throws. */

import { EdgeflipError } from 'edgeflip/files';

/** Its WebAssembly module has crashed. */
export const CRASHED = 'Crashed';
/** The GPU that its run was on is lost. */
export const LOST = 'Lost';

/** Names the errors that the page tells apart: names get through to it, codes do not. */
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
