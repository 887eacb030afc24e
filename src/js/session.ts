/** A mesh on an engine: step by step, or in one run. */

/// <reference lib="esnext.disposable" preserve="true" />

import type { Audit, Problems } from './audit.js';
import { dispose } from './dispose.js';
import type { EDGE_STATES } from './edge-states.js';
import { EdgeflipError, fromModule } from './error.js';
import type { Preparation } from './prepare.js';
import { loadAudit } from './load.js';
import { readDeviceMesh } from './device-mesh.js';
import { copyOf, itselfOf } from './given.js';
import type { Heights } from './heights.js';
import { copied, type Layout, movedTo, readMesh, spaceOf } from './mesh.js';
import { open, type Opened } from './open.js';
import { resultOf } from './result.js';
import type { SessionBuffers } from './session-buffers.js';
import { MAKE_OPTIONS, RUN_OPTIONS, settingsOf, type Watch, watchOf } from './settings.js';
import type { ModuleSession } from './threads.js';
import { Turns } from './turn.js';
import type {
  Counters,
  DeviceMesh,
  Edges,
  Engine,
  GpuDevice,
  IndexArray,
  Indices,
  Iteration,
  MakeDelaunayOptions,
  Mesh,
  Options,
  Result,
  RunOptions,
  UpdateOptions,
} from './types.js';
import { call } from './untangle.js';
import { takeOnDevice, type Update, updateOf } from './update.js';

/** As {@link FlipSession.create}, with the options of {@link makeDelaunay}. */
export let createWatched: <I extends IndexArray>(
  mesh: Mesh<I>,
  options: MakeDelaunayOptions,
) => Promise<FlipSession<I>>;

/**
 * As {@link FlipSession.run}, with the callbacks of {@link makeDelaunay}. If the triangles `stay` on a GPU, the result
 * has no indices.
 */
export let runWatched: <I extends IndexArray>(
  session: FlipSession<I>,
  watch: Watch,
  stay?: boolean,
) => Promise<Result<I>>;

/**
 * A mesh that is made Delaunay step by step.
 *
 * ```ts
 * const session = await FlipSession.create(mesh);
 * for await (const iteration of session) draw(await session.triangles(), iteration);
 * session.free();
 * ```
 *
 * Calls may overlap: each waits for the earlier ones. During a run, other calls execute between two batches; if they move
 * vertices, the run goes on with these.
 */
export class FlipSession<I extends IndexArray = Uint32Array> implements AsyncIterable<Iteration>, Disposable {
  readonly #session: ModuleSession;
  #last: Promise<unknown> = Promise.resolve();
  /** Calls that have not ended. */
  #waiting = 0;
  /** The error of an update that had to wait. */
  #fault: EdgeflipError | undefined;
  #isFreed = false;

  readonly #layout: Layout<I>;
  readonly #alone: string | undefined;
  readonly #prepared: Preparation;
  /** The heights, if the mesh has a plane. */
  readonly #heights: Heights | undefined;
  /** Whether triangles that have turned over become positive: always, never, or once the vertices have moved. */
  #untangles: boolean | undefined;

  private constructor(
    { session, alone }: Opened,
    layout: Layout<I>,
    untangles: boolean | undefined,
    heights: Heights | undefined,
    prepared: Preparation = {},
  ) {
    this.#session = session;
    this.#heights = heights;
    this.#untangles = untangles;
    this.#alone = alone;
    this.#layout = layout;
    this.#prepared = prepared;
  }

  /**
   * Checks the mesh and prepares an engine for it. Copies the arrays of the mesh and of the options before it returns
   * its promise; the caller may then change or transfer them.
   *
   * @throws {@link EdgeflipError} about the mesh, the options or the backend.
   */
  static create<I extends IndexArray>(mesh: Mesh<I>, options: Options = {}): Promise<FlipSession<I>> {
    return FlipSession.#create(mesh, options, undefined, true);
  }

  /**
   * As {@link create}, for a mesh in buffers of the option `device`. It reads them once: the engine checks the mesh. The
   * session has buffers of its own, see {@link gpu}; `update` takes later positions from a buffer of yours.
   *
   * @throws {@link EdgeflipError} as {@link create}; `device-failed`.
   */
  static async fromBuffers(mesh: DeviceMesh, options: Options & { device: GpuDevice }): Promise<FlipSession> {
    const settings = settingsOf(options);
    if (!settings.device) throw new EdgeflipError('invalid-option', 'option device: give the device of the buffers');
    return FlipSession.#create(await readDeviceMesh(mesh, settings.device), settings, undefined, true);
  }

