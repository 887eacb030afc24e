// Passes hostile values to every function of the package, on one thread and on several. Each promise settles soon, with
// a result or an EdgeflipError that names the error, and a valid call afterwards gives the correct result.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { Worker } from 'node:worker_threads';
import { EdgeflipError, FlipSession, makeDelaunay } from 'edgeflip';
import * as files from 'edgeflip/files';
import * as points from 'edgeflip/points';
import fc from 'fast-check';
import { hostile, place, placing, takeAway } from './hostile.mjs';

/** The number of cases, and the seed that chooses them. */
const CASES = Number(process.env.EDGEFLIP_CASES ?? 10_000);
const seed = Number(process.env.EDGEFLIP_SEED ?? 24);

/** Milliseconds within which a promise has to settle. */
const PATIENCE = 5000;

const uncaught = [];
process
  .on('uncaughtException', (error) => uncaught.push(error))
  .on('unhandledRejection', (error) => uncaught.push(error));

const small = await files.generate('random 12');
const large = await files.generate('grid 183');
const expected = new Map();
for (const mesh of [small, large]) expected.set(mesh, await makeDelaunay(mesh, { backend: 'cpu', threads: 1 }));

const copy = ({ positions, indices, dimension }) => ({
  positions: positions.slice(),
  indices: indices.slice(),
  dimension,
});
const obj = await files.writeMesh(small, 'a.obj');
const original = () => ({ bytes: obj.slice(), name: 'a.obj', files: { 'b.bin': new Uint8Array(4) }, maxBytes: 1e6 });

const meshPaths = [[0], [0, 'positions'], [0, 'indices'], [0, 'dimension']];
const optionNames = [
  'backend',
  'maxNormalAngle',
  'maxDeviation',
  'maxIterations',
  'lockedEdges',
  'lockedTriangles',
  'groups',
  'reorient',
  'weld',
  'order',
  'threads',
  'device',
  'max_iterations',
];
const runNames = ['signal', 'onProgress', 'onIteration', 'unknown'];
const sessionPaths = [...meshPaths, [1], ...optionNames.map((name) => [1, name])];
const originalPaths = (at) => [
  at,
  [...at, 'bytes'],
  [...at, 'name'],
  [...at, 'files'],
  [...at, 'files', 'b.bin'],
  [...at, 'maxBytes'],
  [...at, 'coordinates'],
  [...at, 'ignoreAttributes'],
];
/** Options of a run, and options for work before the run. */
const plain = (threads) => ({ backend: 'cpu', threads });
const rich = (mesh) => ({
  backend: 'cpu',
  weld: [new Float32Array(mesh.positions.length)],
  reorient: true,
  lockedEdges: [...mesh.indices.slice(0, 2)],
});

/** Whole sessions, with all their methods. */
async function wholeSession(mesh, options) {
  const session = await FlipSession.create(mesh, options);
  try {
    await session.step();
    const { indices } = await session.run();
    await session.edgeStates();
    return indices;
  } finally {
    session.free();
  }
}

/** One call of a valid session. */
const onSession =
  (mesh, threads, ask) =>
  async (...args) => {
    const session = await FlipSession.create(mesh, plain(threads));
    try {
      return await ask(session, ...args);
    } finally {
      session.free();
    }
  };

const sessionEntries = (mesh, threads) => [
  {
    name: 'makeDelaunay',
    call: makeDelaunay,
    args: () => [copy(mesh), plain(threads)],
    paths: [...sessionPaths, ...runNames.map((name) => [1, name])],
  },
  { name: 'FlipSession.create', call: wholeSession, args: () => [copy(mesh), plain(threads)], paths: sessionPaths },
  {
    name: 'setPositions',
    call: onSession(mesh, threads, (session, moved) => session.setPositions(moved)),
    args: () => [mesh.positions.slice()],
    paths: [[0]],
  },
  {
    name: 'run',
    call: onSession(mesh, threads, (session, options) => session.run(options)),
    args: () => [{}],
    paths: [[0], [0, 'signal'], [0, 'onProgress'], [0, 'unknown']],
  },
];

