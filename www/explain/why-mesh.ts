/** The points of the first figure, and their triangles: scrambled, and as the engine makes them. */

import { makeDelaunay } from 'edgeflip';
import { scrambled } from '../models/scramble.js';
import { flat, type Point } from './mesh.ts';
import { planarOf } from './planar.ts';
import type { Joined } from './why-measures.ts';
import { SIZE } from './why-fields.ts';

const [COLUMNS, ROWS] = [15, 11];

/** Points on the border and scattered inside. Always the same. */
function scatter(): Point[] {
  let state = 7;
  const random = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32 - 0.5;
  };
  const points: Point[] = [];
  for (let row = 0; row <= ROWS; row++) {
    for (let column = 0; column <= COLUMNS; column++) {
      const place = ([at, count, size]: [number, number, number]) => {
        const isInside = at > 0 && at < count;
        const shift = random() * (isInside ? 0.75 : 0);
        return Math.round(((at + shift) * size) / count);
      };
      points.push([place([column, COLUMNS, SIZE[0]]), place([row, ROWS, SIZE[1]])]);
    }
  }
  return points;
}

/** A grid so fine that its contour lines look exact. */
export function fine(): Joined {
  const [columns, rows] = [100, 75];
  const points = Array.from({ length: (columns + 1) * (rows + 1) }, (_, i): Point => {
    const [column, row] = [i % (columns + 1), Math.floor(i / (columns + 1))];
    return [(column * SIZE[0]) / columns, (row * SIZE[1]) / rows];
  });
  const triangles = Array.from({ length: columns * rows }, (_, i) => {
    const corner = (i % columns) + Math.floor(i / columns) * (columns + 1);
    const [right, below, across] = [corner + 1, corner + columns + 1, corner + columns + 2];
    return [corner, right, across, corner, across, below];
  });
  return { points, triangles: triangles.flat() };
}

/** The engine's triangles for these points, with the flips and iterations that it took. */
export async function healed({ points, triangles }: Joined): Promise<Joined & { flips: number; iterations: number }> {
  const mesh = { positions: flat(points), indices: Uint32Array.from(triangles), dimension: 2 } as const;
  const { indices, flips, iterations } = await makeDelaunay(mesh, { backend: 'cpu', threads: 1 });
  return { points, triangles: [...indices], flips, iterations };
}

/** The points with round triangles. */
export const round = () => healed(planarOf(scatter()));

/** The triangles after so many flips at random. */
export function thinned({ points, triangles }: Joined, flips: number): Joined {
  const mesh = { dimension: 2, positions: flat(points), indices: triangles };
  return { points, triangles: [...scrambled(mesh, flips, 90, 5)] };
}
