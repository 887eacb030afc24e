// Brings constraints into points, next to other libraries: `node benches/constraints.mjs`. Prints medians and
// ratios, first in Node, then natively. Uses the existing dist/. `node benches/constraints.mjs cdt2d` also measures cdt2d,
// which takes minutes.

import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';
import Constrainautor from '@kninnug/constrainautor';
import cdt2d from 'cdt2d';
import Delaunator from 'delaunator';
import { makeDelaunay } from 'edgeflip';
import { constrain, generate, writeMesh } from 'edgeflip/files';
import { feature } from 'topojson-client';

const RUNS = 5;
const WIDTH = 1000;
/** Milliseconds. A contender that takes longer runs once. */
const SLOW = 10_000;
const wants = new Set(process.argv.slice(2));

/**
 * The first 100,000 sides of the coasts of Natural Earth, which is in the public domain, in degrees, and the points of a
 * random mesh around them.
 */
async function coasts() {
  const path = createRequire(import.meta.url).resolve('world-atlas/land-10m.json');
  const map = JSON.parse(readFileSync(path, 'utf8'));
  const rings = feature(map, map.objects.land).features.flatMap(({ geometry }) => geometry.coordinates.flat());
  const vertices = new Map();
  const vertexAt = (point) => {
    const key = point.join(' ');
    if (!vertices.has(key)) vertices.set(key, vertices.size);
    return vertices.get(key);
  };
  const constraints = [];
  for (const ring of rings) {
    // Some rings jump from one side of the map to the other.
    const jumps = ring.some(([x], i) => i > 0 && Math.abs(x - ring[i - 1][0]) > 180);
    if (jumps || constraints.length >= 1e5) continue;
    constraints.push(...ring.slice(1).map((point, i) => [vertexAt(ring[i]), vertexAt(point)]));
  }
  const points = [...vertices.keys()].flatMap((key) => key.split(' ').map(Number));
  const { positions } = await generate(`random ${WIDTH}`);
  const width = Math.max(...positions.subarray(0, 2 * WIDTH));
  for (let i = 0; points.length < 2e6; i += 2) {
    points.push((positions[i] / width) * 360 - 180, (positions[i + 1] / width) * 180 - 90);
  }
  return { positions: Float64Array.from(points), constraints };
}

/** A thousand lines, each across 80 columns of a random mesh. */
async function lines() {
  const { positions } = await generate(`random ${WIDTH}`);
  const starts = Array.from(
    { length: 1000 },
    (_, i) => WIDTH * Math.floor(5 + 9.9 * Math.floor(i / 10)) + 5 + 99 * (i % 10),
  );
  return { positions: Float64Array.from(positions), constraints: starts.map((start) => [start, start + 80]) };
}

/** One line from the first point to the last of a long track with noise: it crosses nearly all triangles. */
async function track() {
  const length = 64_000;
  const { positions: noise } = await generate(`random ${Math.ceil(Math.sqrt(length))}`);
  const positions = Float64Array.from({ length: 2 * length }, (_, i) => (i % 2 ? noise[i] % 1 : i / 2));
  return { positions, constraints: [[0, length - 1]] };
}

const median = (times) => times.toSorted((a, b) => a - b)[times.length >> 1];

/** What takes a mesh, its twins and constraints. It gets the constraints as pairs and as one array. */
const CONTENDERS = {
  ours: ({ mesh, ends }) => makeDelaunay(mesh, { constraints: ends, backend: 'cpu', order: 'any', threads: 1 }),
  'of it to bring them in': ({ mesh, ends }) => constrain(mesh, ends),
  // It gets the twins for free.
  constrainautor: ({ mesh: { positions, indices }, twins, pairs }) =>
    new Constrainautor({ coords: positions, triangles: indices.slice(), halfedges: twins.slice() }, pairs),
  cdt2d: ({ mesh: { positions }, pairs }) => {
    const points = Array.from({ length: positions.length / 2 }, (_, i) => [positions[2 * i], positions[2 * i + 1]]);
    return cdt2d(points, pairs, { exterior: true });
  },
};

async function measure(job) {
  const names = Object.keys(CONTENDERS).filter((name) => name !== 'cdt2d' || wants.has(name));
  const times = Object.fromEntries(names.map((name) => [name, []]));
  for (let run = 0; run < RUNS; run++) {
    for (const name of names) {
      if (times[name][0] > SLOW) continue;
      const start = performance.now();
      await CONTENDERS[name](job);
      times[name].push(performance.now() - start);
    }
  }
  return Object.entries(times).map(([name, each]) => [name, median(each)]);
}

const folder = new URL('../target/constraints/', import.meta.url);
mkdirSync(folder, { recursive: true });
console.log(
  'From the triangles of delaunator to the constrained Delaunay triangulation, on one thread of Node, in seconds; medians',
);
console.log(
  'of interleaved runs. In brackets: that time divided by ours. cdt2d begins with the points: a million, and 64,000 of the',
);
console.log('track. Without constraints that cross others or pass through a point: other libraries refuse those.\n');
const files = [];
for (const [name, make] of Object.entries({ coasts, lines, track })) {
  const { positions, constraints } = await make();
  const { triangles, halfedges } = new Delaunator(positions);
  const mesh = { positions, indices: triangles, dimension: 2 };
  const { lockedEdges } = await constrain(mesh, constraints.flat(), {}, true);
  const edges = new Set();
  for (let i = 0; i < lockedEdges.length; i += 2) edges.add(lockedEdges.subarray(i, i + 2).join());
  const pairs = constraints.filter((pair) => edges.has(pair.join()));
  const ends = Uint32Array.from(pairs.flat());
  const { crossedEdges } = await constrain(mesh, ends);
  const times = await measure({ mesh, twins: halfedges, pairs, ends });
  if (files.length === 0) {
    console.log(`| constraints | edges crossed | ${times.map(([contender]) => contender).join(' | ')} |`);
    console.log(`|---|---:|${'---:|'.repeat(times.length)}`);
  }
  const cells = times.map(([, ms]) => `${(ms / 1000).toFixed(3)} (${(ms / times[0][1]).toFixed(2)})`);
  console.log(`| ${[`${pairs.length} ${name}`, crossedEdges, ...cells].join(' | ')} |`);
  const file = fileURLToPath(new URL(name, folder));
  writeFileSync(`${file}.ply`, await writeMesh(mesh, `${name}.ply`));
  writeFileSync(`${file}.txt`, pairs.map((pair) => `${pair.join(' ')}\n`).join(''));
  files.push(file);
}
execFileSync('cargo', ['bench', '-p', 'benches', '--bench', 'constraints', '--', ...files], { stdio: 'inherit' });
