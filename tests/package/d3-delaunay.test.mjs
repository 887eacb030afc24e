// What d3-delaunay promises, of `edgeflip/points` in Node: the neighbours of a point, the hull, the nearest point and the
// cells that touch, next to d3-delaunay itself. voronoi.test.mjs compares the cells.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Delaunay } from 'd3-delaunay';
import { init, PointSession, triangulateSync, voronoiSync } from 'edgeflip/points';
import { randomOf } from './points.mjs';

await init();
const BOUNDS = [100, 50, 900, 1000];

/** The points that are joined to each point, also where all are on one line. */
function neighboursOf({ triangles, hull }, count) {
  const neighbours = Array.from({ length: count }, () => new Set());
  const join = (a, b) => neighbours[a].add(b) && neighbours[b].add(a);
  triangles.forEach((v, h) => {
    join(v, triangles[h % 3 === 2 ? h - 2 : h + 1]);
  });
  if (triangles.length === 0) for (let k = 1; k < hull.length; k++) join(hull[k - 1], hull[k]);
  return neighbours;
}

/** The ring from its smallest index on, in the other direction. */
function turned(hull) {
  const ring = [...hull].reverse();
  const least = ring.indexOf(Math.min(...ring));
  return [...ring.slice(least), ...ring.slice(0, least)];
}

/** The corners of a cell, as texts. */
const cornersOf = ({ starts, corners }, i) =>
  new Set(
    Array.from({ length: starts[i + 1] - starts[i] }, (_, k) => `${corners.subarray(2 * (starts[i] + k)).slice(0, 2)}`),
  );

/** Places between and around the points, each near the one before. */
function placesOf(count, random) {
  const places = [[random(1024), random(1024)]];
  while (places.length < count) places.push(places.at(-1).map((x) => x + (random(2 ** 16) - 2 ** 15) / 2 ** 8));
  return places;
}

const scattered = (count, random) =>
  Array.from({ length: count }, () => [random(2 ** 20) / 2 ** 10, random(2 ** 20) / 2 ** 10]);

test('neighbours, hull and cells that touch are those of d3-delaunay', () => {
  const random = randomOf(5);
  for (const count of [3, 4, 5, 10, 300, 3000]) {
    const points = scattered(count, random);
    const triangulation = triangulateSync(points);
    const [neighbours, delaunay] = [neighboursOf(triangulation, count), Delaunay.from(points)];
    assert.deepEqual([...triangulation.hull], turned(delaunay.hull));
    const [diagram, voronoi] = [voronoiSync(points, triangulation, { bounds: BOUNDS }), delaunay.voronoi(BOUNDS)];
    const cells = points.map((_, i) => cornersOf(diagram, i));
    let [joined, touching] = [0, 0];
    for (const [i, around] of neighbours.entries()) {
      assert.deepEqual(around, new Set(delaunay.neighbors(i)), `${count} points, neighbours of ${i}`);
      const common = [...around].filter((j) => [...cells[i]].filter((corner) => cells[j].has(corner)).length === 2);
      assert.deepEqual(new Set(common), new Set(voronoi.neighbors(i)), `${count} points, cells that touch ${i}`);
      joined += around.size;
      touching += common.length;
    }
    // Some only touch outside of the box.
    if (count > 10) assert.ok(0 < touching && touching < joined);
  }
});

test('the nearest point is the one that d3-delaunay finds, on a walk', async () => {
  const random = randomOf(9);
  for (const count of [1, 2, 3, 10, 300, 3000]) {
    const points = scattered(count, random);
    const [session, delaunay] = [await PointSession.create(points), Delaunay.from(points)];
    const voronoi = delaunay.voronoi(BOUNDS);
    let found = 0;
    for (const [x, y] of placesOf(2000, random)) {
      found = delaunay.find(x, y, found);
      assert.equal(session.nearest(x, y), found, `${count} points, ${x}, ${y}`);
      const other = random(count);
      assert.equal(session.nearest(x, y) === other, voronoi.contains(other, x, y));
      assert.ok(voronoi.contains(found, x, y));
    }
    session.free();
  }
});

test('of equal points one has the neighbours, as in d3-delaunay', async () => {
  const random = randomOf(13);
  for (const count of [2, 5, 40, 600]) {
    const points = scattered(count, random);
    for (let i = 0; i < count; i++) points.splice(random(points.length + 1), 0, points[random(points.length)]);
    const triangulation = triangulateSync(points);
    const first = Array.from(points, (_, i) => i);
    const { duplicates } = triangulation;
    for (let k = 0; k < duplicates.length; k += 2) first[duplicates[k]] = duplicates[k + 1];
    assert.equal(duplicates.length, 2 * count);
    const [neighbours, delaunay] = [neighboursOf(triangulation, points.length), Delaunay.from(points)];
    const theirs = Array.from(points, () => new Set());
    for (const i of points.keys()) for (const j of delaunay.neighbors(i)) theirs[first[i]].add(first[j]);
    assert.deepEqual(neighbours, theirs);
    const session = await PointSession.create(points);
    for (const [x, y] of placesOf(300, random)) {
      assert.equal(session.nearest(x, y), first[delaunay.find(x, y)]);
    }
    session.free();
  }
});

test('points on a line have the neighbours and the cells of d3-delaunay, which moves them', async () => {
  const random = randomOf(17);
  for (const [dx, dy] of [
    [1, 0],
    [0, 1],
    [3, 2],
    [-2, 5],
  ]) {
    const places = Array.from({ length: 30 }, (_, i) => 4 * i + random(3));
    const points = places.map((t) => [500 + 2 * dx * t, 300 + dy * t]);
    for (let i = points.length - 1; i > 0; i--) {
      const j = random(i + 1);
      [points[i], points[j]] = [points[j], points[i]];
    }
    const triangulation = triangulateSync(points);
    const delaunay = Delaunay.from(points);
    assert.deepEqual([...triangulation.hull], [...delaunay.collinear]);
    const neighbours = neighboursOf(triangulation, points.length);
    const voronoi = delaunay.voronoi(BOUNDS);
    const diagram = voronoiSync(points, triangulation, { bounds: BOUNDS });
    const session = await PointSession.create(points);
    for (const [i, [x, y]] of points.entries()) {
      assert.deepEqual(neighbours[i], new Set(delaunay.neighbors(i)));
      const theirs = voronoi.cellPolygon(i);
      assert.equal(cornersOf(diagram, i).size > 0, theirs !== null, `${i}`);
      for (const corner of cornersOf(diagram, i)) {
        const [cx, cy] = corner.split(',').map(Number);
        assert.ok(
          theirs.some(([px, py]) => Math.hypot(px - cx, py - cy) < 0.01),
          `${i}: ${corner}, ${theirs}`,
        );
      }
      const near = [x + random(100) / 100, y - random(100) / 100];
      assert.deepEqual([session.nearest(...near), delaunay.find(...near)], [i, i]);
    }
    session.free();
  }
});
