/** A run that keeps every iteration, so that the slider can go back to it. */

import { EDGE_STATES, FlipSession, type Engine, type Iteration, type Options, type Result } from 'edgeflip';
import type { FileMesh, IndexedMesh } from 'edgeflip/files';
import type { Change, Moment } from './change.ts';

/** The most triangles of a mesh whose edges are drawn in colours. */
export const COLOURED = 20_000;

/** The most triangles of a mesh whose edges are flipped at random: a larger one would take many seconds. */
export const SCRAMBLED = 200_000;

export const canScramble = ({ indices }: IndexedMesh) => indices.length <= 3 * SCRAMBLED;

/** The engine that the user chose. */
export type Backend = 'auto' | Engine;

/** A result without its triangles, which are on screen. */
export type Summary = Omit<Result, 'indices'>;

/** One iteration, and the states of the edges after it (for small meshes). */
export interface Step {
  iteration: Iteration;
  states: Uint8Array | undefined;
  /** Present if the triangles are in main memory. */
  change?: Change;
}

/** A session, of the page or of a worker. */
export interface Stepper {
  step(): Promise<Step | undefined>;
  result(): Promise<Summary>;
  free(): void;
}

/** Indices to draw: in main memory, or in a buffer on the GPU. */
export type Drawn = Uint32Array | GPUBuffer;

/** The triangles of one iteration, its position, and the changes that lead to the other iterations. */
export interface Track {
  /**
   * Records the changes of the newest iteration. The track must be at the iteration before.
   *
   * @throws if memory runs out.
   */
  record(step: Step): Promise<void>;
  /** Redoes iteration `index`, or undoes it. */
  apply(index: number): void;
  /** The triangles to draw. `isNewest`: whether the track is at the newest iteration. */
  drawn(isNewest: boolean): Drawn;
  /** The sides that iteration `index` flips, in the form of `Corners.sides`. */
  flipping(index: number, moment: Moment): Drawn;
  /** A copy of the triangles at the track's position. */
  triangles(): Promise<Uint32Array>;
  free(): void;
}

/** A mesh, and the locks that keep its attributes if it is from a file. */
export type OpenMesh = IndexedMesh & Partial<Pick<FileMesh, 'groups' | 'lockedEdges' | 'lockedTriangles'>>;

/** Creates a session of the mesh with its locks. */
export function sessionOf(mesh: OpenMesh, options: Options): Promise<FlipSession> {
  const { groups, lockedEdges, lockedTriangles } = mesh;
  return FlipSession.create(mesh, { groups, lockedEdges, lockedTriangles, ...options });
}

/** The states of the edges of a small mesh, one entry per half-edge; `undefined` for a large mesh. */
export async function statesOf(session: FlipSession, indices: number): Promise<Uint8Array | undefined> {
  return indices <= 3 * COLOURED ? session.edgeStates() : undefined;
}

/** The result so far, without its triangles. */
export async function summaryOf(session: FlipSession): Promise<Summary> {
  const { indices, ...summary } = await session.result();
  return summary;
}

/**
 * The number of edges in each state, from the states of the half-edges. A boundary edge has one half-edge, a
 * non-manifold edge three or more, and any other edge two. `nonManifold` is the number of non-manifold edges.
 */
export function countStates(states: Uint8Array, nonManifold: number | undefined): number[] {
  const halves = EDGE_STATES.map(() => 0);
  for (const state of states) halves[state]!++;
  return EDGE_STATES.map((name, state) => {
    const count = halves[state]!;
    if (name === 'non-manifold') return count > 0 ? (nonManifold ?? 0) : 0;
    return name === 'boundary' ? count : count / 2;
  });
}

/** A mesh on an engine, with all its iterations. */
export class Run {
  /** Whether the engine is in a worker, and not on the GPU that draws. */
  readonly isInWorker: boolean;
  /** Why `auto` did not use the GPU that draws. The summary may have another reason. */
  fallback: string | undefined;
  /** Whether it is on the CPU only until the GPU that draws is ready. */
  awaitsGpu = false;
  readonly iterations: Iteration[] = [];
  readonly #states: (Uint8Array | undefined)[];
  readonly #stepper: Stepper;
  readonly #track: Track;
  #at = 0;
  #hasEnded = false;
  #isFreed = false;
  /** Whether the triangles of the engine are one iteration after the newest recorded iteration. */
  #isAhead = false;
  /** The iteration to show after the present recording; `undefined` if nothing is being recorded. */
  #sought: number | undefined;
  #last: Promise<unknown> = Promise.resolve();

