/** Starts workers that time an engine. */

import { WorkerClient } from '../watch/worker-client.ts';
import type { Timer } from './timing.ts';

/** The signal ends the worker and everything that runs in it. */
export function startTimer(signal: AbortSignal): WorkerClient<Timer> {
  const worker = new Worker(new URL('./timing.ts', import.meta.url), { type: 'module' });
  return new WorkerClient<Timer>(worker).closeOn(signal);
}

/** The message of an error as a sentence. */
export function sentenceOf(error: unknown): string {
  const message = error instanceof Error ? error.message : String(error);
  return `${message.charAt(0).toUpperCase()}${message.slice(1).replace(/\.?$/, '.')}`;
}
