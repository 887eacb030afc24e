// Tests the CPU engine of the npm package in Node on several threads: workers that share their memory.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { setTimeout } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import workers from 'node:worker_threads';
import { FlipSession, init, makeDelaunay } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { Digest } from '../parity/digest.js';

/** The started workers. Without them a test would not notice that a session runs on one thread. */
const started = [];
/** The script and the data of workers that run another script first. */
let first;
workers.Worker = class extends workers.Worker {
  constructor(url) {
    if (first) {
      const both = `${first.script}\nawait import(${JSON.stringify(String(url))});`;
      super(new URL(`data:text/javascript,${encodeURIComponent(both)}`), { workerData: first.data });
    } else {
      super(url);
    }
    started.push(this);
  }
};

const meshes = await Promise.all(['random 190', 'shear 190', 'uvsphere 190', 'shuffled random 260'].map(generate));

test('the module of the threads can be loaded from bytes', async () => {
  await init({ threads: readFileSync(new URL('../../dist/wasm/edgeflip_threads_bg.wasm', import.meta.url)) });
});

test('the result is the same for any number of threads, in both orders', async () => {
  for (const mesh of meshes) {
    for (const order of ['reproducible', 'any']) {
      const options = { backend: 'cpu', order, maxNormalAngle: 60 };
      const { timings, ...one } = await makeDelaunay(mesh, { ...options, threads: 1 });
      for (const threads of [2, 3]) {
        const { timings: _, ...several } = await makeDelaunay(mesh, { ...options, threads });
        assert.deepEqual(several, { ...one, threads });
      }
      assert.ok(one.flips > 0 && timings.total > 0);
    }
  }
  assert.equal(started.length, 2 + 3);
});

test('a large mesh in random order flips as tests/native/digests.rs says', async () => {
  const { indices } = await makeDelaunay(meshes[3], { backend: 'cpu', threads: 2 });
  assert.equal(new Digest(indices).toString(), 'b84ed3d4281f2ddc');
});

test('doubles, locked edges, a limit of iterations and moved vertices give the same as on one thread', async () => {
  const [{ positions, indices, dimension }] = meshes;
  const mesh = { positions: Float64Array.from(positions, (x) => x + 1e-9), indices, dimension };
  const moved = mesh.positions.map((x) => 3 * x);
  const [ends, progresses] = [[], []];
  for (const threads of [1, 2]) {
    const options = {
      backend: 'cpu',
      threads,
      maxIterations: 4,
      lockedEdges: indices.slice(0, 2),
      lockedTriangles: [7],
    };
    const session = await FlipSession.create(mesh, options);
    const seen = [];
    for await (const { index, labelled, flips, blocked } of session) seen.push({ index, labelled, flips, blocked });
    const audit = await session.verify();
    assert.ok(audit.clean);
    const states = await session.edgeStates();
    await session.setPositions(moved);
    const progress = [];
    const { timings, threads: ran, ...result } = await session.run({ onProgress: (step) => progress.push(step) });
    assert.equal(ran, threads);
    assert.deepEqual(progress.at(-1), { iterations: result.iterations, flips: result.flips });
    progresses.push(progress.map(({ iterations, flips }) => `${iterations}: ${flips}`));
    ends.push({ seen, audit, states, result, edges: await session.edges(), triangles: await session.triangles() });
    session.free();
    await assert.rejects(session.step(), { code: 'freed' });
  }
  assert.deepEqual(ends[1], ends[0]);
  // Several threads report only some of the steps. Each reported step is the same as on one thread.
  const [each, some] = progresses;
  assert.deepEqual(
    some,
    each.filter((step) => some.includes(step)),
  );
  assert.equal(ends[0].seen.length, 4);
});

test('auto says why it chose the CPU, also on several threads', async () => {
  const { timings, ...one } = await makeDelaunay(meshes[0], { threads: 1 });
  const { timings: _, ...two } = await makeDelaunay(meshes[0], { threads: 2 });
  assert.deepEqual(two, { ...one, threads: 2 });
  assert.match(one.fallback, /^backend webgpu is not available: .*; webgl2 is left out: it takes longer than the cpu$/);
});

