/** A thread of the triangulation of points: a worker. The first worker answers calls. */

import { begin } from './begin.js';
import { answerCalls } from './remote.js';
import { initSync, startThreads, triangulate, work } from './wasm/edgeflip_points_threads.js';

const calls = {
  ...begin({ initSync, startThreads, work }),
  /** The arrays of the result are the caller's: their buffers are transferred. */
  triangulate: (...args: Parameters<typeof triangulate>) => triangulate(...args),
};

export type Calls = typeof calls;

// Errors of the library have a code, and a RangeError is of an array of JavaScript for the result. After any other, the
// shared memory may be corrupt, so the client ends all threads.
answerCalls(calls, (thrown) => !(thrown instanceof RangeError || (thrown instanceof Error && 'code' in thrown)));
