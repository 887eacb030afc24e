/** How the worker says that its WebAssembly module has crashed: what it throws has this name. */

import { EdgeflipError } from 'edgeflip/files';

export const CRASHED = 'Crashed';

/** Names the errors after which the module is of no use: names get through to the page, codes do not. */
export async function naming<T>(work: Promise<T>): Promise<T> {
  try {
    return await work;
  } catch (error) {
    if (error instanceof EdgeflipError && error.code === 'internal') {
      throw Object.assign(new Error(`The worker has crashed: ${error.message}`), { name: CRASHED });
    }
    throw error;
  }
}
