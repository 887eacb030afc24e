// A run on WebGPU in Chromium waits once, copies its arrays through buffers that are reused, and has the bits of the
// CPU. So do sessions that run at the same time, and runs whose caller changes its arrays at once. Uses the existing
// dist/.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { closeAll, openPage, serve, startChromium } from '../browsers.mjs';
import { enginePage } from '../engine-page.mjs';
import { full } from '../full.mjs';

const repository = fileURLToPath(new URL('../..', import.meta.url));

after(closeAll);

/** Runs in the page: counts the calls of WebGPU in each run, and collects wrong results. */
async function runs() {
  const { FlipSession, makeDelaunay } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  let asked = {};
  const count = (prototype, name, kind) => {
    const call = prototype[name];
    prototype[name] = function (...args) {
      const what = kind(...args);
      if (what) asked[what] = (asked[what] ?? 0) + 1;
      return call.apply(this, args);
    };
  };
  count(GPUBuffer.prototype, 'mapAsync', (mode) => (mode === GPUMapMode.READ ? 'waits' : 'kept'));
  count(GPUQueue.prototype, 'submit', () => 'submissions');
  // The parameters, the steps and the state of a run are smaller.
  const FEW = 32_768;
  count(GPUQueue.prototype, 'writeBuffer', (buffer, place, data, first, size = data.byteLength) =>
    size > FEW ? 'arrays' : undefined,
  );
  const [mesh, surface] = [await generate('random 150'), await generate('uvsphere 140')];
  const wanted = new Map();
  for (const one of [mesh, surface]) wanted.set(one, await makeDelaunay(one, { backend: 'cpu' }));
  const wrong = [];
  const check = (what, one, { indices, remaining, flips, backend }) => {
    const right = wanted.get(one);
    const isSame =
      backend === 'webgpu' && flips === right.flips && JSON.stringify(remaining) === JSON.stringify(right.remaining);
    if (!isSame || indices.some((vertex, i) => vertex !== right.indices[i])) wrong.push(what);
  };
  const told = [];
  for (const one of [mesh, mesh, mesh, surface, mesh, surface]) {
    asked = {};
    const { positions, indices, dimension } = one;
    const own = { positions: positions.slice(), indices: indices.slice(), dimension };
    const run = makeDelaunay(own, { backend: 'webgpu' });
    own.positions.fill(0);
    own.indices.fill(0);
    check(`run ${told.length}`, one, await run);
    told.push(asked);
  }
  asked = {};
  const together = await Promise.all(
    [mesh, surface, mesh, surface].map((one) => makeDelaunay(one, { backend: 'webgpu' })),
  );
  together.forEach((result, i) => check(`together ${i}`, [mesh, surface][i % 2], result));

  // A session that continues after its end, and after its vertices move.
  const session = await FlipSession.create(mesh, { backend: 'webgpu' });
  const cpu = await FlipSession.create(mesh, { backend: 'cpu' });
  for (let turn = 0; turn < 3; turn++) {
    const [result, right] = [await session.run(), await cpu.run()];
    wanted.set(session, right);
    check(`turn ${turn}`, session, result);
    check(`turn ${turn} again`, session, await session.result());
    result.indices.fill(0);
    if ((await session.triangles()).some((vertex, i) => vertex !== right.indices[i])) wrong.push(`triangles ${turn}`);
    const moved = mesh.positions.map((x, i) => x * (1 + (turn + 1) * (i % 2)));
    await session.setPositions(moved);
    await cpu.setPositions(moved);
  }
  return { told, wrong };
}

test('a run waits once, and copies through buffers that are reused', async () => {
  const { page } = await enginePage();
  const { told, wrong } = await page.evaluate(runs);
  console.log(JSON.stringify(told));
  assert.deepEqual(wrong, []);
  // The first run opens the device. The first run of each size creates the buffers for the next.
  for (const run of [2, 4, 5]) assert.deepEqual(told[run], { waits: 1, kept: 1, submissions: 3 }, `run ${run}`);
});