const fileEntries = [
  {
    name: 'makeDelaunay with weld',
    call: makeDelaunay,
    args: () => [copy(small), rich(small)],
    paths: [...sessionPaths, [1, 'weld', 0]],
  },
  {
    name: 'makeDelaunay with the file',
    call: makeDelaunay,
    args: () => [copy(small), { weld: original() }],
    paths: originalPaths([1, 'weld']),
  },
  {
    name: 'readMesh',
    call: files.readMesh,
    args: () => [
      obj.slice(),
      'a.obj',
      { dimension: 2, coordinates: 64, maxBytes: 1e6, files: { 'b.bin': new Uint8Array(4) } },
    ],
    paths: [
      [0],
      [1],
      [2],
      [2, 'dimension'],
      [2, 'coordinates'],
      [2, 'maxBytes'],
      [2, 'files'],
      [2, 'files', 'b.bin'],
      [2, 'unknown'],
    ],
  },
  {
    name: 'writeMesh',
    call: files.writeMesh,
    args: () => [copy(small), 'b.obj', { original: original() }],
    paths: [...meshPaths, [1], [2], [2, 'unknown'], ...originalPaths([2, 'original'])],
  },
  { name: 'generate', call: files.generate, args: () => ['grid 4'], paths: [[0]] },
  { name: 'angles', call: files.angles, args: () => [copy(small), 12], paths: [...meshPaths, [1]] },
  { name: 'reorient', call: files.reorient, args: () => [copy(small)], paths: meshPaths },
  { name: 'measures', call: files.measures, args: () => [copy(small)], paths: meshPaths },
  { name: 'change', call: files.change, args: () => [copy(small), small.indices.slice()], paths: [...meshPaths, [1]] },
  {
    name: 'weld',
    call: files.weld,
    args: () => [copy(small), [new Uint8Array(small.positions.length)], true],
    paths: [...meshPaths, [1], [1, 0], [2]],
  },
  {
    name: 'split',
    call: async (indices) => (await files.weld(small)).split(indices),
    args: () => [small.indices.slice()],
    paths: [[0]],
  },
];

const inPlane = () => small.positions.slice();
const pairs = () => Array.from({ length: 40 }, (_, i) => [i % 7, (i * i) % 11]);
const accessors = () => ({ x: (_, i) => i % 7, y: (_, i) => (i * i) % 11 });
const pointEntries = [points.triangulate, points.triangulateSync].flatMap((work) => {
  const { name } = work;
  const call = async (...args) => work(...args);
  return [
    {
      name,
      call,
      args: () => [inPlane(), { stride: 3, offset: 1 }],
      paths: [[0], [1], [1, 'stride'], [1, 'offset'], [1, 'threads'], [1, 'x'], [1, 'unknown']],
    },
    { name, call, args: () => [pairs()], paths: [[0], [0, 3], [0, 3, 0], [0, 'length']] },
    { name, call, args: () => [pairs(), accessors()], paths: [[0], [0, 3], [1, 'x'], [1, 'y']] },
  ];
});

const arrays = ['triangles', 'twins', 'hull', 'duplicates'];
const voronoiEntries = [points.voronoi, points.voronoiSync].flatMap((work) => {
  const call = async (...args) => work(...args);
  const entry = (given, options, paths) => ({
    name: work.name,
    call,
    args: () => [given(), points.triangulateSync(given(), options()), { ...options(), bounds: [0, 0, 1, 1] }],
    paths: [
      [0],
      [1],
      ...arrays.flatMap((name) => [
        [1, name],
        [1, name, 0],
        [1, name, 'length'],
      ]),
      [2, 'bounds'],
      ...paths,
    ],
  });
  return [
    entry(inPlane, () => ({ stride: 3, offset: 1 }), [
      [2],
      [2, 'stride'],
      [2, 'offset'],
      [2, 'bounds', 3],
      [2, 'unknown'],
    ]),
    entry(pairs, accessors, [
      [0, 3],
      [2, 'x'],
      [2, 'y'],
    ]),
  ];
});

/** Calls a function, and returns how its promise settled. */
async function outcomeOf(call, args, isTaken) {
  const asked = (async () => call(...args))();
  if (isTaken) args.forEach((arg) => takeAway(arg));
  const done = new AbortController();
  const late = pause(PATIENCE, 'late', { signal: done.signal }).catch(() => undefined);
  const end = await Promise.race([
    asked.then(
      () => 'result',
      (thrown) => thrown,
    ),
    late,
  ]);
  done.abort();
  return end;
}

