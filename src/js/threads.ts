/** Sessions on the threads of the CPU engine: workers, each with an instance of one module. They share the memory. */

import { buffersOf } from './buffers.js';
import { fromModule } from './error.js';
import type { IndexedMesh } from './mesh.js';
import { node, Remote, type Script, startThread, type Thread } from './remote.js';
import { reserve } from './reserve.js';
import { FEWEST_EACH, FEWEST_TRIANGLES, MOST_THREADS, type Settings } from './settings.js';
import type { Calls, Question } from './thread.js';
import type { Session } from './wasm/edgeflip.js';

/** The methods of a session, in any module. */
export interface ModuleSession extends Omit<Session, typeof Symbol.dispose | 'update'> {
  /** In a worker, it returns a promise. */
  update(...args: Parameters<Session['update']>): void | Promise<void>;
  /** Whether the session is in a worker, so that it does not block the page. */
  readonly isAway?: boolean;
  /** Takes the module of the repair, if it is not that of this window or worker. */
  takeUntangler?(module: WebAssembly.Module): Promise<void>;
  /** The number of its threads, if they are several. */
  readonly threads?: number;
}

/** Whether workers can share memory. */
const isShared = typeof SharedArrayBuffer !== 'undefined' && (globalThis.crossOriginIsolated ?? node !== undefined);

/** The number of threads of the CPU engine. */
export function threadCount(triangles: number, { threads }: Settings): number {
  if (!isShared || triangles < FEWEST_TRIANGLES) return 1;
  return Math.max(1, Math.min(threads ?? coreCount(), MOST_THREADS, Math.floor(triangles / FEWEST_EACH)));
}

function coreCount(): number {
  return (
    globalThis.navigator?.hardwareConcurrency ??
    (node ? globalThis.process.getBuiltinModule('node:os').availableParallelism() : 1)
  );
}

/** The script of a thread. */
export const script: Script = {
  worker: () => new Worker(new URL('./thread.js', import.meta.url), { type: 'module' }),
  url: () => new URL('./thread.js', import.meta.url),
};

/** The threads that work together. */
class Pool {
  readonly #first: Remote<Calls>;
  readonly #others: Thread[] = [];
  readonly #onEnd: () => void;
  #hasEnded = false;

  private constructor(onEnd: () => void) {
    this.#onEnd = onEnd;
    this.#first = new Remote(script, (message) => this.#fail(message ?? 'a worker could not be loaded'));
  }

  /** The first thread answers calls, the others work with it. */
  static async start(
    module: WebAssembly.Module,
    count: number,
    onEnd: () => void,
  ): Promise<[Pool, WebAssembly.Memory]> {
    const pool = new Pool(onEnd);
    try {
      const memory = await pool.call('start', module, count);
      for (let i = 1; i < count; i++) pool.#add(module, memory);
      return [pool, memory];
    } catch (thrown) {
      pool.#fail(String(thrown));
      throw thrown;
    }
  }

  call<M extends keyof Calls>(method: M, ...args: Parameters<Calls[M]>): Promise<Awaited<ReturnType<Calls[M]>>> {
    return this.#first.call(method, args, { transfer: method === 'open' ? buffersOf(args) : [] });
  }

