// Points to triangles, next to delaunator, and triangles to Voronoi cells, next to d3-delaunay: `node benches/points.mjs`.
// On one thread of Node, from the caller's arrays to arrays of the result; prints ratios and milliseconds, medians of runs
// that alternate. Another table has the sets that are large enough for several threads: on all cores, next to one thread.
// Uses the existing dist/. `node benches/points.mjs 1000 1000000` takes these numbers of points.

import { spawnSync } from 'node:child_process';
import { performance } from 'node:perf_hooks';
import { fileURLToPath } from 'node:url';
import { Delaunay } from 'd3-delaunay';
import Delaunator from 'delaunator';

const RUNS = 11;
/** Runs before, which compile the code. */
const WARM = 3;

let seed = 20261130;
/** A number from 0 to 1, from a linear congruential generator. */
function random() {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 2 ** 32;
}

/** The sum of some numbers, which is nearly normal. */
const normal = () => Array.from({ length: 8 }, random).reduce((sum, x) => sum + x - 0.5);

const KINDS = {
  uniform: () => [random(), random()],
  clusters: () => {
    const centre = Math.floor(40 * random());
    return [(centre * 7) % 11, (centre * 3) % 13].map((x) => x + 0.05 * normal());
  },
  lattice: (i, count) => [i % Math.ceil(Math.sqrt(count)), Math.floor(i / Math.ceil(Math.sqrt(count)))],
};

const pointsOf = (kind, count) => {
  const points = new Float64Array(2 * count);
  for (let i = 0; i < count; i++) points.set(KINDS[kind](i, count), 2 * i);
  return points;
};

const CONTENDERS = {
  ours: async () => {
    const { init, triangulateSync } = await import('edgeflip/points');
    await init();
    return triangulateSync;
  },
  delaunator: async () => (points) => new Delaunator(points),
};

const median = (numbers) => numbers.toSorted((a, b) => a - b)[numbers.length >> 1];

/** Times of calls that alternate. A small set is called so often that the clock is fine enough. */
async function alternating(work, points) {
  const calls = Math.ceil(100_000 / points.length);
  const times = Object.fromEntries(Object.keys(work).map((name) => [name, []]));
  for (let run = 0; run < WARM + RUNS; run++) {
    for (const [name, call] of Object.entries(work)) {
      const start = performance.now();
      for (let i = 0; i < calls; i++) await call(points);
      if (run >= WARM) times[name].push((performance.now() - start) / calls);
    }
  }
  return times;
}

const warm = async (points) =>
  alternating({ ours: await CONTENDERS.ours(), delaunator: await CONTENDERS.delaunator() }, points);

/** Times on all cores and on one thread, and the number of threads. */
async function onThreads(points) {
  const { init, triangulate } = await import('edgeflip/points');
  await init();
  const { threads } = await triangulate(points);
  const work = { all: (points) => triangulate(points), one: (points) => triangulate(points, { threads: 1 }) };
  return { threads, times: await alternating(work, points) };
}

/** Times from the triangulation to the circumcentres and the polygons of all cells, in the smallest box. */
async function cells(points) {
  const { init, triangulateSync, voronoiSync } = await import('edgeflip/points');
  await init();
  const [triangulation, delaunay] = [triangulateSync(points), new Delaunay(points)];
  const bounds = [Infinity, Infinity, -Infinity, -Infinity];
  points.forEach((x, i) => {
    bounds[i % 2] = Math.min(bounds[i % 2], x);
    bounds[2 + (i % 2)] = Math.max(bounds[2 + (i % 2)], x);
  });
  const theirs = () => {
    const voronoi = delaunay.voronoi(bounds);
    for (let i = 0; 2 * i < points.length; i++) voronoi.cellPolygon(i);
  };
  const ours = () => voronoiSync(points, triangulation, { bounds });
  return alternating({ ours, theirs }, points);
}

/** Times of first calls, each in a process of its own, after its scripts are loaded. That of ours loads the module. */
function first(kind, count) {
  const times = { ours: [], delaunator: [] };
  for (let run = 0; run < RUNS; run++) {
    for (const name of Object.keys(CONTENDERS)) {
      const file = fileURLToPath(import.meta.url);
      const { stdout, stderr } = spawnSync(process.execPath, [file, 'first', name, kind, count], { encoding: 'utf8' });
      if (!(Number(stdout) > 0)) throw new Error(stderr);
      times[name].push(Number(stdout));
    }
  }
  return { ours: times.ours, theirs: times.delaunator };
}

/** The ratio of two lists of times, and both. */
function row(times) {
  const [first, second] = Object.values(times);
  const ratio = median(first.map((time, i) => time / second[i]));
  return [ratio, median(first), median(second)].map((number) => number.toFixed(2));
}

if (process.argv[2] === 'first') {
  const [name, kind, count] = process.argv.slice(3);
  const points = pointsOf(kind, Number(count));
  await import('edgeflip/points');
  const start = performance.now();
  (await CONTENDERS[name]())(points);
  console.log(performance.now() - start);
} else {
  const given = process.argv.slice(2).map(Number);
  const counts = given.length > 0 ? given : [1000, 10_000, 100_000, 1_000_000];
  console.log(
    '| points | warm: ours / delaunator | ours, ms | delaunator, ms | first call: ours / delaunator | ms | ms |',
  );
  console.log('|---|---:|---:|---:|---:|---:|---:|');
  for (const count of counts) {
    for (const kind of Object.keys(KINDS)) {
      const cells = [...row(await warm(pointsOf(kind, count))), ...row(first(kind, count))];
      console.log(`| ${count.toLocaleString('en')} ${kind} | ${cells.join(' | ')} |`);
    }
  }
  console.log('\n| points | threads | warm: threads / one thread | threads, ms | one thread, ms |');
  console.log('|---|---:|---:|---:|---:|');
  for (const count of counts) {
    for (const kind of Object.keys(KINDS)) {
      const { threads, times } = await onThreads(pointsOf(kind, count));
      if (threads > 1)
        console.log(`| ${count.toLocaleString('en')} ${kind} | ${[threads, ...row(times)].join(' | ')} |`);
    }
  }
  console.log('\n| cells of points | ours / d3-delaunay | ours, ms | d3-delaunay, ms |\n|---|---:|---:|---:|');
  for (const count of counts) {
    for (const kind of Object.keys(KINDS)) {
      const cellsOfKind = row(await cells(pointsOf(kind, count)));
      console.log(`| ${count.toLocaleString('en')} ${kind} | ${cellsOfKind.join(' | ')} |`);
    }
  }
}