/** Runs in the page: the labels of the buffers that sessions make and destroy. */
async function kept() {
  const { FlipSession } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const mesh = await generate('random 31');
  const [{ createBuffer }, { destroy }] = [GPUDevice.prototype, GPUBuffer.prototype];
  let [made, destroyed] = [[], []];
  GPUDevice.prototype.createBuffer = function (descriptor) {
    made.push(descriptor.label);
    return createBuffer.call(this, descriptor);
  };
  GPUBuffer.prototype.destroy = function () {
    destroyed.push(this.label);
    destroy.call(this);
  };
  const told = {};
  const session = async (name, isShared) => {
    [made, destroyed] = [[], []];
    const session = await FlipSession.create(mesh, { backend: 'webgpu' });
    if (isShared) await session.gpu();
    await session.run();
    session.free();
    await new Promise((resolve) => setTimeout(resolve, 100));
    const ofMesh = (label) => ['positions', 'triangles', 'twins'].includes(label);
    told[name] = { made: made.filter(ofMesh).sort(), destroyed: destroyed.filter(ofMesh).sort() };
  };
  // Opens the device, and makes the buffers.
  await session('first');
  delete told.first;
  await session('second');
  await session('shared', true);
  await session('last');
  [made, destroyed] = [[], []];
  await new Promise((resolve) => setTimeout(resolve, 3000));
  told.later = ['positions', 'triangles', 'twins'].filter((label) => destroyed.includes(label));
  Object.assign(GPUDevice.prototype, { createBuffer });
  Object.assign(GPUBuffer.prototype, { destroy });
  return told;
}

test('a session leaves its buffers to the next one for a while, except those that the page has', async () => {
  // On another page, sessions that are not freed may still be there.
  const { page } = await openPage(await startChromium(), `${await serve(repository)}tests/engines.html`);
  assert.deepEqual(await page.evaluate(kept), {
    second: { made: [], destroyed: [] },
    shared: { made: [], destroyed: ['positions', 'triangles'] },
    last: { made: ['positions', 'triangles'], destroyed: [] },
    later: ['positions', 'triangles', 'twins'],
  });
});

/** Runs in the page: a mesh whose result is large. Returns the calls of workers, and whether the results are right. */
async function large() {
  const { makeDelaunay } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const mesh = await generate('regular 300');
  const right = (await makeDelaunay(mesh, { backend: 'cpu', threads: 1 })).indices;
  const { postMessage } = Worker.prototype;
  const told = [];
  Worker.prototype.postMessage = function (call, transfer) {
    told.push([call.method, ...call.args]);
    postMessage.call(this, call, transfer);
  };
  for (let run = 0; run < 2; run++) {
    const { indices } = await makeDelaunay(mesh, { backend: 'webgpu' });
    if (indices.length !== right.length || indices.some((vertex, i) => vertex !== right[i])) told.push(`wrong ${run}`);
  }
  Object.assign(Worker.prototype, { postMessage });
  return { told, indices: mesh.indices.length };
}

if (full) {
  test('a worker makes the memory for large results', async () => {
    const { page } = await enginePage();
    const { told, indices } = await page.evaluate(large);
    assert.deepEqual(told, [
      ['reserve', 1],
      ['reserve', indices],
    ]);
  });
}

/** Runs in the page: sends arrays that go in several pieces, and reads them back. Collects wrong results. */
async function pieces(specs) {
  const { FlipSession } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const wrong = [];
  for (const spec of specs) {
    const mesh = await generate(spec);
    const session = await FlipSession.create(mesh, { backend: 'webgpu' });
    const triangles = await session.triangles();
    if (triangles.length !== mesh.indices.length || triangles.some((vertex, i) => vertex !== mesh.indices[i]))
      wrong.push(spec);
    session.free();
  }
  return wrong;
}

test('arrays of several pieces come back as they were sent', async () => {
  const { page } = await enginePage();
  // 26 MB of triangles; a piece has 4 MB.
  const specs = full ? ['random 1050', 'random 1040', 'random 1060'] : ['random 1050'];
  assert.deepEqual(await page.evaluate(pieces, specs), []);
});

/** Runs in the page: begins sessions at the same time on an engine, and counts the programs that the page compiles. */
async function compiled({ backend, sessions }) {
  const { makeDelaunay } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  let programs = 0;
  for (const [prototype, name] of [
    [GPUDevice.prototype, 'createComputePipeline'],
    [WebGL2RenderingContext.prototype, 'linkProgram'],
  ]) {
    const call = prototype[name];
    prototype[name] = function (...args) {
      // The tail compiles behind the first runs, and may be late.
      programs += Number(args[0].label !== 'tail');
      return call.apply(this, args);
    };
  }
  const mesh = await generate('random 20');
  const results = await Promise.all(Array.from({ length: sessions }, () => makeDelaunay(mesh, { backend })));
  return { programs, flips: new Set(results.map(({ flips }) => flips)).size };
}

for (const backend of ['webgpu', 'webgl2']) {
  test(`sessions that begin at the same time compile ${backend} once`, async () => {
    const counts = [];
    for (const sessions of [1, 20]) {
      const { page } = await openPage(await startChromium(), `${await serve(repository)}tests/engines.html`);
      const { programs, flips } = await page.evaluate(compiled, { backend, sessions });
      assert.equal(flips, 1);
      counts.push(programs);
    }
    assert.ok(counts[0] > 0);
    assert.equal(counts[1], counts[0]);
  });
}
