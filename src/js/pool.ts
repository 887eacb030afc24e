/** Threads: workers, each with an instance of one module. They share the memory. */

import { fromModule } from './error.js';
import { type Functions, Remote, type Script, type Sending, startThread, type Thread } from './remote.js';

/** The call that makes a worker the first of a pool. */
type Start = { start(module: WebAssembly.Module, count: number): WebAssembly.Memory };

/** The threads that work together. */
export class Pool<F extends Functions> {
  readonly #first: Remote<F>;
  readonly #others: Thread[] = [];
  readonly #onEnd: () => void;
  #hasEnded = false;

  private constructor(script: Script, onEnd: () => void) {
    this.#onEnd = onEnd;
    this.#first = new Remote(script, (message) => this.#fail(message ?? 'a worker could not be loaded'));
  }

  /** The first thread answers calls, the others work with it. */
  static async start<F extends Functions>(
    script: Script,
    module: WebAssembly.Module,
    count: number,
    onEnd: () => void,
  ): Promise<Threads<F>> {
    const pool = new Pool<F>(script, onEnd);
    try {
      // All load at the same time.
      for (let i = 1; i < count; i++) pool.#add(script);
      const memory = await (pool as unknown as Pool<Start>).call('start', [module, count]);
      for (const thread of pool.#others) thread.post({ id: -1, method: 'work', args: [module, memory] }, []);
      return [pool, memory];
    } catch (thrown) {
      pool.#fail(String(thrown));
      throw thrown;
    }
  }

  /** Calls a function of the first thread. */
  call<M extends keyof F & string>(
    method: M,
    args: Parameters<F[M]>,
    sending?: Sending,
  ): Promise<Awaited<ReturnType<F[M]>>> {
    return this.#first.call(method, args, sending);
  }

  #add(script: Script): void {
    const onError = (message?: string) => {
      // If a worker cannot be loaded, the remaining threads do its work.
      if (message !== undefined) this.#fail(message);
    };
    this.#others.push(startThread(script, () => undefined, onError));
  }

  /** Ends all threads: after a crash of one, their shared memory may be corrupt. */
  #fail(message: string): void {
    if (this.#hasEnded) return;
    this.#hasEnded = true;
    this.#onEnd();
    for (const thread of this.#others.splice(0)) thread.end();
    this.#first.end(fromModule(new Error(`a thread has crashed: ${message}`)));
  }
}

/** Threads and their memory. */
export type Threads<F extends Functions> = [pool: Pool<F>, memory: WebAssembly.Memory];

/** A function that starts `count` threads, or returns them if they are running. All callers share them. */
export function starter<F extends Functions>(
  script: Script,
): (module: WebAssembly.Module, count: number) => Promise<Threads<F>> {
  const started = new Map<number, Promise<Threads<F>>>();
  return (module, count) => {
    let threads = started.get(count);
    if (!threads) {
      threads = Pool.start<F>(script, module, count, () => started.delete(count));
      started.set(count, threads);
    }
    return threads;
  };
}
