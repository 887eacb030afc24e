/** Collects what nobody uses any more, where there is no memory left. */

import { fromModule } from './error.js';
import { turn } from './turn.js';

/** Bytes that nobody writes to, and how often they are asked for. */
const [BALLAST, ROUNDS] = [2 ** 30, 4];

/**
 * Opens a session; where there is no memory for it, once more after sessions that nobody uses any more are collected.
 * JavaScript does not see what they have in WebAssembly, so it is shown an array of that size, and collects then.
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
        // Then it has seen enough.
      }
      await turn();
    }
    return open();
  }
}
