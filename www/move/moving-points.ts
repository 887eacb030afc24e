/** Points that orbit, and that the pointer drags: a `PointSession` triangulates them in each frame. */

import { PointSession } from 'edgeflip/points';
import type { IndexedMesh } from 'edgeflip/files';
import { sunflower } from '../models/samples.js';
import { counted, number } from '../shell/numbers.ts';
import type { Step } from './motions.ts';
import { LONG_AGO, type MovingMesh } from './moving-mesh.ts';
import { PointGrip } from './point-grip.ts';
import { PointPicture } from './point-picture.ts';
import type { Started } from './starting.ts';

/** How many points there are, and the radius of their disc. */
const [COUNT, RADIUS] = [600, 0.7];
/** How far the points go in and out, as a share of their radius. */
const SWAY = 0.08;

/** The radians that a point at this distance from the middle turns in a second: less, the further out it is. */
const speedAt = (radius: number) => 0.06 / (radius + 0.25);
const swayOf = (i: number, time: number) => 1 + SWAY * Math.sin(0.6 * time + 1.7 * i);

/** Starts them. `pixel` is the size of a pixel in the scene. */
export async function startPoints(pixel: () => number, signal: AbortSignal): Promise<Started> {
  const positions = sunflower(COUNT).map((at) => RADIUS * at);
  const session = await PointSession.create(positions);
  if (signal.aborted) {
    session.free();
    throw signal.reason;
  }
  const moving = new MovingPoints(session, positions, pixel);
  const words: Started['words'] = {
    size: counted(COUNT, 'point'),
    drag: 'Drag any of them, also across the hull.',
    engine: moving.engine,
    unit: 'new edges',
    facts: () => ({
      Triangles: number.format(moving.triangles),
      Points: number.format(COUNT),
      'Points on the hull': number.format(moving.onHull),
    }),
  };
  const grip: Started['grip'] = (view, scene, changed) => new PointGrip(view, scene, moving, changed);
  return { moving, words, remark: '', view: { dimension: 2, box: [1.15 * RADIUS, 1.15 * RADIUS, 0] }, grip };
}

export class MovingPoints implements MovingMesh {
  readonly engine = 'edgeflip/points, on the CPU';
  readonly surface: PointPicture;
  readonly #session: PointSession;
  readonly #positions: Float32Array;
  /** For each point, the radius of its orbit, and the angle at which it began. */
  readonly #orbits = new Float64Array(2 * COUNT);
  readonly #begun = performance.now();
  #time = 0;
  /** The point that the pointer holds. It stands still. */
  held: number | undefined;
  #indices: Uint32Array = new Uint32Array();
  #hull: Uint32Array = new Uint32Array();
  /** The moment at which each edge appeared, by its ends. */
  #edges = new Map<number, number>();
  #appeared = 0;
  #frames = 0;

  constructor(session: PointSession, positions: Float32Array, pixel: () => number) {
    this.#session = session;
    this.#positions = positions;
    this.surface = new PointPicture(COUNT, pixel);
    for (let i = 0; i < COUNT; i++) this.#setOrbit(i);
    this.#take(LONG_AGO);
    this.#appeared = 0;
  }

  async frame({ time }: Step): Promise<void> {
    this.#time = time;
    for (let i = 0; i < COUNT; i++) {
      const radius = this.#orbits[2 * i]!;
      const [away, angle] = [radius * swayOf(i, time), this.#orbits[2 * i + 1]! + speedAt(radius) * time];
      if (i !== this.held) this.#positions.set([away * Math.cos(angle), away * Math.sin(angle)], 2 * i);
    }
    this.#session.update(this.#positions);
    this.#frames++;
    this.#take(this.#now);
  }

  async settled(): Promise<void> {}

  /** All edges are Delaunay already, and those that have just appeared cool down at once. */
  async finish(): Promise<void> {
    this.surface.time = this.#now - LONG_AGO;
  }

  async counters() {
    return { flips: this.#appeared, updates: this.#frames, remaining: {}, inverted: 0, flat: 0 };
  }

  async mesh(): Promise<IndexedMesh> {
    return { positions: this.#positions.slice(), indices: this.#indices, dimension: 2 };
  }

  free(): void {
    this.surface.dispose();
    this.#session.free();
  }

  get triangles(): number {
    return this.#indices.length / 3;
  }

  get onHull(): number {
    return this.#hull.length;
  }

  /** The point that is nearest to a place, and where it is. */
  nearest(x: number, y: number): [index: number, x: number, y: number] {
    const index = this.#session.nearest(x, y)!;
    return [index, this.#positions[2 * index]!, this.#positions[2 * index + 1]!];
  }

  /** Moves a point. It orbits on from there. */
  moveTo(index: number, x: number, y: number): void {
    this.#positions.set([x, y], 2 * index);
    this.#setOrbit(index);
  }

  /** Takes the orbit on which a point is where it is now. */
  #setOrbit(i: number): void {
    const [x, y] = [this.#positions[2 * i]!, this.#positions[2 * i + 1]!];
    const radius = Math.hypot(x, y) / swayOf(i, this.#time);
    this.#orbits.set([radius, Math.atan2(y, x) - speedAt(radius) * this.#time], 2 * i);
  }

  /** Takes the triangles from the session. Edges that were not there before have appeared at this moment. */
  #take(moment: number): void {
    const indices = this.#session.triangles();
    const flashed = new Float32Array(indices.length);
    const edges = new Map<number, number>();
    indices.forEach((v, h) => {
      const end = indices[h % 3 === 2 ? h - 2 : h + 1]!;
      const key = Math.min(v, end) * COUNT + Math.max(v, end);
      edges.set(key, (flashed[h] = this.#edges.get(key) ?? moment));
    });
    for (const key of edges.keys()) if (!this.#edges.has(key)) this.#appeared++;
    [this.#indices, this.#hull, this.#edges] = [indices, this.#session.hull(), edges];
    this.surface.fill(this.#positions, indices, flashed, this.#hull, this.held);
    this.surface.time = this.#now;
  }

  /** Seconds since the start, also while the points stand still. */
  get #now(): number {
    return (performance.now() - this.#begun) / 1000;
  }
}
