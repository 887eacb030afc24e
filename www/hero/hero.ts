/** The first view: a mesh that moves. The engine keeps it Delaunay in every frame, and edges flash as they flip. */

import { FlipSession, init } from 'edgeflip';
import { number } from '../shell/numbers.ts';
import { stillness } from '../shell/stillness.ts';
import { Flashes } from './flashes.ts';
import { Motion } from './motion.ts';
import { Painter } from './paint.ts';
import { scatter, type Scatter, type Spacing } from './points.ts';

/** Below this width of the page, the words are under the mesh and not beside it. */
const NARROW = 861;
/** Rounds in which the points even out before they are shown. */
const ROUNDS = 12;
/** The moment of the still picture, in seconds of motion. */
const STILL = 2.9;
/** The longest step of the motion, in seconds: after a pause the mesh does not jump. */
const LONGEST = 0.04;

export class Hero {
  readonly #canvas: HTMLCanvasElement;
  readonly #painter: Painter;
  readonly #told: (words: string) => void;
  #session: FlipSession | undefined;
  #motion: Motion | undefined;
  #flashes = new Flashes(0);
  #indices = new Uint32Array();
  #finest = 1;
  /** Pixels of the canvas in a CSS pixel. */
  #scale = 1;
  /** The size of the picture, in pixels of the canvas. */
  #size: readonly [number, number] = [0, 0];
  #updates = 0;
  /** Flips in a frame, averaged over the last few. */
  #flips = 0;
  /** The number of the last start. A loop of an earlier one ends. */
  #starts = 0;