/** Passes hostile values at one or two locations in the arguments. */
function attack(entries, runs) {
  const place2 = ({ paths }) =>
    fc.array(fc.tuple(fc.constantFrom(...paths), hostile, placing), { minLength: 1, maxLength: 2 });
  const cases = fc.constantFrom(...entries).chain((entry) => fc.tuple(fc.constant(entry), place2(entry), fc.boolean()));
  const property = fc.asyncProperty(cases, async ([{ name, call, args: good, paths }, places, isTaken]) => {
    const args = good();
    for (const [path, make, how] of places) place(args, path, make, how);
    const end = await outcomeOf(call, args, isTaken);
    // Exceptions of callbacks pass through unchanged.
    const isOfCallback =
      end instanceof Error && places.some(([path]) => ['onProgress', 'onIteration', 'x', 'y'].includes(path.at(-1)));
    if (end === 'result' || (isOfCallback && !(end instanceof EdgeflipError))) return;
    assert.ok(end instanceof EdgeflipError, `${name}: ${String(end?.stack ?? end)}`);
    assert.notEqual(end.code, 'internal', `${name}: ${end.message}`);
    assert.equal(uncaught.length, 0, `${name}: ${String(uncaught[0]?.stack ?? uncaught[0])}`);
  });
  return fc.assert(property, { numRuns: runs, seed, endOnFailure: true, includeErrorInReport: true });
}

/** Checks that a valid call gives the correct result. */
async function isWell(mesh, threads) {
  const { indices, flips } = await makeDelaunay(mesh, plain(threads));
  assert.deepEqual(indices, expected.get(mesh).indices);
  assert.ok(flips > 0);
  assert.deepEqual(uncaught, []);
}

test('on one thread', async () => {
  await attack([...sessionEntries(small, 1), ...fileEntries], 0.8 * CASES);
  await isWell(small, 1);
});

test('on two threads', async () => {
  await attack(sessionEntries(large, 2), 0.1 * CASES);
  await isWell(large, 2);
});

test('points', async () => {
  await points.init();
  const expected = points.triangulateSync(inPlane());
  await attack([...pointEntries, ...voronoiEntries], 0.1 * CASES);
  assert.deepEqual(await points.triangulate(inPlane()), expected);
  assert.deepEqual(uncaught, []);
});

/** One or two numbers of a triangulation are replaced, so that the walks around the points could go anywhere. */
test('triangulations with wrong numbers', () => {
  const number = fc.oneof(fc.nat(60), fc.constantFrom(-1, 2 ** 31, 2 ** 32 - 1));
  const change = fc.tuple(fc.constantFrom(...arrays), fc.nat(), number);
  const coordinates = fc.array(fc.nat(9), { minLength: 0, maxLength: 40 }).map((list) => list.slice(list.length % 2));
  const bounds = [0.5, 0.5, 7, 8];
  const property = fc.property(coordinates, fc.array(change, { minLength: 1, maxLength: 2 }), (numbers, changes) => {
    const given = points.triangulateSync(numbers);
    const expected = points.voronoiSync(numbers, given, { bounds });
    for (const [name, at, value] of changes) given[name][at % given[name].length] = value;
    try {
      const { starts } = points.voronoiSync(numbers, given, { bounds });
      assert.equal(starts.length, expected.starts.length);
    } catch (error) {
      assert.ok(error instanceof EdgeflipError && error.code !== 'internal', String(error?.stack ?? error));
    }
    assert.deepEqual(points.voronoiSync(numbers, points.triangulateSync(numbers), { bounds }), expected);
  });
  fc.assert(property, { numRuns: 0.2 * CASES, seed });
});

/** In a worker that has loaded no module: none of the hostile values loads one. */
test('sources of the modules', async () => {
  const worker = new Worker(new URL('hostile-sources.mjs', import.meta.url), {
    workerData: { runs: 0.1 * CASES, seed, patience: PATIENCE },
  });
  const flips = await new Promise((resolve, reject) => worker.on('message', resolve).on('error', reject));
  assert.equal(flips, expected.get(small).flips);
  await worker.terminate();
});

/** Arrays that are larger than the memory are refused before they are copied. */
test('huge arrays', async () => {
  const words = new Uint32Array(3 * 2 ** 28);
  const numbers = new Float32Array(2 ** 30);
  for (const threads of [1, 2]) {
    const options = plain(threads);
    const refused = (mesh, more) =>
      assert.rejects(
        makeDelaunay(mesh, { ...options, ...more }),
        (error) => error instanceof EdgeflipError && error.code !== 'internal',
      );
    const start = performance.now();
    await refused({ ...large, positions: numbers });
    await refused({ ...large, indices: words });
    await refused({ ...large, positions: numbers, indices: words });
    await refused(large, { lockedEdges: words });
    assert.ok(performance.now() - start < 4 * PATIENCE);
  }
  await isWell(small, 1);
  await isWell(large, 2);
});