  static {
    createWatched = (mesh, options) => FlipSession.#create(mesh, options, MAKE_OPTIONS);
    runWatched = (session, watch, stay) => session.#run(watch, stay);
  }

  static async #create<I extends IndexArray>(
    mesh: Mesh<I>,
    options: Options,
    known?: readonly string[],
    settles = false,
  ): Promise<FlipSession<I>> {
    const [views, layout] = readMesh(mesh, itselfOf);
    const chosen = settingsOf(options, known);
    try {
      // Without these options, their modules are not loaded.
      const { untangle } = chosen;
      const isPrepared = untangle || chosen.reorient || chosen.weld || chosen.constraints;
      const isPlain = !isPrepared && !views.space;
      if (isPlain) return new FlipSession(await open(views, chosen, settles), layout, untangle, undefined);
      const copy = copied(views);
      const heights = copy.space && new (await import('./heights.js')).Heights(layout.plane!, copy.space, copy.indices);
      if (!isPrepared) return new FlipSession(await open(copy, chosen, settles), layout, untangle, heights);
      const { prepare } = await import('./prepare.js');
      const { indices, settings, ...prepared } = await prepare(copy, chosen);
      return new FlipSession(await open({ ...copy, indices }, settings, settles), layout, untangle, heights, prepared);
    } catch (thrown) {
      throw fromModule(thrown);
    }
  }

  /** Runs one iteration. `undefined` if no edge can flip, or `maxIterations` is reached. */
  step(): Promise<Iteration | undefined> {
    return this.#call((session) => session.step());
  }

  /** The remaining iterations. After a `break`, the session keeps its state and can continue. */
  async *[Symbol.asyncIterator](): AsyncGenerator<Iteration, void, undefined> {
    const turns = this.#session.isAway ? undefined : new Turns();
    for (let iteration = await this.step(); iteration; iteration = await this.step()) {
      yield iteration;
      await turns?.give();
    }
  }

  /** Runs to the end, or until the signal stops the run. A session that a signal stopped can continue. */
  async run(options: RunOptions = {}): Promise<Result<I>> {
    return this.#run(watchOf(options, RUN_OPTIONS));
  }

  async #run(watch: Watch, stay = false): Promise<Result<I>> {
    await (watch.onIteration ? this.#iterate(watch) : this.#advance(watch, stay));
    return this.#result(stay);
  }

  async #advance({ onProgress, isStopped }: Watch, stay: boolean): Promise<void> {
    const turns = this.#session.isAway ? undefined : new Turns();
    for (let goesOn = true; goesOn && !isStopped(); await turns?.give()) {
      const [more, progress] = await this.#call(async (session) => {
        session.stays = stay;
        const more = await session.advance();
        return [more, { iterations: session.iterations, flips: session.flips }];
      });
      onProgress?.(progress);
      goesOn = more;
    }
  }

  async #iterate({ onIteration, onProgress, isStopped }: Watch): Promise<void> {
    if (isStopped()) return;
    let flips = 0;
    for await (const iteration of this) {
      flips += iteration.flips;
      onIteration?.(iteration);
      onProgress?.({ iterations: iteration.index + 1, flips });
      if (isStopped()) return;
    }
  }

  /**
   * Replaces the positions of all vertices; they have the stride and the offset of the mesh. The array is copied at
   * once. The session then behaves like a new session on these positions and the present triangles: iterations, flips,
   * creases and the input of `verify` start again. The triangles are read back once. Adjacency, device and buffers stay,
   * unless `'auto'` changes the engine, or the positions change between 32-bit and 64-bit floats. After an error the
   * session is unchanged. With `'auto'`, the CPU accepts positions that the GPU cannot.
   *
   * In the plane, triangles that have turned over become positive first, unless the option `untangle` is `false`. The
   * first mesh that needs it loads a module.
   *
   * @throws {@link EdgeflipError} `invalid-input`, `too-large`, `ragged-array`, `position-count`, `non-finite`,
   * `backend-limit`, `load-failed`.
   */
  async setPositions(positions: Mesh['positions']): Promise<void> {
    const moved = spaceOf(positions, this.#layout, copyOf);
    const plan = movedTo(moved, this.#layout, true);
    return this.#call(async (session) => {
      await session.setPositions(plan);
      this.#heights?.move(moved);
      this.#moved();
    });
  }

  /**
   * Takes over vertices that have moved, untangles triangles in the plane that have turned over, unless the option
   * `untangle` is `false`, and flips for up to `iterations` iterations; what is left goes on in the next update. On
   * WebGPU the call only submits the work and returns: what the page submits after it, such as the drawing of the frame,
   * sees the result. Nothing travels to the CPU but how many triangles were turned over, for later updates; nobody waits
   * for it. On the CPU the call does the work. On WebGL2 it waits for one number if it untangles.
   *
   * ```ts
   * const { device, positions, indices } = (await session.gpu())!;
   * function frame() {
   *   device.queue.submit([moveVertices(positions)]); // your compute pass writes the positions
   *   session.update();
   *   draw(positions, indices);
   *   requestAnimationFrame(frame);
   * }
   * ```
   *
   * An update tests every edge on the new positions and flags the creases again. Adjacency, buffers and winding stay.
   * Edges with a coordinate that is not finite stay as they are until it is finite again. Iterations are numbered on
   * from update to update, so every engine gives the same triangles for the same positions and numbers of iterations.
   *
   * The update waits for its turn if another call of the session has not ended, after `setPositions` on WebGPU, if it
   * is the first one on WebGL2, also after `setPositions`, and if the CPU engine runs in workers. The next update or
   * {@link counters} then throws its error. Calls other than `update`, `counters`, `changes`, `triangles`, `edges` and
   * `gpu` end the motion: they act as if `setPositions` had been called with the present positions.
   *
   * @throws {@link EdgeflipError} `invalid-option`, `invalid-input`, `position-count`, `ragged-array`; `backend-limit`
   * for 64-bit floats on WebGPU and WebGL2; `device-failed`, `freed`.
   */
  update(options: UpdateOptions = {}): void {
    this.#checkFreed();
    const isLate = this.#waiting > 0 || this.#session.isAway || !this.#session.isSettled;
    const update = updateOf(options, this.#layout, isLate ? copyOf : itselfOf);
    this.#check();
    if (isLate) {
      const call = this.#call(async (session) => {
        await session.settle();
        return this.#update(session, update);
      });
      void call.catch((thrown) => (this.#fault ??= thrown));
      return;
    }
    try {
      void this.#update(this.#session, update);
    } catch (thrown) {
      throw fromModule(thrown);
    }
  }

  #moved(): void {
    this.#prepared.before = undefined;
    if (this.#prepared.constrained) this.#prepared.constrained.ms = 0;
    this.#untangles ??= true;
  }

  #update(session: ModuleSession, { positions, buffer, iterations }: Update): void | Promise<void> {
    this.#moved();
    if (!positions) takeOnDevice(session, buffer, this.#layout, this.#heights);
    const updated = session.update(positions && movedTo(positions, this.#layout, false), iterations);
    if (positions) this.#heights?.move(positions);
    return updated;
  }

  /**
   * What the updates so far have done. The counts are of the updates before the call. Later updates need not wait for
   * the answer.
   *
   * @throws {@link EdgeflipError} `device-failed`, `freed`; the error of an update that had to wait.
   */
  async counters(): Promise<Counters> {
    this.#check();
    if (this.#waiting > 0 || this.#session.isAway || !this.#session.isSettled) {
      return this.#call(async (session) => {
        await session.settle();
        this.#check();
        return session.counters();
      });
    }
    try {
      return await this.#session.counters();
    } catch (thrown) {
      throw fromModule(thrown);
    }
  }

  /**
   * The number of the update that changed each triangle last, from 1 on; 0 if no update has changed it. Empty without
   * the option `trackChanges`. {@link gpu} has the same numbers on the device.
   */
  changes(): Promise<Uint32Array> {
    return this.#call((session) => session.changes());
  }

  #checkFreed(): void {
    if (this.#isFreed) throw new EdgeflipError('freed', 'the session has been freed');
  }

  #check(): void {
    this.#checkFreed();
    const fault = this.#fault;
    this.#fault = undefined;
    if (fault) throw fault;
  }

  /** The result so far. */
  result(): Promise<Result<I>> {
    return this.#result(false);
  }

  #result(stay: boolean): Promise<Result<I>> {
    return this.#call(async (session) => {
      const context = {
        ...this.#prepared,
        alone: this.#alone,
        threads: session.threads,
        untangles: this.#untangles,
        rightPlane: this.#heights?.rightPlane,
      };
      session.stays = stay;
      return resultOf(await session.outcome(), this.#layout, context);
    });
  }

  /** The triangles so far: vertex indices, 3 per triangle, in an array of the type of the mesh. */
  triangles(): Promise<Indices<I>> {
    return this.#call(async (session) => {
      const indices = await session.triangles();
      return this.#layout.give(this.#prepared.welded?.split(indices) ?? indices);
    });
  }

  /** All edges of the present triangles. */
  edges(): Promise<Edges> {
    return this.#call((session) => session.edges());
  }

  /**
   * The present state of each half-edge's edge: 3 numbers per triangle, in the order of {@link FlipSession.triangles}.
   * The two half-edges of an edge have the same state. The numbers are indices into {@link EDGE_STATES}.
   */
  edgeStates(): Promise<Uint8Array> {
    return this.#call((session) => session.edgeStates());
  }

  /**
   * Checks the triangles against the input, exactly, and lists the edges that are not Delaunay. After `setPositions` and
   * after updates, the input is the mesh as it was then. The check shares no code with the engines. It is in a
   * WebAssembly module of its own, which the first call loads.
   *
   * @throws {@link EdgeflipError} `load-failed`; see {@link init}.
   */
  verify(): Promise<Audit> {
    return this.#call(async (session) => {
      const { before } = this.#prepared;
      const [positions, present, dimension, triangles, locks, options] = await session.auditInput();
      await loadAudit();
      const { audit } = await import('./wasm/edgeflip_audit.js');
      const { indices, lockedEdges } = before ?? { indices: present, lockedEdges: locks };
      return audit(positions, indices, dimension, triangles, lockedEdges, options, before);
    });
  }

  /**
   * What keeps the present positions from having a triangulation: vertices outside the boundary, vertices at one point,
   * and boundary edges that cross. Exact, and for a mesh in the plane; a surface in space has no problems. As `verify`, it
   * ends the motion, and is in a module that the first call loads.
   *
   * @throws {@link EdgeflipError} `load-failed`; see {@link init}.
   */
  problems(): Promise<Problems> {
    return this.#call(async (session) => {
      const [positions, indices, dimension] = await session.auditInput();
      await loadAudit();
      const { problems } = await import('./wasm/edgeflip_audit.js');
      return problems(positions, indices, dimension);
    });
  }

  /** The present engine. */
  backend(): Promise<Engine> {
    return this.#call(async (session) => session.backend);
  }

  /**
   * The device and the buffers on the GPU, to draw without a copy; `undefined` on the CPU. `positions` has 2 or 3 f32
   * per vertex, with a plane 3 (doubles are rounded), `indices` 3 u32 per triangle. The usage of both includes
   * STORAGE, VERTEX or INDEX, COPY_SRC and COPY_DST. Write only `positions`, for {@link update}, and use the buffers
   * only until `free`; {@link setPositions} says when it keeps them. With `'auto'`, call this again after each call of
   * the session, which may continue on the CPU. The device is the `device` of the options, else one that all sessions
   * share. With the option `trackChanges`, `changes` has a u32 per triangle as {@link changes}, from a byte of a
   * buffer on; with the option `adjacency`, `twins` and `vertexHalfEdges` are there, right after every call of the
   * session. The usage of these buffers includes STORAGE and COPY_SRC. Only read them.
   */
  gpu(): Promise<SessionBuffers | undefined> {
    return this.#call(async ({ gpu }) => gpu && (this.#heights?.withHeights(gpu) ?? gpu));
  }

  /** Frees memory and buffers after the present call. Waiting calls fail with `freed`. */
  free(): void {
    if (this.#isFreed) return;
    this.#isFreed = true;
    void this.#last.then(() => [this.#prepared.welded, this.#heights].forEach((held) => held?.free()));
    // After a crash, the session may still be borrowed by the call, and cannot be freed.
    void this.#last.then(() => this.#session.free()).catch(() => undefined);
  }

  /** As {@link FlipSession.free}: `using session = await FlipSession.create(mesh)`. */
  [dispose](): void {
    this.free();
  }

  /** Calls the module after all earlier calls. */
  #call<T>(work: (session: ModuleSession) => Promise<T>): Promise<T> {
    this.#waiting++;
    const answer = this.#last.then(async () => {
      try {
        this.#checkFreed();
        return await call(this.#session, work);
      } catch (thrown) {
        throw fromModule(thrown);
      } finally {
        this.#waiting--;
      }
    });
    this.#last = answer.catch(() => undefined);
    return answer;
  }
}
