// Sets of points with whole coordinates, an oracle that triangulates them by integers of any size, and a matcher of errors.

import assert from 'node:assert/strict';
import { EdgeflipError } from 'edgeflip/points';

/** A matcher of the error. */
export const refused = (code, message) => (error) => {
  assert.ok(error instanceof EdgeflipError, String(error?.stack ?? error));
  assert.equal(error.code, code, error.message);
  assert.match(error.message, message);
  return true;
};

/** A function that returns whole numbers below its argument. */
export function randomOf(seed) {
  let state = seed;
  return (below) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * below);
  };
}

/** The whole points of a circle around 0 whose square of the radius is 1105. */
const CIRCLE = Array.from({ length: 67 * 67 }, (_, i) => [(i % 67) - 33, Math.floor(i / 67) - 33]).filter(
  ([x, y]) => x * x + y * y === 1105,
);

const list = (count, point) => Array.from({ length: count }, (_, i) => point(i));
const kind = (has, make) => Object.assign(make, { has });

/** Functions that make points, and what some of their sets have. */
export const KINDS = {
  'few places': kind('duplicates', (count, random) => list(count, () => [random(3), random(3)])),
  'a small lattice': kind('ties', (count, random) => list(count, () => [random(5), random(5)])),
  'a wide square': kind('triangles', (count, random) => list(count, () => [random(2 ** 30), random(2 ** 30)])),
  'on one circle': kind('ties', (count, random) => list(count, () => CIRCLE[random(CIRCLE.length)])),
  'on one line': kind('flat', (count, random) => list(count, () => random(20)).map((x) => [3 * x - 7, 5 * x])),
  'near one line': kind('triangles', (count, random) => list(count, () => [random(1000), random(2)])),
  'one above another': kind('triangles', (count, random) => list(count, () => [random(2), random(1000)])),
  'far away from 0': kind('ties', (count, random) => list(count, () => [2 ** 52 + random(4), random(4) - 2 ** 52])),
  'two far groups': kind('ties', (count, random) =>
    list(count, (i) => [random(4) + (i % 2) * 2 ** 45, random(4) - (i % 2) * 2 ** 40]),
  ),
  'of every size': kind('triangles', (count, random) => list(count, () => [2 ** random(53), -(2 ** random(53))])),
};

const isBefore = ([a, b], [c, d]) => a < c || (a === c && b < d);

/** Twice the area of a triangle. */
const area = ([ax, ay], [bx, by], [cx, cy]) => (ax - cx) * (by - cy) - (ay - cy) * (bx - cx);

/** Positive if `d` is inside the circle through three points, which are counter-clockwise; 0 if it is on it. */
function inCircle(a, b, c, d) {
  const [p, q, r] = [a, b, c].map(([x, y]) => [x - d[0], y - d[1]]);
  const square = ([x, y]) => x * x + y * y;
  const cross = ([ax, ay], [bx, by]) => ax * by - ay * bx;
  return square(p) * cross(q, r) - square(q) * cross(p, r) + square(r) * cross(p, q);
}

/**
 * Whether `d` counts as inside a circle that it is on. The least of the four points is taken as a little lower on the
 * paraboloid than it is. If that is a corner, the plane through the corners sinks there, and rises beyond the other two.
 */
function isInsideByTie(corners, d) {
  const least = [...corners, d].reduce((least, point) => (isBefore(point, least) ? point : least));
  if (least === d) return true;
  const i = corners.indexOf(least);
  return area(corners[(i + 1) % 3], corners[(i + 2) % 3], d) < 0n;
}

/** The triangles of distinct points by their definition, each from its smallest index, in order; and the number of ties. */
function triangulated(points, indices) {
  const triangles = [];
  let ties = 0;
  for (const [i, u] of indices.entries()) {
    for (const v of indices.slice(i + 1)) {
      for (const w of indices.slice(i + 1)) {
        if (area(points[u], points[v], points[w]) <= 0n) continue;
        const corners = [u, v, w].map((index) => points[index]);
        const others = indices.filter((index) => ![u, v, w].includes(index)).map((index) => points[index]);
        const signs = others.map((d) => inCircle(...corners, d));
        if (signs.some((sign) => sign > 0n)) continue;
        const onCircle = others.filter((_, k) => signs[k] === 0n);
        ties += onCircle.length;
        if (!onCircle.some((d) => isInsideByTie(corners, d))) triangles.push([u, v, w]);
      }
    }
  }
  return { triangles: triangles.sort(([a, b], [c, d]) => a - c || b - d), ties };
}

/** Compares a result with the definition. Returns the number of ties. */
export function checkTriangulation(given, { triangles, twins, hull, duplicates }) {
  const points = given.map((point) => point.map(BigInt));
  const first = new Map();
  const [indices, pairs] = [[], []];
  points.forEach((point, i) => {
    const key = point.join();
    if (first.has(key)) pairs.push([i, first.get(key)]);
    else {
      first.set(key, i);
      indices.push(i);
    }
  });
  assert.deepEqual([...duplicates], pairs.flat());
  const expected = triangulated(points, indices);
  assert.deepEqual([...triangles], expected.triangles.flat(), JSON.stringify(given));

  const end = (h) => triangles[h % 3 === 2 ? h - 2 : h + 1];
  const halfEdges = new Map(Array.from(triangles, (v, h) => [`${v},${end(h)}`, h]));
  assert.equal(halfEdges.size, triangles.length);
  assert.deepEqual(
    [...twins],
    Array.from(triangles, (v, h) => halfEdges.get(`${end(h)},${v}`) ?? 0xffffffff),
  );
  if (triangles.length === 0) {
    assert.deepEqual(
      [...hull],
      indices.sort((i, j) => (isBefore(points[i], points[j]) ? -1 : 1)),
    );
    return expected.ties;
  }
  const after = new Map();
  twins.forEach((g, h) => {
    if (g === 0xffffffff) after.set(triangles[h], end(h));
  });
  const around = [Math.min(...after.keys())];
  while (after.get(around.at(-1)) !== around[0]) around.push(after.get(around.at(-1)));
  assert.deepEqual([...hull], around);
  assert.equal(hull.length, after.size);
  return expected.ties;
}
