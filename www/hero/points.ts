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

  // A grid of buckets finds the points around a place.
  const cell = 24;
  const columns = Math.ceil((right - left) / cell) + 1;
  const buckets = new Map<number, [number, number][]>();
  const bucketOf = (x: number, y: number) => Math.floor((x - left) / cell) + columns * Math.floor((y - top) / cell);
  const keep = (point: [number, number]) => {
    const at = bucketOf(...point);
    buckets.set(at, [...(buckets.get(at) ?? []), point]);
  };
  points.forEach(keep);
  const isFree = (x: number, y: number, radius: number) => {
    const reach = Math.ceil(radius / cell) * cell;
    for (let v = y - reach; v <= y + reach; v += cell) {
      for (let u = x - reach; u <= x + reach; u += cell) {
        if (u < left || u > right + cell) continue;
        for (const [px, py] of buckets.get(bucketOf(u, v)) ?? []) {
          if ((px - x) ** 2 + (py - y) ** 2 < radius * radius) return false;
        }
      }
    }
    return true;
  };
  // Where points lie close together, more of them are tried.
  let least = Infinity;
  for (let i = 0; i < 400; i++) least = Math.min(least, spacing(random() * width, random() * height));
  for (let failures = 0; failures < PATIENCE; ) {
    const [x, y] = [left + 8 + random() * (right - left - 16), top + 8 + random() * (bottom - top - 16)];
    const wanted = spacing(x, y);
    if (random() > 1.6 * (least / wanted) ** 2) continue;
    if (isFree(x, y, FREE * wanted)) {
      keep([x, y]);
      points.push([x, y]);
      failures = 0;
    } else {
      failures++;
    }
  }
  const positions = Float32Array.from(points.flat());
  return { positions, indices: new Uint32Array(new Delaunator(positions).triangles), fixed };
}
