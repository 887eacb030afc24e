/** Scatters the points of the first view: close together along a ribbon, far apart where the words are. */

import Delaunator from 'delaunator';

/** The distance that neighbours should have at a place, in pixels. */
export type Spacing = (x: number, y: number) => number;

/** Points in the plane, joined into triangles. The first `fixed` of them are the rim. */
export interface Scatter {
  positions: Float32Array<ArrayBuffer>;
  indices: Uint32Array<ArrayBuffer>;
  fixed: number;
}

/** How far the mesh reaches beyond the picture, in pixels. */
const MARGIN = 80;
/** The distance of points of the rim. */
const RIM = 60;
/** Failures in a row after which the picture is full. */
const PATIENCE = 1500;
/** The part of the wanted distance that is kept free around each point. */
const FREE = 0.78;
/** The size of the cells of the table of spacings, in pixels. */
const STEP = 8;

/** Numbers from 0 to 1 that are the same in every visit. */
function generator(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

export function scatter(width: number, height: number, spacing: Spacing): Scatter {
  const random = generator(2011);
  const [left, top, right, bottom] = [-MARGIN, -MARGIN, width + MARGIN, height + MARGIN];
  const points: [number, number][] = [];
  const side = (from: [number, number], to: [number, number]) => {
    const count = Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / RIM);
    for (let i = 0; i < count; i++) {
      points.push([from[0] + ((to[0] - from[0]) * i) / count, from[1] + ((to[1] - from[1]) * i) / count]);
    }
  };
  side([left, top], [right, top]);
  side([right, top], [right, bottom]);
  side([right, bottom], [left, bottom]);
  side([left, bottom], [left, top]);
  const fixed = points.length;

  // A grid finds the points around a place: of each cell the last point, and of each point the one before it there.
  const cell = 24;
  const column = (x: number) => Math.floor((x - left) / cell);
  const row = (y: number) => Math.floor((y - top) / cell);
  const [columns, rows] = [column(right) + 1, row(bottom) + 1];
  const last = new Int32Array(columns * rows).fill(-1);
  const before: number[] = [];
  const keep = (index: number) => {
    const [x, y] = points[index]!;
    const at = column(x) + columns * row(y);
    before[index] = last[at]!;
    last[at] = index;
  };
  points.forEach((_, index) => keep(index));
  const isFree = (x: number, y: number, radius: number) => {
    const [from, to] = [Math.max(0, column(x - radius)), Math.min(columns - 1, column(x + radius))];
    const end = Math.min(rows - 1, row(y + radius));
    for (let v = Math.max(0, row(y - radius)); v <= end; v++) {
      for (let u = from; u <= to; u++) {
        for (let index = last[u + columns * v]!; index >= 0; index = before[index]!) {
          const point = points[index]!;
          if ((point[0] - x) ** 2 + (point[1] - y) ** 2 < radius * radius) return false;
        }
      }
    }
    return true;
  };
  // Hundreds of thousands of places are tried, so the spacing comes from a table.
  const wantedIn = new Float64Array(Math.ceil((right - left) / STEP) * Math.ceil((bottom - top) / STEP));
  const across = Math.ceil((right - left) / STEP);
  for (let i = 0; i < wantedIn.length; i++) {
    wantedIn[i] = spacing(left + (0.5 + (i % across)) * STEP, top + (0.5 + Math.floor(i / across)) * STEP);
  }
  // Where points lie close together, more of them are tried.
  const least = wantedIn.reduce((a, b) => Math.min(a, b));
  for (let failures = 0; failures < PATIENCE; ) {
    const [x, y] = [left + 8 + random() * (right - left - 16), top + 8 + random() * (bottom - top - 16)];
    const wanted = wantedIn[Math.floor((x - left) / STEP) + across * Math.floor((y - top) / STEP)]!;
    if (random() > 1.6 * (least / wanted) ** 2) continue;
    if (isFree(x, y, FREE * wanted)) {
      keep(points.push([x, y]) - 1);
      failures = 0;
    } else {
      failures++;
    }
  }
  const positions = Float32Array.from(points.flat());
  return { positions, indices: new Uint32Array(new Delaunator(positions).triangles), fixed };
}
