/** A mesh on an engine: step by step, or in one run. */

/// <reference lib="esnext.disposable" preserve="true" />

import type { EDGE_STATES } from './edge-states.js';
import { EdgeflipError, fromModule } from './error.js';
import type { Welded } from './files.js';
import { loadAudit } from './load.js';
import { copyOf, itselfOf } from './given.js';
import { copied, moduleMesh, positionsOf } from './mesh.js';
import { open } from './open.js';
import { settingsOf, watchOf } from './settings.js';
import type { ModuleSession } from './threads.js';
import { Turns } from './turn.js';
import type {
  Audit,
  Edges,
  Engine,
  Iteration,
  MakeDelaunayOptions,
  Mesh,
  Options,
  Result,
  RunOptions,
} from './types.js';

/** Not every browser has `Symbol.dispose` yet. */
const dispose: typeof Symbol.dispose = Symbol.dispose ?? Symbol.for('Symbol.dispose');

/** As {@link FlipSession.create}, with the options of {@link makeDelaunay}. */
export let createWatched: (mesh: Mesh, options: MakeDelaunayOptions) => Promise<FlipSession>;

/**
 * A mesh that is made Delaunay step by step.
 *
 * ```ts
 * const session = await FlipSession.create(mesh);
 * for await (const iteration of session) draw(await session.triangles(), iteration);
 * session.free();
 * ```
 *
 * Calls may overlap: each waits for those before it. A run lets others in between two batches.
 */
export class FlipSession implements AsyncIterable<Iteration>, Disposable {
  readonly #session: ModuleSession;
  #last: Promise<unknown> = Promise.resolve();
  #isFreed = false;

  readonly #turned: number;
  readonly #welded: Welded | undefined;

  private constructor(session: ModuleSession, turned = 0, welded?: Welded) {
    this.#session = session;
    this.#turned = turned;
    this.#welded = welded;
  }

  /**
   * Checks the mesh and makes an engine ready for it. The arrays of the mesh and of the options are copied before this
   * returns its promise: they are the caller's again.
   *
   * @throws {@link EdgeflipError} about the mesh, the options or the backend.
   */
  static create(mesh: Mesh, options: Options = {}): Promise<FlipSession> {
    return FlipSession.#create(mesh, options, false);
  }

  static {
    createWatched = (mesh, options) => FlipSession.#create(mesh, options, true);
  }

