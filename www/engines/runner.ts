/** Starts and ends workers that time an engine. */

import { wrap, type Remote } from 'comlink';
import type { Timer } from './timing.ts';

/** A worker, and the proxy of its {@link Timer}. */
export class Runner {
  readonly #worker = new Worker(new URL('./timing.ts', import.meta.url), { type: 'module' });
  readonly #timer: Remote<Timer> = wrap<Timer>(this.#worker);
  readonly #failed: Promise<never>;

  /** The signal ends the worker and everything that runs in it. */
  constructor(signal: AbortSignal) {
    this.#failed = new Promise((_, reject) => {
      this.#worker.onerror = ({ message }) =>
        reject(new Error(message || 'the worker of the page could not be loaded'));
      const stop = () => {
        this.#worker.terminate();
        reject(signal.reason);
      };
      // A signal that is aborted already tells nobody.
      if (signal.aborted) stop();
      else signal.addEventListener('abort', stop);
    });
    this.#failed.catch(() => {});
  }

  ask<T>(question: (timer: Remote<Timer>) => Promise<T>): Promise<T> {
    return Promise.race([question(this.#timer), this.#failed]);
  }

  close(): void {
    this.#worker.terminate();
  }
}

/** The message of an error as a sentence. */
export function sentenceOf(error: unknown): string {
  const message = error instanceof Error ? error.message : String(error);
  return `${message.charAt(0).toUpperCase()}${message.slice(1).replace(/\.?$/, '.')}`;
}
