/** Sessions on the threads of the CPU engine. */

import { buffersOf } from './buffers.js';
import type { IndexedMesh } from './mesh.js';
import { type Pool, starter, type Threads } from './pool.js';
import type { Script } from './remote.js';
import { reserve } from './reserve.js';
import type { Settings } from './settings.js';
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

/** The script of a thread. */
export const script: Script = {
  worker: () => new Worker(new URL('./thread.js', import.meta.url), { type: 'module' }),
  url: () => new URL('./thread.js', import.meta.url),
};

/** Starts `count` threads, or returns them if they are running. Sessions share them. */
export const threadsOf = starter<Calls>(script);

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
  readonly #pool: Pool<Calls>;
  readonly #memory: WebAssembly.Memory;
  readonly #session: number;
  readonly #fallback: string | undefined;
  readonly #free: () => void;
  /** The array for the next copy of triangles. */
  #spare: Uint32Array | undefined;

  private constructor(
    [pool, memory]: Threads<Calls>,
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
    this.#free = () => void pool.call('free', [session]).catch(() => undefined);
    dropped.register(this, this.#free, this);
  }

  /**
   * As `Session.create`, but transfers the arrays of the mesh. The worker gets all settings except the device, which
   * cannot be sent.
   *
   * @param fallback - Why `'auto'` chose the CPU.
   */
  static async create(
    threads: Threads<Calls>,
    count: number,
    { positions, indices, dimension }: IndexedMesh,
    { device, ...settings }: Settings,
    fallback?: string,
  ): Promise<ThreadsSession> {
    const [pool] = threads;
    const [session, { length }] = [sessions++, indices];
    const mesh = { positions, indices, dimension };
    const transfer = buffersOf([mesh, settings]);
    const opened = pool.call('open', [session, mesh, { ...settings, backend: 'cpu' }], { transfer });
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
  takeUntangler = (module: WebAssembly.Module) => this.#pool.call('takeUntangler', [module]);
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
      void this.#pool.call('release', [this.#session]).catch(() => undefined);
    }
  }

  async #ask<Q extends Question>(
    question: Q,
    ...args: Parameters<Session[Q]>
  ): Promise<Awaited<ReturnType<Session[Q]>>> {
    const { value, iterations, flips } = await this.#pool.call('ask', [this.#session, question, args]);
    this.iterations = iterations;
    this.flips = flips;
    return value as Awaited<ReturnType<Session[Q]>>;
  }
}