  static async #create(mesh: Mesh, options: Options, isWatched: boolean): Promise<FlipSession> {
    const [views, chosen] = [moduleMesh(mesh, itselfOf), settingsOf(options, isWatched)];
    try {
      // What is asked for first has to be loaded first.
      if (!chosen.reorient && !chosen.weld) return new FlipSession(await open(views, chosen));
      const copy = copied(views);
      const { prepare } = await import('./prepare.js');
      const { indices, turned, welded, settings } = await prepare(copy, chosen);
      return new FlipSession(await open({ ...copy, indices }, settings), turned, welded);
    } catch (thrown) {
      throw fromModule(thrown);
    }
  }

  /** One iteration. `undefined` when nothing is left to flip, or `maxIterations` is reached. */
  step(): Promise<Iteration | undefined> {
    return this.#call((session) => session.step());
  }

  /** The iterations that are left. Leaving the loop leaves the session as it is then. */
  async *[Symbol.asyncIterator](): AsyncGenerator<Iteration, void, undefined> {
    const turns = this.#session.isAway ? undefined : new Turns();
    for (let iteration = await this.step(); iteration; iteration = await this.step()) {
      yield iteration;
      await turns?.give();
    }
  }

  /** Runs to the end, or until the signal stops it. A stopped session can go on. */
  async run(options: RunOptions = {}): Promise<Result> {
    const { onProgress, isStopped } = watchOf(options);
    const turns = this.#session.isAway ? undefined : new Turns();
    for (let goesOn = true; goesOn && !isStopped(); await turns?.give()) {
      const [more, progress] = await this.#call(async (session) => {
        const more = await session.advance();
        return [more, { iterations: session.iterations, flips: session.flips }];
      });
      onProgress?.(progress);
      goesOn = more;
    }
    return this.result();
  }

  /**
   * Moves the vertices: all of them, as many as before, copied at once. Afterwards the session is as a new one on these
   * positions and the triangles as they are then: iterations, flips, sharp edges and what `verify` compares with begin
   * anew. The triangles are read back once. Adjacency, device and buffers stay, unless `'auto'` changes the engine, or
   * doubles follow 32-bit floats or these follow doubles. After an error the session is as before; with `'auto'` the CPU takes over what the GPU
   * cannot take.
   *
   * @throws {@link EdgeflipError} `invalid-input`, `too-large`, `position-count`, `non-finite`, `backend-limit`.
   */
  async setPositions(positions: Float32Array | Float64Array): Promise<void> {
    const moved = copyOf(positionsOf(positions), 'positions');
    return this.#call((session) => session.setPositions(moved));
  }

  /** The result so far. */
  result(): Promise<Result> {
    const [turned, welded] = [this.#turned, this.#welded];
    return this.#call(async (session) => {
      const outcome = await session.outcome();
      return {
        ...outcome,
        indices: welded?.split(outcome.indices) ?? outcome.indices,
        turnedTriangles: turned,
        joinedVertices: welded?.joined ?? 0,
        seamEdges: (welded?.lockedEdges.length ?? 0) / 2,
      };
    });
  }

  /** The triangles so far: vertex indices, 3 a triangle. */
  triangles(): Promise<Uint32Array> {
    return this.#call(async (session) => {
      const indices = await session.triangles();
      return this.#welded?.split(indices) ?? indices;
    });
  }

  /** Every edge, as it is now. */
  edges(): Promise<Edges> {
    return this.#call((session) => session.edges());
  }

  /**
   * The state of each half-edge's edge, as it is now: 3 a triangle, in the order of {@link FlipSession.triangles}; the
   * two half-edges of an edge agree. The numbers are places in {@link EDGE_STATES}.
   */
  edgeStates(): Promise<Uint8Array> {
    return this.#call((session) => session.edgeStates());
  }

  /**
   * Checks the triangles against the input, exactly, with code that shares nothing with what made them, and lists the
   * edges that are not Delaunay. That code is in a WebAssembly module of its own, which the first call loads.
   *
   * @throws {@link EdgeflipError} `load-failed`; see {@link init}.
   */
  verify(): Promise<Audit> {
    return this.#call(async (session) => {
      const input = await session.auditInput();
      await loadAudit();
      const { audit } = await import('./wasm/edgeflip_audit.js');
      return audit(...input);
    });
  }

  /** The engine that runs now. */
  backend(): Promise<Engine> {
    return this.#call(async (session) => session.backend);
  }

  /**
   * The GPU's objects, to draw from without a copy; `undefined` on the CPU. `positions` has 2 or 3 f32 a vertex, of
   * doubles the nearest ones, `indices` 3 u32 a triangle; their usage has STORAGE, VERTEX or INDEX, COPY_SRC and
   * COPY_DST. Only read them, and only until `free`; {@link setPositions} says when it keeps them. With `'auto'`, ask
   * again after each call of the session: where the GPU fails or cannot take new positions, the CPU goes on and these are
   * gone. The device is the one of the options, else one for all sessions.
   */
  gpu(): Promise<{ device: GPUDevice; positions: GPUBuffer; indices: GPUBuffer } | undefined> {
    return this.#call(async ({ device, positionBuffer, indexBuffer }) =>
      device && positionBuffer && indexBuffer ? { device, positions: positionBuffer, indices: indexBuffer } : undefined,
    );
  }

  /** Gives memory and buffers back, once the call that is going on has ended. Calls that wait are refused. */
  free(): void {
    if (this.#isFreed) return;
    this.#isFreed = true;
    void this.#last.then(() => this.#welded?.free());
    // A call that has crashed may have it still.
    void this.#last.then(() => this.#session.free()).catch(() => undefined);
  }

  /** As {@link FlipSession.free}: `using session = await FlipSession.create(mesh)`. */
  [dispose](): void {
    this.free();
  }

  /** Calls the module when the calls before have answered. */
  #call<T>(work: (session: ModuleSession) => Promise<T>): Promise<T> {
    const call = this.#last.then(async () => {
      if (this.#isFreed) throw new EdgeflipError('freed', 'the session has been freed');
      try {
        return await work(this.#session);
      } catch (thrown) {
        throw fromModule(thrown);
      }
    });
    this.#last = call.catch(() => undefined);
    return call;
  }
}
