/**
 * The triangles of the playground: they fill the outline of its points, and are not Delaunay by themselves. Coordinates
 * are whole numbers below 1024, so each test here is exact.
 */

import type { Point } from './mesh.ts';

/** Points, and the corners of their triangles, three each. Points on one line have no triangles. */
export interface Planar {
  points: readonly Point[];
  triangles: readonly number[];
}

/** Twice the area of a triangle; positive if its corners turn as those of all triangles of the playground do. */
export function turn([ax, ay]: Point, [bx, by]: Point, [cx, cy]: Point): number {
  return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

/** Positive if `d` lies inside the circle through the corners of a triangle. */
export function inCircle(a: Point, b: Point, c: Point, d: Point): number {
  const [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(([x, y]): Point => [x - d[0], y - d[1]]) as [
    Point,
    Point,
    Point,
  ];
  return (
    (ax * ax + ay * ay) * (bx * cy - by * cx) -
    (bx * bx + by * by) * (ax * cy - ay * cx) +
    (cx * cx + cy * cy) * (ax * by - ay * bx)
  );
}

/** The corners of each triangle. */
export function cornersOf(triangles: readonly number[]): [number, number, number][] {
  return Array.from({ length: triangles.length / 3 }, (_, t) => [
    triangles[3 * t]!,
    triangles[3 * t + 1]!,
    triangles[3 * t + 2]!,
  ]);
}

/** The next half-edge of the same triangle. */
export const next = (h: number) => (h % 3 === 2 ? h - 2 : h + 1);

/** The half-edges by their ends. */
export function halvesOf(triangles: readonly number[]): Map<string, number> {
  return new Map(triangles.map((from, h) => [`${from} ${triangles[next(h)]}`, h]));
}

/** The way around: from each point of the outline to the next one. */
function outlineOf(triangles: readonly number[]): Map<number, number> {
  const halves = halvesOf(triangles);
  const sides = triangles.map((from, h): [number, number] => [from, triangles[next(h)]!]);
  return new Map(sides.filter(([from, to]) => !halves.has(`${to} ${from}`)));
}

/** Cuts ears off a way around a hole, or off an open way until it is convex. */
function fill(points: readonly Point[], way: readonly number[], isClosed: boolean): number[] {
  const left = [...way];
  const filled: number[] = [];
  const earAt = (i: number) => [-1, 0, 1].map((by) => left[(i + by + left.length) % left.length]!);
  const isEar = (i: number) => {
    if (!isClosed && (i === 0 || i === left.length - 1)) return false;
    const ear = earAt(i);
    const [a, b, c] = ear.map((corner) => points[corner]!) as [Point, Point, Point];
    if (turn(a, b, c) <= 0) return false;
    return !left.some((other) => {
      const p = points[other]!;
      return !ear.includes(other) && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
    });
  };
  while (left.length > 2) {
    const ear = left.findIndex((_, i) => isEar(i));
    if (ear < 0) break;
    filled.push(...earAt(ear));
    left.splice(ear, 1);
  }
  return filled;
}

/** The triangles without those at point `v`, whose place others take. */
function without(points: readonly Point[], triangles: readonly number[], v: number): number[] {
  const after = new Map<number, number>();
  const kept = cornersOf(triangles).flatMap((corners) => {
    const at = corners.indexOf(v);
    if (at < 0) return corners;
    after.set(corners[(at + 1) % 3]!, corners[(at + 2) % 3]!);
    return [];
  });
  const ends = new Set(after.values());
  const first = [...after.keys()].find((from) => !ends.has(from));
  const way: number[] = [];
  const start = first ?? after.keys().next().value;
  for (let at = start; at !== undefined && !(way.length > 0 && at === start); at = after.get(at)) way.push(at);
  return [...kept, ...fill(points, way, first === undefined)];
}

/** The triangles with point `v`, which none of them has yet. */
function joined(points: readonly Point[], triangles: readonly number[], v: number): number[] {
  const p = points[v]!;
  if (triangles.length === 0) {
    // All other points are on one line.
    const line = points.map((_, i) => i).filter((i) => i !== v);
    line.sort((i, j) => points[i]![0] - points[j]![0] || points[i]![1] - points[j]![1]);
    return line.slice(1).flatMap((to, i) => {
      const area = turn(points[line[i]!]!, points[to]!, p);
      return area === 0 ? [] : area > 0 ? [line[i]!, to, v] : [to, line[i]!, v];
    });
  }
  let isInside = false;
  const split = cornersOf(triangles).flatMap((corners) => {
    const sides = corners.map((from, k): [number, number] => [from, corners[(k + 1) % 3]!]);
    const areas = sides.map(([from, to]) => turn(points[from]!, points[to]!, p));
    if (areas.some((area) => area < 0)) return corners;
    isInside = true;
    // On a side there is no triangle between the side and the point.
    return sides.flatMap(([from, to], k) => (areas[k]! > 0 ? [from, to, v] : []));
  });
  if (isInside) return split;
  const seen = [...outlineOf(triangles)].filter(([from, to]) => turn(points[from]!, points[to]!, p) < 0);
  return [...triangles, ...seen.flatMap(([from, to]) => [to, from, v])];
}

/** Adds a point, which must not be at the place of another. */
export function withPoint({ points, triangles }: Planar, point: Point): Planar {
  const all = [...points, point];
  return { points: all, triangles: joined(all, triangles, points.length) };
}

/** Joins points one after the other. */
export const planarOf = (points: readonly Point[]) => points.reduce(withPoint, { points: [], triangles: [] });

/** Removes point `v`; those after it move up. */
export function withoutPoint({ points, triangles }: Planar, v: number): Planar {
  const left = without(points, triangles, v);
  return { points: points.filter((_, i) => i !== v), triangles: left.map((corner) => corner - Number(corner > v)) };
}

/** Whether all triangles turn the same way, and their outline has no dent. */
function isWhole(points: readonly Point[], triangles: readonly number[]): boolean {
  const isUp = (corners: readonly number[]) => {
    const [a, b, c] = corners.map((corner) => points[corner]!) as [Point, Point, Point];
    return turn(a, b, c);
  };
  const outline = outlineOf(triangles);
  return (
    cornersOf(triangles).every((corners) => isUp(corners) > 0) &&
    [...outline].every(([a, b]) => outline.has(b) && isUp([a, b, outline.get(b)!]) >= 0)
  );
}

/**
 * Moves point `v`. Its triangles stay if they can; where one would turn over or the outline would get a dent, the point
 * is taken out and joined anew.
 */
export function withMoved(planar: Planar, v: number, to: Point): { planar: Planar; isJoinedAnew: boolean } {
  const points = planar.points.map((point, i) => (i === v ? to : point));
  const { triangles } = planar;
  if (triangles.length > 0 && isWhole(points, triangles)) {
    return { planar: { points, triangles }, isJoinedAnew: false };
  }
  const rest = without(planar.points, triangles, v);
  return { planar: { points, triangles: joined(points, rest, v) }, isJoinedAnew: triangles.length > 0 };
}

/** Whether these triangles join these points as the playground does: a link may say anything. */
export function isTriangulation({ points, triangles }: Planar): boolean {
  const corners = cornersOf(triangles);
  if (triangles.length === 0) return planarOf(points).triangles.length === 0;
  const isKnown = triangles.length % 3 === 0 && triangles.every((corner) => points[corner]);
  if (!isKnown || new Set(triangles).size < points.length) return false;
  if (halvesOf(triangles).size < triangles.length || !isWhole(points, triangles)) return false;
  // The outline is one way around, and the triangles have its area.
  const outline = outlineOf(triangles);
  const start = outline.keys().next().value!;
  let [area, count] = [0, 0];
  for (let at = start; count === 0 || at !== start; at = outline.get(at)!, count++) {
    if (count > outline.size) return false;
    area += turn([0, 0], points[at]!, points[outline.get(at)!]!);
  }
  const sum = corners.reduce((total, [a, b, c]) => total + turn(points[a]!, points[b]!, points[c]!), 0);
  return count === outline.size && sum === area;
}
