/**
 * The entry `edgeflip` in a worker, so that no run blocks the page: all names but `makeDelaunaySync`, and the same
 * results. The worker starts with the first call, and all calls share it.
 *
 * ```ts
 * import { makeDelaunay } from 'edgeflip/worker';
 * const { indices } = await makeDelaunay(mesh, { onProgress: ({ flips }) => show(flips) });
 * ```
 *
 * A `GPUDevice` and its buffers cannot leave a worker or enter it: there is no option `device` and no method `gpu`.
 *
 * @packageDocumentation
 */

/// <reference lib="esnext.disposable" preserve="true" />

import type { Audit, Problems } from './audit.js';
import { buffersOf } from './buffers.js';
import { dispose } from './dispose.js';
import { EdgeflipError, fromModule } from './error.js';
import { copyOf, messageOf, read } from './given.js';
import { type Layout, readMesh, spaceOf, widthOf } from './mesh.js';
import { type ModuleSource, type Sources, sourcesOf } from './module.js';
import { namesOf } from './names.js';
import { Remote } from './remote.js';
import { RUN_OPTIONS, settingsOf, type Watch, WORKER_MAKE_OPTIONS, WORKER_OPTIONS, watchOf } from './settings.js';
import type {
  Counters,
  Edges,
  Engine,
  IndexArray,
  Indices,
  Iteration,
  MakeDelaunayOptions,
  Mesh,
  Options,
  Progress,
  Result,
  RunOptions,
} from './types.js';
import { updateOf, WORKER_UPDATE_OPTIONS, type WorkerUpdateOptions } from './update.js';
import type { Functions, Question, Watched } from './worker-script.js';

export type { Audit, Problems } from './audit.js';
export { EDGE_STATES, type EdgeState } from './edge-states.js';
export { EdgeflipError, type ErrorCode } from './error.js';
export type { ModuleSource, Sources } from './module.js';
export type { SessionBuffers } from './session-buffers.js';
export type * from './types.js';

/** The options of a session in the worker. */
export type WorkerOptions = Omit<Options, 'device'>;

export type { WorkerUpdateOptions };

/** The options of {@link makeDelaunay} in the worker. */
export type WorkerMakeOptions = Omit<MakeDelaunayOptions, 'device'>;

let remote: Remote<Functions> | undefined;
let numbers = 0;

/** The sources that `init` was given; a new worker gets them too. */
const given: Record<string, ModuleSource> = {};

/** @throws {@link EdgeflipError} `load-failed`. */
function notStarted(why: string): EdgeflipError {
  const remedy = "serve dist/worker-script.js from the origin of the page, and allow it in a policy: worker-src 'self'";
  return new EdgeflipError('load-failed', `worker-script.js could not be started as a worker: ${why}; ${remedy}`);
}

/** The worker. If it ends by an error, the next call starts another. */
function worker(): Remote<Functions> {
  if (remote) return remote;
  const script = {
    worker: () => new Worker(new URL('./worker-script.js', import.meta.url), { type: 'module' }),
    url: () => new URL('./worker-script.js', import.meta.url),
  };
  try {
    const started: Remote<Functions> = new Remote<Functions>(script, (message) => {
      if (remote === started) remote = undefined;
      started.end(
        message === undefined
          ? notStarted('it could not be loaded')
          : fromModule(new Error(`the worker has crashed: ${message}`)),
      );
    });
    remote = started;
  } catch (thrown) {
    throw notStarted(messageOf(thrown));
  }
  if (Object.keys(given).length > 0) void remote.call('init', [given]).catch(() => undefined);
  return remote;
}

/** Runs in the worker. The signal stops the run, and events become calls of the callbacks. */
async function watched<T>(
  { signal, onProgress, onIteration }: Watch,
  to: Remote<Functions>,
  run: number,
  start: (onEvent: (event: { progress?: Progress; iteration?: Iteration }) => void) => Promise<T>,
): Promise<T> {
  const stop = () => void to.call('stop', [run]).catch(() => undefined);
  let thrown: { error: unknown } | undefined;
  const onEvent = ({ progress, iteration }: { progress?: Progress; iteration?: Iteration }): void => {
    try {
      if (thrown) return;
      if (progress) onProgress?.(progress);
      if (iteration) onIteration?.(iteration);
    } catch (error) {
      thrown = { error };
      stop();
    }
  };
  read('the signal', () => signal?.addEventListener('abort', stop));
  try {
    const value = await start(onEvent);
    if (thrown) throw thrown.error;
    return value;
  } finally {
    signal?.removeEventListener('abort', stop);
  }
}

