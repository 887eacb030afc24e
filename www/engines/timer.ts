/** Starts workers that time an engine, and ends those that take too long. */

import type { Remote } from 'comlink';
import type { Options } from 'edgeflip';
import { WorkerClient } from '../watch/worker-client.ts';
import type { PlainMesh } from './contenders.ts';
import type { Timer, Timing } from './timing.ts';

/** The signal ends the worker and everything that runs in it. */
export function startTimer(signal: AbortSignal): WorkerClient<Timer> {
  const worker = new Worker(new URL('./timing.ts', import.meta.url), { type: 'module' });
  return new WorkerClient<Timer>(worker).closeOn(signal);
}

/** Milliseconds. An engine whose runs take longer is stopped. */
export const LONGEST = 5000;

/** Milliseconds that an engine may take to start: a driver may compile its kernels. */
const START = 30_000;

/** Starts an engine. Returns the milliseconds that it took. */
export const start = (timer: WorkerClient<Timer>, dimension: 2 | 3, options: Options): Promise<number> =>
  within(timer, START, 'it did not start within 30\u00a0s', (worker) => worker.start(dimension, options));

/** Times an engine that has started. Its runs begin in the first half of the time, so that they end in time. */
export const time = (timer: WorkerClient<Timer>, mesh: PlainMesh, options: Options): Promise<Timing> =>
  within(timer, LONGEST, 'stopped after 5\u00a0s', (worker) => worker.time(mesh, options, LONGEST / 2));

/** Calls the worker. If that takes too many milliseconds, ends the worker and throws an error that says `why`. */
async function within<R>(
  timer: WorkerClient<Timer>,
  most: number,
  why: string,
  method: (worker: Remote<Timer>) => Promise<R>,
): Promise<R> {
  let isLate = false;
  const clock = setTimeout(() => {
    isLate = true;
    timer.close();
  }, most);
  try {
    return await timer.call(method);
  } catch (error) {
    throw isLate ? new Error(why) : error;
  } finally {
    clearTimeout(clock);
  }
}

/** The message of an error as a sentence. */
export function sentenceOf(error: unknown): string {
  const message = error instanceof Error ? error.message : String(error);
  return `${message.charAt(0).toUpperCase()}${message.slice(1).replace(/\.?$/, '.')}`;
}
