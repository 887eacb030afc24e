/** Calls a worker of the page. */

import { wrap, type Remote } from 'comlink';
import { CRASHED } from './crash.ts';
import type { MeshWorker } from './mesh-worker.ts';

/** The error of a call whose worker was closed. */
export class Cancelled extends Error {}

/** A worker, and the proxy of the object that it exposes: a {@link MeshWorker}, if no other worker is given. */
export class WorkerClient<T = MeshWorker> {
  readonly #worker: Worker;
  readonly #remote: Remote<T>;
  readonly #failed: Promise<never>;
  #fail: (error: Error) => void = () => {};

  constructor(worker = new Worker(new URL('./mesh-worker.ts', import.meta.url), { type: 'module' })) {
    this.#worker = worker;
    this.#remote = wrap<T>(worker);
    this.#failed = new Promise((_, reject) => (this.#fail = reject));
    this.#failed.catch(() => {});
    worker.onerror = ({ message }) =>
      this.#fail(new Error(`The page’s worker failed: ${message || 'it could not be loaded'}`));
  }

  /** Calls the object in the worker. If the worker is closed, the call fails. */
  async call<R>(method: (remote: Remote<T>) => Promise<R>): Promise<R> {
    try {
      return await Promise.race([method(this.#remote), this.#failed]);
    } catch (error) {
      // A WebAssembly module cannot be used after a crash, so all later calls fail.
      if (error instanceof Error && error.name === CRASHED) this.#fail(error);
      throw error;
    }
  }

  /** Ends the worker and everything that runs in it. */
  close(): void {
    this.#worker.terminate();
    // Comlink keeps the worker until its proxies are collected. Through this handler, the worker would keep the
    // proxies.
    this.#worker.onerror = null;
    this.#fail(new Cancelled());
  }

  /** Closes the worker when the signal is aborted, also if it is aborted already. */
  closeOn(signal: AbortSignal): this {
    if (signal.aborted) this.close();
    else signal.addEventListener('abort', () => this.close());
    return this;
  }
}
