// Tests `triangulate` of `edgeflip/points` in Node on several threads: workers that share their memory. Every result is
// that of `triangulateSync`, which has one thread.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { setTimeout } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import workers from 'node:worker_threads';
import { EdgeflipError, init, triangulate, triangulateSync } from 'edgeflip/points';
import { randomOf } from './points.mjs';

/** The started workers. Without them a test would not notice that a call runs on one thread. */
const started = [];
/** Why no worker can be started. */
let refusal;
workers.Worker = class extends workers.Worker {
  constructor(...args) {
    if (refusal) throw refusal;
    super(...args);
    started.push(this);
  }
};

const moduleOf = (name) => readFileSync(new URL(`../../dist/wasm/${name}_bg.wasm`, import.meta.url));

/** The fewest points on several threads. */
const FEWEST = 131_072;
const random = randomOf(11);
const numbers = (count, number) => Float64Array.from({ length: 2 * count }, number);
const uniform = numbers(FEWEST, () => random(2 ** 32));
const sets = {
  uniform,
  singles: Float32Array.from(uniform),
  // Many are on one circle, and many are equal.
  'a lattice': numbers(FEWEST + 99, () => random(400)),
  'far groups': numbers(FEWEST, (_, i) => random(2 ** 20) + (i % 6 < 2 ? 2 ** 45 : 0)),
  'one line': numbers(FEWEST, (_, i) => i >> 1),
};

/** Compares a result with that on one thread. */
function check(found, expected, threads) {
  for (const name of ['triangles', 'twins', 'hull', 'duplicates']) {
    const [array, wanted] = [found[name], expected[name]];
    assert.ok(array instanceof Uint32Array && array.buffer instanceof ArrayBuffer, name);
    assert.equal(array.buffer.byteLength, array.byteLength, name);
    // assert.deepEqual takes long for large arrays.
    assert.equal(Buffer.compare(Buffer.from(array.buffer), Buffer.from(wanted.buffer)), 0, name);
  }
  assert.equal(found.hint, expected.hint);
  assert.equal(found.threads, threads);
}

await init();

test('the module of the threads can be loaded from bytes', async () => {
  await init({ threads: moduleOf('edgeflip_points_threads') });
});

test('the triangles are the same for any number of threads', async () => {
  for (const points of Object.values(sets)) {
    const one = triangulateSync(points);
    assert.equal(one.threads, 1);
    for (const threads of [1, 2, 3]) check(await triangulate(points, { threads }), one, threads);
  }
  assert.equal(started.length, 2 + 3);
  assert.match((await triangulate(sets['one line'], { threads: 2 })).hint, /^All points are on one line/);
});

test('fewer points have one thread, and so have all without memory to share', async () => {
  const before = started.length;
  check(await triangulate(uniform.subarray(2), { threads: 4 }), triangulateSync(uniform.subarray(2)), 1);
  assert.equal(started.length, before);
  // More than 16 threads have at least 8192 points each.
  const { threads } = await triangulate(uniform, { threads: 256 });
  assert.equal(threads, 16);
  assert.equal(started.length, before + 16);
});

test('each form of the same points gives the same triangles', async () => {
  const expected = triangulateSync(uniform);
  const pairs = Array.from({ length: FEWEST }, (_, i) => [uniform[2 * i], uniform[2 * i + 1]]);
  const spaced = new Float64Array(1 + 3 * FEWEST).fill(NaN);
  pairs.forEach((pair, i) => spaced.set(pair, 1 + 3 * i));
  const shared = new Float64Array(new SharedArrayBuffer(16 * FEWEST));
  shared.set(uniform);
  const forms = [
    [Uint32Array.from(uniform), {}],
    [shared, {}],
    [Array.from(uniform), {}],
    [spaced, { stride: 3, offset: 1 }],
    [pairs, {}],
    [pairs, { x: ([x]) => x, y: ([, y]) => y }],
    [uniform.filter((_, i) => i % 2 === 0), { x: (x) => x, y: (_, i) => uniform[2 * i + 1] }],
  ];
  for (const [points, options] of forms) check(await triangulate(points, { ...options, threads: 2 }), expected, 2);
});

test('the caller keeps its array, and may change it after the call', async () => {
  const points = uniform.slice();
  const asked = triangulate(points, { threads: 2 });
  assert.deepEqual([points[7], points.byteLength], [uniform[7], uniform.byteLength]);
  points.fill(NaN);
  check(await asked, triangulateSync(uniform), 2);
});

test('calls share threads, and each gets its own result', async () => {
  const before = started.length;
  const asked = Object.values(sets).map((points) => triangulate(points, { threads: 2 }));
  for (const [i, points] of Object.values(sets).entries()) check(await asked[i], triangulateSync(points), 2);
  assert.equal(started.length, before);
});