  #add(module: WebAssembly.Module, memory: WebAssembly.Memory): void {
    const onError = (message?: string) => {
      // If a worker cannot be loaded, the remaining threads do its work.
      if (message !== undefined) this.#fail(message);
    };
    const thread = startThread(script, () => undefined, onError);
    this.#others.push(thread);
    thread.post({ id: -1, method: 'work', args: [module, memory] }, []);
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
type Threads = [pool: Pool, memory: WebAssembly.Memory];

/** The running threads, by their number. */
const started = new Map<number, Promise<Threads>>();

/** Why a mesh runs on one thread, if it could use more. */
export function whyOneThread(triangles: number, { threads }: Settings): string | undefined {
  if (isShared || triangles < FEWEST_TRIANGLES || threads === 1) return undefined;
  return 'workers cannot share memory here; make the page cross-origin isolated, by the headers COOP and COEP';
}

/** Starts `count` threads, or returns them if they are running. Sessions share them. */
export function threadsOf(module: WebAssembly.Module, count: number): Promise<Threads> {
  let threads = started.get(count);
  if (!threads) {
    threads = Pool.start(module, count, () => started.delete(count));
    started.set(count, threads);
  }
  return threads;
}

let sessions = 0;

/** Frees the memory of sessions that the garbage collection has removed. */
const dropped = new FinalizationRegistry<() => void>((free) => free());

/** A session that the first thread holds. */
export class ThreadsSession implements ModuleSession {
  iterations = 0;
  flips = 0;
  readonly backend = 'cpu';
  readonly isAway = true;
  readonly isSettled = true;
  stays = false;
  readonly gpu = undefined;
  readonly #pool: Pool;
  readonly #memory: WebAssembly.Memory;
  readonly #session: number;
  readonly #fallback: string | undefined;
  readonly #free: () => void;
  /** The array for the next copy of triangles. */
  #spare: Uint32Array | undefined;

  private constructor(
    [pool, memory]: Threads,
    readonly threads: number,
    session: number,
    spare: Uint32Array | undefined,
    fallback: string | undefined,
  ) {
    this.#pool = pool;
    this.#memory = memory;
    this.#spare = spare;
    this.#session = session;
    this.#fallback = fallback;
    // After a crash the memory is gone with the threads.
    this.#free = () => void pool.call('free', session).catch(() => undefined);
    dropped.register(this, this.#free, this);
  }

  /**
   * As `Session.create`, but transfers the arrays of the mesh. The worker gets all settings except the device, which
   * cannot be sent.
   *
   * @param fallback - Why `'auto'` chose the CPU.
   */
  static async create(
    threads: Threads,
    count: number,
    { positions, indices, dimension }: IndexedMesh,
    { device, ...settings }: Settings,
    fallback?: string,
  ): Promise<ThreadsSession> {
    const [pool] = threads;
    const [session, { length }] = [sessions++, indices];
    const opened = pool.call('open', session, { positions, indices, dimension }, { ...settings, backend: 'cpu' });
    const spare = reserve(length);
    await opened;
    return new ThreadsSession(threads, count, session, spare, fallback);
  }

  step = () => this.#ask('step');
  advance = () => this.#ask('advance');
  triangles = async () => this.#copy(await this.#ask('triangles'));
  edges = () => this.#ask('edges');
  edgeStates = () => this.#ask('edgeStates');
  auditInput = () => this.#ask('auditInput');
  settle = () => Promise.resolve();
  changes = () => this.#ask('changes');
  counters = () => this.#ask('counters');
  update = (...args: Parameters<Session['update']>) => this.#ask('update', ...args);
  takeUntangler = (module: WebAssembly.Module) => this.#pool.call('takeUntangler', module);
  setPositions = (positions: Float32Array | Float64Array) => this.#ask('setPositions', positions);

  async outcome(): ReturnType<Session['outcome']> {
    const outcome = await this.#ask('outcome');
    return { ...outcome, indices: this.#copy(outcome.indices), fallback: this.#fallback };
  }

  free(): void {
    dropped.unregister(this);
    this.#free();
  }

  /** Copies indices from the shared memory. */
  #copy([address, length]: Uint32Array): Uint32Array {
    try {
      const copy = this.#spare ?? new Uint32Array(length!);
      this.#spare = undefined;
      copy.set(new Uint32Array(this.#memory.buffer, address, length));
      return copy;
    } finally {
      void this.#pool.call('release', this.#session).catch(() => undefined);
    }
  }

  async #ask<Q extends Question>(
    question: Q,
    ...args: Parameters<Session[Q]>
  ): Promise<Awaited<ReturnType<Session[Q]>>> {
    const { value, iterations, flips } = await this.#pool.call('ask', this.#session, question, args);
    this.iterations = iterations;
    this.flips = flips;
    return value as Awaited<ReturnType<Session[Q]>>;
  }
}