  constructor(
    isInWorker: boolean,
    fallback: string | undefined,
    stepper: Stepper,
    track: Track,
    states: Uint8Array | undefined,
  ) {
    this.isInWorker = isInWorker;
    this.fallback = fallback;
    this.#stepper = stepper;
    this.#track = track;
    this.#states = [states];
  }

  /** The shown iteration: 0 is the input. */
  get at(): number {
    return this.#at;
  }

  get isNewest(): boolean {
    return this.#at === this.iterations.length;
  }

  /** Whether the last iteration has been run. */
  get hasEnded(): boolean {
    return this.#hasEnded;
  }

  /** Whether the last iteration has been run and is shown. */
  get isOver(): boolean {
    return this.#hasEnded && this.isNewest;
  }

  /**
   * Moves forward by one iteration, recorded or new. Returns whether there was one. Each call waits for the earlier
   * ones: the track must record an iteration before the next one changes the triangles.
   */
  forward(): Promise<boolean> {
    const call = this.#last.then(() => this.#forward());
    this.#last = call.catch(() => undefined);
    return call;
  }

  /**
   * Runs the next iteration and goes back, so that the edges that flip next are known. Returns whether more is known than
   * before.
   */
  lookAhead(): Promise<boolean> {
    const call = this.#last.then(async () => {
      if (this.#isFreed || this.#hasEnded || !this.isNewest || this.#isAhead) return false;
      const from = this.#at;
      const went = await this.#forward();
      if (went && this.#at === from + 1) this.seek(from);
      return went || this.#hasEnded;
    });
    this.#last = call.catch(() => undefined);
    return call;
  }

  async #forward(): Promise<boolean> {
    if (this.#isFreed) return false;
    const from = this.#at;
    if (!this.isNewest) {
      this.seek(from + 1);
      return true;
    }
    if (this.#hasEnded) return false;
    if (this.#isAhead) throw new Error('The last iteration could not be stored. Choose an engine to start again.');
    const step = await this.#stepper.step();
    if (this.#isFreed) return false;
    if (!step) {
      this.#hasEnded = true;
      return false;
    }
    // The user may have moved the slider meanwhile, and may move it again while this is recorded.
    this.#sought = this.#at;
    this.#move(from);
    this.#isAhead = true;
    try {
      await this.#track.record(step);
      if (this.#isFreed) return false;
      this.#isAhead = false;
      this.iterations.push(step.iteration);
      this.#states.push(step.states);
      this.#at++;
      if (this.#sought !== from) this.#move(this.#sought);
    } finally {
      this.#sought = undefined;
    }
    return true;
  }

  /** Shows a recorded iteration. */
  seek(at: number): void {
    if (this.#isFreed) return;
    if (this.#sought === undefined) this.#move(at);
    else this.#sought = at;
  }

  #move(at: number): void {
    while (this.#at < at) this.#track.apply(this.#at++);
    while (this.#at > at) this.#track.apply(--this.#at);
  }

  /**
   * Repeats the iterations of another run of the mesh, and shows the iteration that it shows.
   *
   * @throws if this run ends sooner.
   */
  async follow(other: Run, signal?: AbortSignal): Promise<void> {
    const isBehind = () => this.iterations.length < other.iterations.length || (other.hasEnded && !this.#hasEnded);
    this.seek(this.iterations.length);
    while (isBehind() && !signal?.aborted && (await this.forward()));
    if (this.#hasEnded && isBehind()) throw new Error('the repeated run ended sooner than the first run');
    this.seek(Math.min(other.at, this.iterations.length));
  }

  get drawn(): Drawn {
    return this.#track.drawn(this.isNewest && !this.#isAhead);
  }

  /**
   * The sides of the shown triangles that flip next, in the form of `Corners.sides`. If the next iteration has not been
   * run, those that have just flipped; `undefined` if there are none.
   */
  get flipping(): Drawn | undefined {
    if (!this.isNewest) return this.#track.flipping(this.#at, 'before');
    return this.#hasEnded || this.#at === 0 ? undefined : this.#track.flipping(this.#at - 1, 'after');
  }

  /** The states of the edges at the shown iteration. */
  get states(): Uint8Array | undefined {
    return this.#states[this.#at];
  }

  triangles(): Promise<Uint32Array> {
    return this.#track.triangles();
  }

  result(): Promise<Summary> {
    return this.#stepper.result();
  }

  free(): void {
    this.#isFreed = true;
    this.#stepper.free();
    this.#track.free();
  }
}