/**
 * As `init` of `edgeflip`, for the modules of the worker. Relative URLs count from the page.
 *
 * @throws {@link EdgeflipError} `load-failed`; `invalid-input` and `invalid-option` about `sources`.
 */
export async function init(sources?: Sources): Promise<void> {
  const checked = read('the sources', () => Object.entries(sourcesOf(sources, 'core', MODULES)));
  const sent = await Promise.all(checked.map(async ([name, source]) => [name, await sendable(source!)] as const));
  await worker().call('init', [Object.fromEntries(sent)]);
  Object.assign(given, Object.fromEntries(sent));
}

const MODULES = namesOf<Omit<Sources, 'base'>>({
  core: true,
  webgl2: true,
  threads: true,
  untangle: true,
  audit: true,
  files: true,
});

/** A source that a message can hold. URLs become absolute texts. */
async function sendable(source: ModuleSource): Promise<ModuleSource> {
  if (source instanceof Response) return source.arrayBuffer();
  if (typeof source !== 'string' && !(source instanceof URL)) return source;
  const page = globalThis.document?.baseURI ?? globalThis.location?.href;
  return read('the sources', () => new URL(source || '.', page).href);
}

/**
 * As `makeDelaunay` of `edgeflip`, in the worker. Copies the arrays of the mesh before it returns its promise, and never
 * changes them.
 *
 * @throws {@link EdgeflipError} about the mesh, the options or the backend.
 */
export async function makeDelaunay<I extends IndexArray>(
  mesh: Mesh<I>,
  options: WorkerMakeOptions = {},
): Promise<Result<I>> {
  const watch = watchOf(options);
  const [views, layout] = messageOfMesh(mesh);
  const settings = settingsOf(options, WORKER_MAKE_OPTIONS);
  const [to, run] = [worker(), numbers++];
  const result = await watched(watch, to, run, (onEvent) =>
    to.call('make', [run, views, settings, named(watch)], { transfer: buffersOf([views, settings]), onEvent }),
  );
  return { ...result, indices: layout.give(result.indices) };
}

/** A copy of the mesh. It has a stride if the mesh has one, because the worker gives advice about a forgotten one. */
function messageOfMesh<I extends IndexArray>(mesh: Mesh<I>): [Mesh<Uint32Array>, Layout<I>] {
  const [{ positions, indices, dimension, space = positions }, layout] = readMesh(mesh, copyOf);
  const stride = layout.hasStride ? { stride: widthOf(layout) } : {};
  return [{ positions: space, indices, dimension, plane: layout.plane, ...stride }, layout];
}

/** What the worker needs to know of the callbacks and the signal. */
function named({ onProgress, onIteration, isStopped }: Watch): Watched {
  return { onProgress: onProgress !== undefined, onIteration: onIteration !== undefined, isStopped: isStopped() };
}

/** Frees the sessions that the garbage collection has removed. */
const dropped = new FinalizationRegistry<() => void>((free) => free());

/** As `FlipSession` of `edgeflip`, in the worker. */
export class FlipSession<I extends IndexArray = Uint32Array> implements AsyncIterable<Iteration>, Disposable {
  readonly #to: Remote<Functions>;
  readonly #session: number;
  readonly #layout: Layout<I>;
  readonly #free: () => void;
  /** The error of an update. */
  #fault: unknown;
  #isFreed = false;

