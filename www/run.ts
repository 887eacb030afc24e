/** A run that can be watched: every iteration is kept, so that the slider can go back to it. */

import { EDGE_STATES, FlipSession, type Engine, type Iteration, type Options, type Result } from 'edgeflip';
import type { FileMesh, IndexedMesh } from 'edgeflip/files';
import type { Change } from './change.ts';

/** Meshes of up to so many triangles have their edges drawn in colours. */
export const COLOURED = 20_000;

/** The engine that a run is asked for. */
export type Backend = 'auto' | Engine;

/** A result; the triangles are on screen. */
export type Summary = Omit<Result, 'indices'>;

/** One iteration, and what the edges are after it (for small meshes). */
export interface Step {
  iteration: Iteration;
  states: Uint8Array | undefined;
  /** Where the triangles are in main memory. */
  change?: Change;
}

/** Where the flips happen: the session of the page, or that of the worker. */
export interface Stepper {
  step(): Promise<Step | undefined>;
  result(): Promise<Summary>;
  free(): void;
}

/** Triangles as they are drawn: in main memory, or in a buffer of the GPU. */
export type Drawn = Uint32Array | GPUBuffer;

/** The triangles of one iteration, and the changes that lead to the others. */
export interface Track {
  /**
   * Takes over what the newest iteration has changed; the track must stand at the one before.
   *
   * @throws where there is no memory left for it.
   */
  record(step: Step): Promise<void>;
  /** Does iteration `index`, or takes it back. */
  apply(index: number): void;
  /** What to draw, if this is the newest state or not. */
  drawn(isNewest: boolean): Drawn;
  /** The lines around its triangles, as indices; `undefined` where they do not fit. */
  lines(): Drawn | undefined;
  /** A copy of the triangles where the track stands. */
  triangles(): Promise<Uint32Array>;
  free(): void;
}

/** A mesh, and where it is from a file what keeps its attributes in their places. */
export type OpenMesh = IndexedMesh & Partial<Pick<FileMesh, 'groups' | 'lockedEdges' | 'lockedTriangles'>>;

/** A session of the mesh, with what keeps its attributes. */
export function sessionOf(mesh: OpenMesh, options: Options): Promise<FlipSession> {
  const { groups, lockedEdges, lockedTriangles } = mesh;
  return FlipSession.create(mesh, { groups, lockedEdges, lockedTriangles, ...options });
}

/** What the edges of a small mesh are, one entry a half-edge. */
export async function statesOf(session: FlipSession, indices: number): Promise<Uint8Array | undefined> {
  return indices <= 3 * COLOURED ? session.edgeStates() : undefined;
}

/** The result so far, without its triangles. */
export async function summaryOf(session: FlipSession): Promise<Summary> {
  const { indices, ...summary } = await session.result();
  return summary;
}

/**
 * How many edges are in each state. An edge has two half-edges but on the boundary, where it has one; how many have
 * three or more is known from elsewhere.
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

/** A mesh on an engine, with all that it went through. */
export class Run {
  /** Whether the engine is in a worker, and not on the GPU that draws. */
  readonly isInWorker: boolean;
  /** Why `auto` did not take the GPU that draws; the summary tells what else it did not take. */
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
  /** Whether the triangles of the engine are one iteration on from the newest that is recorded. */
  #isAhead = false;
  /** Where to go when an iteration that is being recorded has been. */
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

  /** The iteration that is shown: 0 is the input. */
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
   * One iteration on, recorded or new. Returns whether there was one. Calls wait for those before them: the track must
   * record an iteration before the next one changes the triangles.
   */
  forward(): Promise<boolean> {
    const call = this.#last.then(() => this.#forward());
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
    if (this.#isAhead) throw new Error('The last iteration could not be kept; begin again.');
    const step = await this.#stepper.step();
    if (this.#isFreed) return false;
    if (!step) {
      this.#hasEnded = true;
      return false;
    }
    // Someone may have sought another state meanwhile, and may do so while this is recorded.
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

  /** Shows a recorded state. */
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
   * Goes the way that another run of the mesh has gone, and shows the state that it shows.
   *
   * @throws where it ends sooner.
   */
  async follow(other: Run, signal?: AbortSignal): Promise<void> {
    const isBehind = () => this.iterations.length < other.iterations.length || (other.hasEnded && !this.#hasEnded);
    this.seek(this.iterations.length);
    while (isBehind() && !signal?.aborted && (await this.forward()));
    if (this.#hasEnded && isBehind()) throw new Error('it came to another end than the engine before');
    this.seek(Math.min(other.at, this.iterations.length));
  }

  get drawn(): Drawn {
    return this.#track.drawn(this.isNewest && !this.#isAhead);
  }

  lines(): Drawn | undefined {
    return this.#track.lines();
  }

  /** What the edges are in the state that is shown. */
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
