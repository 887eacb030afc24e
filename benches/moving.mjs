// Points that move in every frame, next to delaunator: `node benches/moving.mjs`. On one thread of Node; prints medians and
// ratios. Uses the existing dist/. `node benches/moving.mjs 1000 0.2` takes 1,000 points that move by a fifth of their
// spacing.

import Delaunator from 'delaunator';
import { FlipSession } from 'edgeflip';

const [POINTS = 10_000, STEP = 0.05] = process.argv.slice(2).map(Number);
const FRAMES = 200;
/** Frames that compile the code. */
const WARM = 40;
/** The vertices of the convex ring, which stays. */
const RING = 4 * Math.round(Math.sqrt(POINTS));
/** The mean distance of neighbours, on a disc of radius 1. */
const SPACING = Math.sqrt(Math.PI / POINTS);

let seed = 20261129;
/** A number from 0 to 1, from a linear congruential generator. */
function random() {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
}

/** Whether a point is inside the ring, and not at it. */
const isInside = (x, y) => Math.hypot(x, y) < 1 - SPACING / 4;

function start() {
  const points = [];
  for (let i = 0; i < RING; i++) {
    const angle = (2 * Math.PI * i) / RING;
    points.push(Math.cos(angle), Math.sin(angle));
  }
  while (points.length < 2 * (RING + POINTS)) {
    const [x, y] = [2 * random() - 1, 2 * random() - 1];
    if (isInside(x, y)) points.push(x, y);
  }
  return points;
}

/** Moves all points but the ring. */
function move(positions) {
  for (let i = 2 * RING; i < positions.length; i += 2) {
    const [angle, length] = [2 * Math.PI * random(), STEP * SPACING];
    const [x, y] = [positions[i] + length * Math.cos(angle), positions[i + 1] + length * Math.sin(angle)];
    if (isInside(x, y)) [positions[i], positions[i + 1]] = [x, y];
  }
}

/** The triangles without their order, each from its smallest vertex on. */
function setOf(indices) {
  const triangles = new Set();
  for (let i = 0; i < indices.length; i += 3) {
    const corners = indices.slice(i, i + 3);
    const first = corners.indexOf(Math.min(...corners));
    triangles.add([0, 1, 2].map((k) => corners[(first + k) % 3]).join());
  }
  return triangles;
}

/** The triangles that only one of them has. */
function difference(...pair) {
  const [one, other] = pair.map(setOf);
  return [...one].filter((triangle) => !other.has(triangle)).length + other.size - one.size;
}

const median = (times) => times.toSorted((a, b) => a - b)[times.length >> 1];

async function measure(name, positions) {
  const delaunator = new Delaunator(positions);
  const mesh = { positions, indices: delaunator.triangles, dimension: 2 };
  const session = await FlipSession.create(mesh, { backend: 'cpu', order: 'any', threads: 1 });
  const contenders = {
    async ours() {
      await session.setPositions(positions);
      return (await session.run()).indices;
    },
    delaunator() {
      delaunator.update();
      return delaunator.triangles;
    },
  };
  const times = { ours: [], delaunator: [] };
  let different = 0;
  for (let frame = -WARM; frame < FRAMES; frame++) {
    move(positions);
    const made = {};
    // Each goes first in every other frame.
    const order = Object.keys(contenders);
    for (const contender of frame % 2 ? order : order.reverse()) {
      const begin = performance.now();
      made[contender] = await contenders[contender]();
      if (frame >= 0) times[contender].push(performance.now() - begin);
    }
    if (frame % 20 === 0) different += difference(made.ours, made.delaunator);
  }
  session.free();
  const [ours, theirs] = [median(times.ours), median(times.delaunator)];
  const ratio = median(times.ours.map((time, frame) => time / times.delaunator[frame]));
  console.log(`| ${name} | ${ratio.toFixed(2)} | ${ours.toFixed(2)} | ${theirs.toFixed(2)} | ${different} |`);
}

console.log(
  `${POINTS} points in a ring of ${RING}, all but the ring move by ${STEP} of the spacing in each of ${FRAMES} frames;`,
);
console.log('milliseconds of a frame, medians, on one thread of Node; interleaved.\n');
console.log(
  '| coordinates | ours : delaunator | `setPositions` and `run` | `update` of delaunator | other triangles |',
);
console.log('|---|---:|---:|---:|---:|');
const points = start();
await measure('32-bit', Float32Array.from(points));
await measure('64-bit', Float64Array.from(points));
