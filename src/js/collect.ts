/** Makes JavaScript collect garbage when memory runs out. */

import { fromModule } from './error.js';
import { turn } from './turn.js';

/** The bytes of each array that starts a garbage collection, and the number of arrays. */
const [BALLAST, ROUNDS] = [2 ** 30, 4];

/**
 * Opens a session. If memory runs out, tries once more after a garbage collection, which frees unreachable sessions.
 * JavaScript does not count their memory in WebAssembly, so allocating a large array starts the collection.
 */
export async function collecting<T>(open: () => Promise<T>): Promise<T> {
  try {
    return await open();
  } catch (thrown) {
    if (fromModule(thrown).code !== 'too-large') throw thrown;
    for (let round = 0; round < ROUNDS; round++) {
      try {
        void new ArrayBuffer(BALLAST);
      } catch {
        // An allocation that fails has started a collection too.
      }
      await turn();
    }
    return open();
  }
}