  private constructor(to: Remote<Functions>, session: number, layout: Layout<I>) {
    this.#to = to;
    this.#session = session;
    this.#layout = layout;
    this.#free = () => void to.call('free', [session]).catch(() => undefined);
    dropped.register(this, this.#free, this);
  }

  /**
   * Checks the mesh and prepares an engine for it. Copies the arrays of the mesh and of the options before it returns
   * its promise; the caller may then change or transfer them.
   *
   * @throws {@link EdgeflipError} about the mesh, the options or the backend.
   */
  static async create<I extends IndexArray>(mesh: Mesh<I>, options: WorkerOptions = {}): Promise<FlipSession<I>> {
    const [views, layout] = messageOfMesh(mesh);
    const settings = settingsOf(options, WORKER_OPTIONS);
    const [to, session] = [worker(), numbers++];
    await to.call('create', [session, views, settings], { transfer: buffersOf([views, settings]) });
    return new FlipSession(to, session, layout);
  }

  /** Runs one iteration. `undefined` if no edge can flip, or `maxIterations` is reached. */
  step(): Promise<Iteration | undefined> {
    return this.#ask('step');
  }

  /** The remaining iterations. After a `break`, the session keeps its state and can continue. */
  async *[Symbol.asyncIterator](): AsyncGenerator<Iteration, void, undefined> {
    for (let iteration = await this.step(); iteration; iteration = await this.step()) yield iteration;
  }

  /** Runs to the end, or until the signal stops the run. A stopped session can continue. */
  async run(options: RunOptions = {}): Promise<Result<I>> {
    const watch = watchOf(options, RUN_OPTIONS);
    this.#checkFreed();
    const run = numbers++;
    const result = await watched(watch, this.#to, run, (onEvent) =>
      this.#to.call('run', [this.#session, run, named(watch)], { onEvent }),
    );
    return { ...result, indices: this.#layout.give(result.indices) };
  }

  /**
   * Replaces the positions of all vertices; they have the stride and the offset of the mesh. The array is copied at
   * once. The session then behaves like a new session on these positions and the present triangles.
   *
   * @throws {@link EdgeflipError} `invalid-input`, `too-large`, `ragged-array`, `position-count`, `non-finite`,
   * `backend-limit`.
   */
  async setPositions(positions: Mesh['positions']): Promise<void> {
    await this.#ask('setPositions', spaceOf(positions, this.#layout, copyOf));
  }

  /**
   * As `update` of the session of `edgeflip`, in the worker: {@link counters} or the next update throws the errors of
   * the engine. Wrong options and numbers of positions are errors at once.
   *
   * @throws {@link EdgeflipError} `invalid-option`, `invalid-input`, `ragged-array`, `position-count`, `freed`.
   */
  update(options: WorkerUpdateOptions = {}): void {
    this.#checkFreed();
    const { positions, iterations } = updateOf(options, this.#layout, copyOf, WORKER_UPDATE_OPTIONS);
    this.#check();
    const expected = this.#layout.vertices * widthOf(this.#layout);
    if (positions && positions.length !== expected) {
      const message = `positions has ${positions.length} numbers, but the vertices of the mesh take ${expected}`;
      throw new EdgeflipError('position-count', message);
    }
    const args = [{ positions, iterations }] as never[];
    const call = this.#to.call('ask', [this.#session, 'update', args], { transfer: buffersOf(args) });
    void call.catch((thrown) => (this.#fault ??= thrown));
  }

  /**
   * What the updates so far have done.
   *
   * @throws {@link EdgeflipError} `device-failed`; the error of an update.
   */
  async counters(): Promise<Counters> {
    const counters = await this.#ask<Counters>('counters');
    this.#check();
    return counters;
  }

  /** The number of the update that changed each triangle last; 0 for none. Empty without the option `trackChanges`. */
  changes(): Promise<Uint32Array> {
    return this.#ask('changes');
  }

  /** The result so far. */
  async result(): Promise<Result<I>> {
    const result = await this.#ask<Result>('result');
    return { ...result, indices: this.#layout.give(result.indices) };
  }

  /** The triangles so far: vertex indices, 3 per triangle, in an array of the type of the mesh. */
  async triangles(): Promise<Indices<I>> {
    return this.#layout.give(await this.#ask('triangles'));
  }

  /** All edges of the present triangles. */
  edges(): Promise<Edges> {
    return this.#ask('edges');
  }

  /**
   * The present state of each half-edge's edge: 3 numbers per triangle, in the order of {@link FlipSession.triangles}.
   * The numbers are indices into {@link EDGE_STATES}.
   */
  edgeStates(): Promise<Uint8Array> {
    return this.#ask('edgeStates');
  }

  /** Checks the triangles against the input, exactly, and lists the edges that are not Delaunay. */
  verify(): Promise<Audit> {
    return this.#ask('verify');
  }

  /** What keeps the present positions from having a triangulation, for a mesh in the plane. */
  problems(): Promise<Problems> {
    return this.#ask('problems');
  }

  /** The present engine. */
  backend(): Promise<Engine> {
    return this.#ask('backend');
  }

  /** Frees memory and buffers after the present call. Later calls fail with `freed`. */
  free(): void {
    if (this.#isFreed) return;
    this.#isFreed = true;
    dropped.unregister(this);
    this.#free();
  }

  /** As {@link FlipSession.free}: `using session = await FlipSession.create(mesh)`. */
  [dispose](): void {
    this.free();
  }

  async #ask<T>(question: Question, ...args: unknown[]): Promise<T> {
    this.#checkFreed();
    return (await this.#to.call('ask', [this.#session, question, args as never[]], { transfer: buffersOf(args) })) as T;
  }

  #checkFreed(): void {
    if (this.#isFreed) throw new EdgeflipError('freed', 'the session has been freed');
  }

  /** Throws the error of an update, in the next update and in {@link counters}. */
  #check(): void {
    this.#checkFreed();
    const fault = this.#fault;
    this.#fault = undefined;
    if (fault) throw fault;
  }
}
