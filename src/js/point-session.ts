/** Points that move, come and go; part of the entry `edgeflip/points`. */

import type { PointSession as ModuleSession } from './wasm/edgeflip_point_session.js';
import { type Accessors, coordinatesOf, type Places, placesOf, type Spacing } from './coordinates.js';
import { dispose } from './dispose.js';
import { EdgeflipError, fromModule } from './error.js';
import { copyOf, isWhole, itselfOf, shown } from './given.js';
import { loadSession, sessionClass } from './points-module.js';
import { type Triangulation, triangulationOf } from './triangulation.js';
import type { VertexArray } from './types.js';

/**
 * A Delaunay triangulation of points in the plane that move, come and go. After each call it is the one that
 * `triangulate` makes of the present points: hull and duplicates change along.
 *
 * Points keep their indices. A new point gets the next one, and the index of a point that was removed stays unused.
 *
 * ```ts
 * const session = await PointSession.create(points);
 * session.moveTo(7, 0.5, 0.25);
 * draw(session.triangles());
 * ```
 *
 * All calls work on the thread of the caller.
 *
 * @typeParam Points - What {@link PointSession.update} takes: what {@link PointSession.create} took.
 */
export class PointSession<Points = VertexArray | readonly number[] | readonly ArrayLike<number>[]> {
  readonly #session: ModuleSession;
  readonly #places: Places;
  #isFreed = false;

  private constructor(session: ModuleSession, places: Places) {
    this.#session = session;
    this.#places = places;
  }

  /**
   * Triangulates points. Reads them before it returns its promise. Loads the module.
   *
   * @param points - 2 numbers per point in any typed array or in an array of numbers, or a list of pairs.
   * @throws {@link EdgeflipError} `non-finite`, `ragged-array`, `invalid-input`, `invalid-option`, `too-large`,
   * `load-failed`.
   */
  static async create(
    points: VertexArray | readonly number[] | readonly ArrayLike<number>[],
    options?: Spacing,
  ): Promise<PointSession>;
  /** The same, of any list, with functions that read the coordinates. Their exceptions pass through. */
  static async create<P>(
    points: readonly P[] | (VertexArray & ArrayLike<P>),
    options: Accessors<P>,
  ): Promise<PointSession<readonly P[] | (VertexArray & ArrayLike<P>)>>;
  static async create(points: unknown, options: unknown = {}): Promise<unknown> {
    const places = placesOf(options);
    const coordinates = coordinatesOf(points, places, sessionClass() ? itselfOf : copyOf);
    const Session = sessionClass() ?? (await loadSession());
    try {
      return new PointSession(new Session(coordinates), places);
    } catch (thrown) {
      throw fromModule(thrown);
    }
  }

  /** The number of points, with those that were removed. */
  get length(): number {
    return this.#call((session) => session.length);
  }

  /**
   * Moves all points: one for each index, with the options of {@link PointSession.create}. Where points that were removed
   * are does not count. The fewer points change, and the less far they go, the less time it takes.
   *
   * @throws {@link EdgeflipError} `position-count` for another number of points; `non-finite`, `ragged-array`,
   * `invalid-input`, `too-large`, `freed`; exceptions of accessors pass through. Then nothing has changed.
   */
  update(points: Points): void {
    const coordinates = coordinatesOf(points, this.#places, itselfOf);
    this.#call((session) => session.update(coordinates));
  }

  /**
   * Moves one point.
   *
   * @throws {@link EdgeflipError} `invalid-input`, also if there is no such point; `non-finite`, `freed`. Then
   * nothing has changed.
   */
  moveTo(index: number, x: number, y: number): void {
    checkIndex(index);
    checkNumbers(x, y);
    this.#call((session) => session.moveTo(index, x, y));
  }

  /**
   * Adds a point.
   *
   * @returns Its index.
   * @throws {@link EdgeflipError} `non-finite`, `invalid-input`, `too-large`, `freed`. Then nothing has changed.
   */
  add(x: number, y: number): number {
    checkNumbers(x, y);
    return this.#call((session) => session.add(x, y));
  }

  /**
   * Removes a point. Of points that were equal to it, the one with the smallest index takes its place.
   *
   * @returns Whether there was such a point.
   * @throws {@link EdgeflipError} `invalid-input`, `freed`.
   */
  remove(index: number): boolean {
    checkIndex(index);
    return this.#call((session) => session.remove(index));
  }

  /** The present triangulation. @throws {@link EdgeflipError} `too-large`, `freed`. */
  triangulation(): Triangulation {
    return this.#call((session) => triangulationOf(session.triangulation(), 1));
  }

  /** Its triangles alone, which takes less time. @throws {@link EdgeflipError} `too-large`, `freed`. */
  triangles(): Uint32Array {
    return this.#call((session) => session.triangles());
  }

  /** Its hull alone. @throws {@link EdgeflipError} `too-large`, `freed`. */
  hull(): Uint32Array {
    return this.#call((session) => session.hull());
  }

  /**
   * The points of the triangle at a place, counter-clockwise from the smallest index; `undefined` outside of the hull. Of
   * several triangles, the first in the order of {@link PointSession.triangles}. It walks there from the place of the call
   * before, so that nearby places take little time.
   *
   * @throws {@link EdgeflipError} `invalid-input`, `freed`.
   */
  locate(x: number, y: number): [number, number, number] | undefined {
    checkNumbers(x, y);
    return this.#call((session) => session.locate(x, y));
  }

  /**
   * The point that is nearest to a place; of several, the one with the smallest index. `undefined` without a point, and
   * for NaN and infinity.
   *
   * @throws {@link EdgeflipError} `invalid-input`, `freed`.
   */
  nearest(x: number, y: number): number | undefined {
    checkNumbers(x, y);
    return this.#call((session) => session.nearest(x, y));
  }

  /** Frees the memory at once; the garbage collection frees it later. Later calls fail with `freed`. */
  free(): void {
    if (this.#isFreed) return;
    this.#isFreed = true;
    this.#session.free();
  }

  /** As {@link PointSession.free}: `using session = await PointSession.create(points)`. */
  [dispose](): void {
    this.free();
  }

  /** Calls the module. After an exception that is none of its errors, the session may be half changed. */
  #call<T>(work: (session: ModuleSession) => T): T {
    if (this.#isFreed) throw new EdgeflipError('freed', 'the session has been freed');
    try {
      return work(this.#session);
    } catch (thrown) {
      const error = fromModule(thrown);
      this.#isFreed = !(thrown instanceof Error && 'code' in thrown);
      throw error;
    }
  }
}

function checkIndex(index: unknown): void {
  if (isWhole(index)) return;
  throw new EdgeflipError('invalid-input', `index: ${shown(index)} is not a whole number of 32 bits`);
}

function checkNumbers(x: unknown, y: unknown): void {
  for (const [name, value] of Object.entries({ x, y })) {
    if (typeof value === 'number') continue;
    throw new EdgeflipError('invalid-input', `${name}: ${shown(value)} is not a number`);
  }
}