  /** `told` is called after each picture, with what to say of it. */
  constructor(canvas: HTMLCanvasElement, told: (words: string) => void) {
    // The engine loads while the points are scattered. The session loads it again and reports the error.
    init().catch(() => {});
    this.#canvas = canvas;
    this.#told = told;
    this.#painter = new Painter(canvas);
    canvas.addEventListener('pointermove', ({ offsetX, offsetY, movementX, movementY }) =>
      this.#motion?.stir(offsetX, offsetY, Math.hypot(movementX, movementY)),
    );
    canvas.addEventListener('pointerdown', ({ offsetX, offsetY }) => this.#motion?.drop(offsetX, offsetY));
  }

  /**
   * Makes the mesh for the size of the canvas and shows it. It moves, or stands still; `before` is called before it moves
   * and holds it until then.
   */
  async start(moves: boolean, before: () => Promise<unknown>): Promise<void> {
    const start = ++this.#starts;
    const [width, height] = [this.#canvas.clientWidth, this.#canvas.clientHeight];
    // Hidden: the visitor has gone on already. Points would find no place.
    if (width === 0 || height === 0) return;
    const spacing = spacingFor(width, height);
    const mesh = scatter(width, height, spacing);
    const session = await FlipSession.create(
      { ...mesh, dimension: 2 },
      { backend: 'cpu', threads: 1, trackChanges: true },
    );
    await evenOut(session, mesh, spacing);
    if (start !== this.#starts) return session.free();
    this.#session?.free();
    this.#session = session;
    this.#motion = new Motion(mesh, [width, height], spacing);
    this.#flashes = new Flashes(mesh.positions.length / 2);
    this.#indices = (await session.triangles()) as Uint32Array<ArrayBuffer>;
    this.#finest = Math.min(
      ...Array.from({ length: 400 }, (_, i) => spacing(((i % 20) * width) / 20, (height * i) / 400)),
    );
    this.#updates = (await session.counters()).updates;
    this.#scale = Math.min(2, devicePixelRatio);
    this.#size = [Math.floor(this.#scale * width), Math.floor(this.#scale * height)];
    const [step, until] = moves ? [1 / 60, 0] : [1 / 30, STILL];
    for (let time = 0; time <= until; time += step) await this.#frame(session, this.#motion, step);
    if (start !== this.#starts) return;
    this.#paint();
    if (moves) void before().then(() => this.#loop(start));
  }

  /** Ends the motion. The picture stays. */
  stop(): void {
    this.#starts++;
  }

  /** Paints again in the present colours of the page. */
  repaint(): void {
    this.#painter.recolour();
    this.#paint();
  }

  async #loop(start: number): Promise<void> {
    let last = performance.now();
    while (this.#session && this.#motion) {
      const now = await new Promise(requestAnimationFrame);
      if (start !== this.#starts) return;
      // On a slow GPU, pictures would queue up, and hold up everything else that uses it.
      if (!this.#painter.isDone) continue;
      await this.#frame(this.#session, this.#motion, Math.min(LONGEST, Math.max(0.008, (now - last) / 1000)));
      last = now;
      this.#paint();
    }
  }

  async #frame(session: FlipSession, motion: Motion, seconds: number): Promise<void> {
    motion.advance(seconds);
    session.update({ positions: motion.positions });
    this.#updates++;
    const [changes, now] = await Promise.all([session.changes(), session.triangles()]);
    this.#flashes.cool(seconds);
    this.#flashes.take(this.#indices, now, changes, this.#updates);
    this.#indices = now as Uint32Array<ArrayBuffer>;
    const changed = changes.reduce((count, update) => count + Number(update === this.#updates), 0);
    this.#flips += 0.08 * (changed / 2 - this.#flips);
  }

  #paint(): void {
    if (!this.#motion) return;
    const { positions, heights } = this.#motion;
    const [indices, flashes, finest] = [this.#indices, this.#flashes, this.#finest];
    // A canvas is black when its size has been set, and until then it keeps the picture before.
    const [width, height] = this.#size;
    if (this.#canvas.width !== width || this.#canvas.height !== height) Object.assign(this.#canvas, { width, height });
    this.#painter.paint({ positions, heights, indices, flashes, finest }, this.#scale);
    // The style sheet hides an empty canvas.
    this.#canvas.dataset['painted'] = '';
    const triangles = `${number.format(indices.length / 3)} triangles`;
    this.#told(
      stillness.matches
        ? `${triangles}. Motion is off, as your system asks.`
        : `Live: ${triangles}, ${number.format(Math.round(this.#flips))} flips in this frame`,
    );
  }
}

/** Close together along a ribbon beside the words, or above them where the page is narrow. */
function spacingFor(width: number, height: number): Spacing {
  const isNarrow = width < NARROW;
  const unit = Math.min(1.7, Math.max(0.62, Math.sqrt(width * height) / 1140));
  const [fine, coarse] = [(isNarrow ? 9.5 : 8.6) * Math.max(0.9, unit), (isNarrow ? 50 : 96) * unit];
  return (x, y) => {
    const [u, v] = [x / width, y / height];
    const distance = isNarrow
      ? Math.abs(v - 0.27 - 0.09 * Math.sin(4.2 * u + 0.6)) / 0.4
      : Math.abs(0.9 * (u - 0.7 + 0.13 * Math.sin(4.1 * v - 1.15)) + (0.42 * (v - 0.5) * height) / width) / 0.56;
    return fine + (coarse - fine) * Math.min(1, distance ** 1.25);
  };
}

/** Moves each point to the mean of the triangles around it, a few times, and lets the engine flip after each. */
async function evenOut(session: FlipSession, { positions, fixed }: Scatter, spacing: Spacing): Promise<void> {
  for (let round = 0; round < ROUNDS; round++) {
    const indices = await session.triangles();
    const sums = new Float64Array((positions.length / 2) * 3);
    for (let t = 0; t < indices.length; t += 3) {
      const corners = [indices[t]!, indices[t + 1]!, indices[t + 2]!];
      const [[ax, ay], [bx, by], [cx, cy]] = corners.map((v) => [positions[2 * v]!, positions[2 * v + 1]!]) as [
        [number, number],
        [number, number],
        [number, number],
      ];
      const [x, y] = [(ax + bx + cx) / 3, (ay + by + cy) / 3];
      // Small spacings pull harder, so they stay small.
      const weight = Math.abs((bx - ax) * (cy - ay) - (by - ay) * (cx - ax)) / spacing(x, y) ** 3;
      for (const v of corners) {
        sums[3 * v]! += weight * x;
        sums[3 * v + 1]! += weight * y;
        sums[3 * v + 2]! += weight;
      }
    }
    for (let v = fixed; v < positions.length / 2; v++) {
      const [x, y, weight] = [sums[3 * v]!, sums[3 * v + 1]!, sums[3 * v + 2]!];
      positions[2 * v]! += 0.8 * (x / weight - positions[2 * v]!);
      positions[2 * v + 1]! += 0.8 * (y / weight - positions[2 * v + 1]!);
    }
    session.update({ positions, iterations: 64 });
  }
}