test('errors are the same as on one thread', async () => {
  const [mesh] = meshes;
  const indices = mesh.indices.slice();
  indices[5] = 1e6;
  const positions = mesh.positions.slice();
  positions[3] = NaN;
  const wrong = [
    [{ ...mesh, indices }, {}, 'index-out-of-range'],
    [{ ...mesh, positions }, {}, 'non-finite'],
    [{ ...mesh, indices: indices.slice(1) }, {}, 'ragged-array'],
    [mesh, { maxNormalAngle: 200 }, 'invalid-option'],
    [mesh, { lockedEdges: [0, 3e5] }, 'invalid-option'],
    [mesh, { lockedEdges: () => [] }, 'invalid-option'],
    [mesh, { order: 'none' }, 'invalid-option'],
    [mesh, { threads: 0 }, 'invalid-option'],
    [mesh, { threads: 1.5 }, 'invalid-option'],
    [mesh, { threads: 'all' }, 'invalid-option'],
    [mesh, { threads: 1000 }, 'invalid-option'],
  ];
  for (const [mesh, options, code] of wrong) {
    const errors = [];
    for (const threads of [1, 2]) {
      await assert.rejects(
        makeDelaunay(mesh, { backend: 'cpu', threads, ...options }),
        (error) => errors.push(error.message) && error.code === code,
      );
    }
    assert.equal(errors[1], errors[0]);
  }
});

test('sessions share threads, and a small mesh uses none', async () => {
  const before = started.length;
  const results = await Promise.all(meshes.map((mesh) => makeDelaunay(mesh, { backend: 'cpu', threads: 2 })));
  for (const [i, { indices }] of results.entries()) {
    assert.deepEqual(indices, (await makeDelaunay(meshes[i], { backend: 'cpu', threads: 1 })).indices);
  }
  await makeDelaunay(await generate('random 30'), { backend: 'cpu', threads: 5 });
  assert.equal(started.length, before);
});

test('a thread that crashes ends its session, and new sessions work', async () => {
  const options = { backend: 'cpu', threads: 4 };
  const session = await FlipSession.create(meshes[0], options);
  const asked = session.run();
  started.at(-1).emit('error', new Error('no reason'));
  await assert.rejects(asked, { code: 'internal', message: /a thread has crashed: no reason/ });
  await assert.rejects(session.triangles(), { code: 'internal' });
  session.free();
  assert.equal((await makeDelaunay(meshes[0], options)).status, 'done');
});

test('a thread fetches the size of the memory that it receives, before it writes', { timeout: 60_000 }, async () => {
  // If another thread grows the memory meanwhile, V8 may keep the old size.
  const script = `
    import { workerData } from 'node:worker_threads';
    const known = new WeakSet();
    const { grow } = WebAssembly.Memory.prototype;
    WebAssembly.Memory.prototype.grow = function (pages) {
      known.add(this);
      return grow.call(this, pages);
    };
    WebAssembly.Memory = new Proxy(WebAssembly.Memory, {
      construct(Memory, args) {
        const memory = new Memory(...args);
        known.add(memory);
        return memory;
      },
    });
    WebAssembly.Instance = new Proxy(WebAssembly.Instance, {
      construct(Instance, [module, imports]) {
        const all = Object.values(imports).flatMap(Object.values);
        const [memory] = all.filter((value) => value instanceof WebAssembly.Memory);
        Atomics.add(workerData, known.has(memory) ? 1 : 0, 1);
        return new Instance(module, imports);
      },
    });
  `;
  const counts = new Int32Array(new SharedArrayBuffer(8));
  first = { script, data: counts };
  try {
    assert.equal((await makeDelaunay(meshes[0], { backend: 'cpu', threads: 6 })).status, 'done');
  } finally {
    first = undefined;
  }
  // The run may end before all threads have started.
  while (counts[0] + counts[1] < 6) await setTimeout(10);
  assert.deepEqual([...counts], [0, 6]);
});

test('a mesh that does not fit into the memory is refused, and other sessions continue', async () => {
  const options = { backend: 'cpu', threads: 2 };
  const other = await FlipSession.create(meshes[0], options);
  const before = started.length;
  // A grid of 7001 x 7001 points has as many numbers.
  const mesh = { positions: new Float32Array(2 * 7001 ** 2), indices: new Uint32Array(6 * 7000 ** 2), dimension: 2 };
  for (const threads of [1, 2]) {
    await assert.rejects(makeDelaunay(mesh, { backend: 'cpu', threads }), {
      code: 'too-large',
      message:
        /^up to \d+ bytes of memory are needed, and WebAssembly has 4294967296 for all meshes: free\(\) sessions that are done, or split the mesh$/,
    });
  }
  assert.equal((await other.run()).status, 'done');
  other.free();
  assert.equal(started.length, before);
});

test('the threads do not keep the process alive', () => {
  // Workers refuse the option --input-type.
  const program = `(async () => {
    const [{ makeDelaunay }, { generate }] = [await import('edgeflip'), await import('edgeflip/files')];
    const { status, threads } = await makeDelaunay(await generate('random 190'), { backend: 'cpu', threads: 2 });
    console.log(status, threads);
  })()`;
  const cwd = fileURLToPath(new URL('../..', import.meta.url));
  const { stdout, stderr, status } = spawnSync(process.execPath, ['-e', program], {
    cwd,
    encoding: 'utf8',
    timeout: 60_000,
  });
  assert.deepEqual([stdout, stderr, status], ['done 2\n', '', 0]);
});
