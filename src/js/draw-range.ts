/** The part of a geometry of three.js that is drawn, and the options for it. */

import { EdgeflipError } from './error.js';
import { shown, wordsOf } from './given.js';
import { placesOf } from './joined.js';
import { pointsOf, type Surface } from './surface.js';
import type { IndexArray, MakeDelaunayOptions } from './types.js';

/** The first index of the triangles that may change, and the end. */
export type Range = readonly [number, number];

/**
 * The indices of the whole triangles in a range that three.js draws. A range may begin before the first index or be
 * empty.
 *
 * @throws {@link EdgeflipError} `invalid-input`.
 */
export function rangeOf(name: string, { start, count }: { start: number; count: number }, corners: number): Range {
  const wrong = (why: string) => new EdgeflipError('invalid-input', `${name}: ${why}`);
  if (typeof start !== 'number' || typeof count !== 'number' || Number.isNaN(start + count)) {
    throw wrong(`its start ${shown(start)} and its count ${shown(count)} are not a range`);
  }
  const first = Math.max(0, start);
  const end = Math.min(corners, start + count);
  if (first >= end) return [0, 0];
  if (first % 3 !== 0) throw wrong(`it starts at ${start}, inside a triangle`);
  return [first, end - (end % 3)];
}

/**
 * The options for the triangles in the range. Their lists count all triangles of the surface.
 *
 * @throws {@link EdgeflipError} `invalid-option`.
 */
export function inRange(options: MakeDelaunayOptions, [start, end]: Range, surface: Surface): MakeDelaunayOptions {
  const corners = surface.indices.length;
  if (end - start === corners) return options;
  const [first, last, triangles] = [start / 3, end / 3, corners / 3];
  const wrong = (option: string, why: string) => new EdgeflipError('invalid-option', `option ${option}: ${why}`);
  const list = (name: string, given: IndexArray | undefined) =>
    given && wordsOf(given, `option ${name}`, 'invalid-option');
  const groups = list('groups', options.groups);
  if (groups && groups.length !== triangles) {
    throw wrong('groups', `it has ${groups.length} numbers, the geometry has ${triangles} triangles`);
  }
  const lockedTriangles = list('lockedTriangles', options.lockedTriangles);
  const beyond = lockedTriangles?.find((t) => t >= triangles);
  if (beyond !== undefined) {
    throw wrong('lockedTriangles', `there is no triangle ${beyond}; the geometry has ${triangles}`);
  }
  const lockedEdges = list('lockedEdges', options.lockedEdges);
  return {
    ...options,
    groups: groups?.slice(first, last),
    lockedTriangles: lockedTriangles?.filter((t) => first <= t && t < last).map((t) => t - first),
    lockedEdges: lockedEdges && edgesInRange(lockedEdges, [start, end], surface, options.weld !== false),
  };
}

/** The pairs that are edges in the range. A pair has to be an edge of the surface. */
function edgesInRange(pairs: Uint32Array, [start, end]: Range, surface: Surface, isJoined: boolean): Uint32Array {
  // The run refuses half a pair.
  if (pairs.length % 2 > 0) return pairs;
  const { indices, positions, vertices } = surface;
  const places = isJoined ? placesOf(pointsOf(positions, vertices)) : undefined;
  const placeOf = (vertex: number) => places?.[vertex] ?? vertex;
  // For each pair of places, the smaller one first: whether an edge in the range has it, and `undefined` for no edge.
  const found = new Map<number, Map<number, boolean | undefined>>();
  const ends = (u: number, v: number): [number, number] => {
    const [a, b] = [placeOf(u), placeOf(v)];
    return a < b ? [a, b] : [b, a];
  };
  const pairAt = (i: number): [number, number] => [pairs[i - (i % 2)]!, pairs[i - (i % 2) + 1]!];
  for (let i = 0; i < pairs.length; i += 2) {
    const [a, b] = ends(...pairAt(i));
    const seconds = found.get(a) ?? new Map();
    found.set(a, seconds.set(b, undefined));
  }
  for (let i = 0; i < indices.length; i++) {
    const [a, b] = ends(indices[i]!, indices[i % 3 < 2 ? i + 1 : i - 2]!);
    const seconds = found.get(a);
    if (seconds?.has(b)) seconds.set(b, seconds.get(b) || (start <= i && i < end));
  }
  return pairs.filter((_, i) => {
    const [u, v] = pairAt(i);
    const [a, b] = ends(u, v);
    const isInside = found.get(a)?.get(b);
    if (isInside !== undefined) return isInside;
    const message = `option lockedEdges: the geometry has no edge between vertices ${u} and ${v}`;
    throw new EdgeflipError('invalid-option', message);
  });
}