test('errors are the same as on one thread', async () => {
  const wrong = [
    [uniform.with(2 * 90_000 + 1, NaN), {}, 'non-finite'],
    [uniform.slice(1), {}, 'ragged-array'],
    [Array.from(uniform).with(7, '7'), {}, 'invalid-input'],
    [uniform, { stride: 1 }, 'invalid-input'],
  ];
  for (const [points, options, code] of wrong) {
    const errors = [];
    for (const threads of [1, 2]) {
      await assert.rejects(triangulate(points, { ...options, threads }), (error) => {
        errors.push(error.message);
        return error instanceof EdgeflipError && error.code === code;
      });
    }
    assert.equal(errors[1], errors[0]);
  }
});

test('a wrong number of threads is an error, for few points too; a call without a promise takes none', async () => {
  for (const points of [uniform, [0, 0, 1, 0, 0, 1]]) {
    for (const [threads, shown] of [
      [0, '0'],
      [257, '257'],
      [1.5, '1.5'],
      [NaN, 'NaN'],
      ['2', "'2'"],
      [null, 'null'],
    ]) {
      const message = `option threads: ${shown} is not a number of threads: give 1 to 256`;
      await assert.rejects(triangulate(points, { threads }), { code: 'invalid-option', message });
    }
    assert.throws(() => triangulateSync(points, { threads: 2 }), {
      code: 'invalid-option',
      message: 'threads is not an option; there are stride, offset, x, y, constraints, skipConstraints',
    });
    assert.equal(triangulateSync(points, { threads: undefined }).threads, 1);
  }
});

test('a thread that crashes ends its calls, and new calls work', async () => {
  await triangulate(uniform, { threads: 4 });
  const asked = Promise.allSettled(Array.from({ length: 20 }, () => triangulate(uniform, { threads: 4 })));
  await setTimeout(1);
  started.at(-1).emit('error', new Error('no reason'));
  const { reason } = (await asked).at(-1);
  assert.equal(reason.code, 'internal');
  assert.match(reason.message, /^a thread has crashed: no reason/);
  check(await triangulate(uniform, { threads: 4 }), triangulateSync(uniform), 4);
});

test('points that do not fit into the memory are refused, and the next call works', async () => {
  const before = started.length;
  const huge = new Float32Array(2 ** 27);
  const errors = [];
  for (const threads of [1, 2]) {
    await assert.rejects(triangulate(huge, { threads }), ({ code, message }) => {
      errors.push(message);
      return code === 'too-large';
    });
  }
  assert.equal(errors[1], errors[0]);
  check(await triangulate(uniform, { threads: 2 }), triangulateSync(uniform), 2);
  assert.equal(started.length, before);
});

test('without workers one thread gives the same, and the hint says why', async () => {
  refusal = new Error('not allowed');
  try {
    const { hint, ...found } = await triangulate(uniform, { threads: 6 });
    assert.equal(hint, 'The points were triangulated on one thread: the workers could not be started (not allowed).');
    check({ ...found, hint: undefined }, triangulateSync(uniform), 1);
    const { hint: both } = await triangulate(sets['one line'], { threads: 6 });
    assert.match(
      both,
      /^All points are on one line, so there is no triangle\. The points were triangulated on one thread/,
    );
  } finally {
    refusal = undefined;
  }
});

/** Runs a program in a process of its own, and returns what it prints. Workers refuse the option --input-type. */
function printed(program) {
  const cwd = fileURLToPath(new URL('../..', import.meta.url));
  const { stdout, stderr, status } = spawnSync(process.execPath, ['-e', `(async () => {${program}})()`], {
    cwd,
    encoding: 'utf8',
    timeout: 60_000,
  });
  assert.deepEqual([stderr, status], ['', 0]);
  return stdout;
}

const POINTS = `
  let number = 1;
  const points = Float64Array.from({ length: 2 * ${FEWEST} }, () => (number = (number * 48271) % 0x7fffffff));
`;

test('the threads do not keep the process alive, and load no other module', () => {
  const program = `
    const { triangulate, triangulateSync } = await import('edgeflip/points');
    ${POINTS}
    const { threads, triangles, hull } = await triangulate(points, { threads: 2 });
    console.log(threads, triangles.length / 3 + hull.length + 2 === points.length);
    try { triangulateSync(points); } catch ({ code }) { console.log(code); }
  `;
  assert.equal(printed(program), '2 true\nload-failed\n');
});

test('without the module of the threads one thread gives the same, and the hint says why', () => {
  const program = `
    const { init, triangulate } = await import('edgeflip/points');
    await init({ base: 'file:///nowhere', points: fs.readFileSync('dist/wasm/edgeflip_points_bg.wasm') });
    ${POINTS}
    const { threads, triangles, hint } = await triangulate(points, { threads: 2 });
    console.log(threads, triangles.length > 0, hint);
  `;
  const why =
    'the workers could not be started \\(edgeflip_points_threads_bg\\.wasm could not be loaded from file:///nowhere/';
  assert.match(printed(program), new RegExp(`^1 true The points were triangulated on one thread: ${why}`));
});
