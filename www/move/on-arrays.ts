/** Moves a mesh in arrays, with an engine in a worker. */

import type { IndexedMesh } from 'edgeflip/files';
import { FlipSession } from 'edgeflip/worker';
import type { Backend } from '../watch/run.ts';
import {
  bubble,
  HALF,
  kept,
  lengthOf,
  LONGEST,
  PUSH,
  rimOf,
  SHARPNESS,
  type Drag,
  type Motion,
  type Point,
  type Step,
} from './motions.ts';
import { LONG_AGO, type MovingMesh } from './moving-mesh.ts';
import { MovingSurface } from './moving-surface.ts';

const ENGINES = { cpu: 'CPU, in a worker', webgl2: 'WebGL2, in a worker', webgpu: 'WebGPU, in a worker' } as const;

export async function moveInArrays(mesh: IndexedMesh, motion: Motion, backend: Backend): Promise<MovingMesh> {
  const { dimension } = mesh;
  const positions = Float32Array.from(mesh.positions);
  const session = await FlipSession.create(mesh, { backend, maxNormalAngle: motion.beta });
  try {
    await session.run();
    let indices = await session.triangles();
    const surface = MovingSurface.onArrays(indices.length, dimension);
    const flashed = new Float32Array(indices.length).fill(LONG_AGO);
    const move = motion.pose
      ? poser(positions, motion.pose, dimension)
      : relaxer(positions, rimOf(await session.edges(), positions.length / 2), indices.length / 3);
    let time = 0;
    const take = async () => {
      const now = await session.triangles();
      // A flip gives each of its two triangles one new corner, at which the new edge begins.
      for (let i = 0; i < now.length; i++) if (now[i] !== indices[i]) flashed[i] = time;
      indices = now;
      surface.fill(positions, indices, flashed);
      surface.time = time;
    };
    return {
      engine: ENGINES[await session.backend()],
      surface,
      async frame(step) {
        time = step.time;
        move(step, indices);
        session.update({ positions });
        await take();
      },
      settled: async () => {},
      async finish() {
        session.update({ iterations: 64 });
        await take();
      },
      counters: () => session.counters(),
      mesh: async () => ({ positions: positions.slice(), indices, dimension }),
      free() {
        surface.dispose();
        session.free();
      },
    };
  } catch (error) {
    session.free();
    throw error;
  }
}

type Move = (step: Step, indices: Uint32Array) => void;

/** Moves each vertex to its place at a moment, and drags it away from there. */
function poser(positions: Float32Array, pose: (start: Point, seconds: number) => Point, dimension: 2 | 3): Move {
  const start = positions.slice();
  const away = new Float32Array((3 * start.length) / dimension);
  return (step) => {
    const share = kept(step);
    for (let v = 0; v < away.length / 3; v++) {
      const at = dimension * v;
      const home = pose([start[at]!, start[at + 1]!, dimension === 3 ? start[at + 2]! : 0], step.time);
      for (let k = 0; k < 3; k++) away[3 * v + k]! *= share;
      if (step.drag) {
        const here = home.map((x, k) => x + away[3 * v + k]!) as Point;
        dragged(step.drag, here).forEach((x, k) => (away[3 * v + k]! += x));
      }
      for (let k = 0; k < dimension; k++) positions[at + k] = home[k]! + away[3 * v + k]!;
    }
  };
}

/** Moves each interior vertex towards the mean of the circumcentres around it, weighted by area. */
function relaxer(positions: Float32Array, rim: Uint32Array, triangles: number): Move {
  const length = lengthOf(triangles);
  const sums = new Float64Array(3 * rim.length);
  const within = (x: number) => Math.max(-0.999 * HALF, Math.min(0.999 * HALF, x));
  return ({ drag, time, seconds }, indices) => {
    sums.fill(0);
    for (let h = 0; h < indices.length; h += 3) addCircumcentre(sums, positions, indices, h);
    const [x, y] = bubble(time);
    for (let v = 0; v < rim.length; v++) {
      const area = sums[3 * v + 2]!;
      if (rim[v] === 1 || area <= 0) continue;
      const here: Point = [positions[2 * v]!, positions[2 * v + 1]!, 0];
      const [sx, sy] = [(0.5 * sums[3 * v]!) / area, (0.5 * sums[3 * v + 1]!) / area];
      const shorter = Math.min(1, (LONGEST * length) / Math.max(Math.hypot(sx, sy), 1e-9));
      const [ax, ay] = [here[0] - x, here[1] - y];
      const push = PUSH.strength * seconds * Math.exp(-PUSH.sharpness * (ax * ax + ay * ay));
      const [dx, dy] = drag ? dragged(drag, here) : [0, 0];
      positions[2 * v] = within(here[0] + shorter * sx + push * ax + dx);
      positions[2 * v + 1] = within(here[1] + shorter * sy + push * ay + dy);
    }
  };
}

/** Adds to each corner of a triangle its way to the circumcentre, times the area, and the area. */
function addCircumcentre(sums: Float64Array, positions: Float32Array, indices: Uint32Array, h: number): void {
  const [a, b, c] = [indices[h]!, indices[h + 1]!, indices[h + 2]!];
  const [x, y] = [positions[2 * a]!, positions[2 * a + 1]!];
  const [bx, by] = [positions[2 * b]! - x, positions[2 * b + 1]! - y];
  const [cx, cy] = [positions[2 * c]! - x, positions[2 * c + 1]! - y];
  const area = bx * cy - by * cx;
  if (area <= 0) return;
  const [bb, cc] = [bx * bx + by * by, cx * cx + cy * cy];
  const [wx, wy] = [0.5 * (cy * bb - by * cc), 0.5 * (bx * cc - cx * bb)];
  for (const [corner, px, py] of [
    [a, 0, 0],
    [b, bx, by],
    [c, cx, cy],
  ] as const) {
    sums[3 * corner]! += wx - area * px;
    sums[3 * corner + 1]! += wy - area * py;
    sums[3 * corner + 2]! += area;
  }
}

/** How far a vertex is dragged. */
function dragged({ origin, way, depth, by }: Drag, here: Point): Point {
  const arm = here.map((x, k) => x - origin[k]!);
  const along = arm.reduce((sum, x, k) => sum + x * way[k]!, 0);
  if (along > depth) return [0, 0, 0];
  const square = arm.reduce((sum, x, k) => sum + (x - along * way[k]!) ** 2, 0);
  const share = Math.exp(-SHARPNESS * square);
  return by.map((x) => x * share) as Point;
}
