// `edgeflip/worker` in Node: the same results and errors as `edgeflip`, while the calling thread stays free.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import * as here from 'edgeflip';
import { generate } from 'edgeflip/files';
import * as away from 'edgeflip/worker';

const cpu = { backend: 'cpu' };

test('the entry has the names of `edgeflip`, but for the function that does not wait', () => {
  const { makeDelaunaySync, ...others } = here;
  assert.equal(typeof makeDelaunaySync, 'function');
  assert.deepEqual(Object.keys(away).sort(), Object.keys(others).sort());
});

/** What a call returns or throws, without times. */
const outcome = async (call) => {
  try {
    const value = await call();
    if (!value?.timings) return value;
    const { timings, ...result } = value;
    assert.ok(timings.total >= 0);
    return result;
  } catch ({ name, code, message }) {
    return { name, code, message };
  }
};
const same = async (call) => {
  const there = await outcome(() => call(away));
  assert.deepEqual(there, await outcome(() => call(here)));
  return there;
};

test('results are those of `edgeflip`', async () => {
  for (const name of ['random 12', 'uvsphere 20', 'random 190']) {
    const mesh = await generate(name);
    const indices = Uint16Array.from(mesh.indices);
    const short = mesh.positions.length < 2 ** 16 ? { ...mesh, indices } : mesh;
    const options = [
      cpu,
      { ...cpu, order: 'any' },
      { ...cpu, weld: true, reorient: true },
      { ...cpu, weld: [Float32Array.from(mesh.positions)], maxIterations: 2 },
      { ...cpu, lockedTriangles: [0, 3], groups: Uint8Array.from({ length: indices.length / 3 }, (_, t) => t % 2) },
    ];
    for (const chosen of options) {
      const { flips } = await same(({ makeDelaunay }) => makeDelaunay(short, chosen));
      assert.ok(flips > 0, name);
    }
  }
});

test('a session has the same steps, states, edges and audit', async () => {
  const mesh = await generate('uvsphere 16');
  const moved = mesh.positions.map((x, i) => x * (1 + (i % 5) / 50));
  const steps = await same(async ({ FlipSession }) => {
    const session = await FlipSession.create(mesh, cpu);
    const found = [];
    for await (const { ms, ...iteration } of session) {
      found.push(iteration, await session.triangles(), await session.edgeStates(), await session.edges());
      assert.ok(ms >= 0);
    }
    await session.setPositions(moved);
    found.push(await session.step().then(({ flips }) => flips), await session.backend(), await session.verify());
    const { timings, ...result } = await session.run();
    found.push(result, await session.result().then(({ indices }) => indices));
    session.free();
    session.free();
    await session.step().catch(({ code, message }) => found.push(code, message));
    return found;
  });
  assert.ok(steps.length > 10);
});

test('errors are those of `edgeflip`', async () => {
  const mesh = await generate('random 6');
  const wrong = [
    [{ ...mesh, dimension: 4 }],
    [{ ...mesh, indices: [0, 1, 999] }],
    [{ ...mesh, positions: mesh.positions.map(() => NaN) }],
    [mesh, { maxNormalAngle: 400 }],
    [mesh, { ...cpu, groups: [1] }],
    [mesh, { maxNormalAngel: 4 }],
    [mesh, { onProgress: 4 }],
    [mesh, { ...cpu, weld: [new Float32Array(1)] }],
  ];
  for (const [given, options] of wrong) {
    const { name } = await same(({ makeDelaunay }) => makeDelaunay(given, options));
    assert.equal(name, 'EdgeflipError');
  }
  await assert.rejects(away.makeDelaunay(mesh, { device: {} }), { code: 'invalid-option', message: /^device is not/ });
  await assert.rejects(away.init({ base: 7 }), { name: 'EdgeflipError', code: 'invalid-input' });
  await assert.rejects(away.init(new URL('https://example.org')), {
    code: 'invalid-input',
    message: /^name the module/,
  });
  await assert.rejects(away.init({ core: 'relative.wasm' }), { code: 'invalid-input', message: /cannot be read/ });
  await assert.rejects(away.makeDelaunay(mesh, { ...cpu, signal: { aborted: false } }), { code: 'invalid-input' });
  assert.equal((await away.makeDelaunay(mesh, cpu)).status, 'done');
});

test('wrong options of an update are the same errors at once', async () => {
  const mesh = await generate('random 6');
  const { positions } = mesh;
  const { dimension } = mesh;
  const gaps = { ...mesh, positions: new Float64Array((positions.length / dimension) * 4), stride: 4 };
  for (let i = 0; i < gaps.positions.length; i++) {
    if (i % 4 < dimension) gaps.positions[i] = positions[dimension * Math.floor(i / 4) + (i % 4)];
  }
  for (const [given, options, code] of [
    [mesh, { positions, stride: 2 }, 'invalid-option'],
    [mesh, { offset: 1 }, 'invalid-option'],
    [mesh, { iterations: 65 }, 'invalid-option'],
    [mesh, { iteration: 1 }, 'invalid-option'],
    [mesh, { positions: 7 }, 'invalid-input'],
    [mesh, { positions: positions.subarray(2) }, 'position-count'],
    [mesh, { positions: [...positions, 1] }, 'position-count'],
    [gaps, { positions: gaps.positions.subarray(4) }, 'position-count'],
    [gaps, { positions: gaps.positions.subarray(0, -3) }, 'ragged-array'],
    [gaps, { positions: gaps.positions }, undefined],
  ]) {
    const thrown = [];
    for (const { FlipSession } of [here, away]) {
      const session = await FlipSession.create(given, { ...cpu, threads: 1 });
      thrown.push(await outcome(() => session.update(options)));
      assert.equal((await session.counters()).updates, Number(!code));
      session.free();
    }
    assert.equal(thrown[0]?.code, code);
    assert.deepEqual(thrown[0], thrown[1]);
  }
});

test('arrays may change or move after the call', async () => {
  const mesh = await generate('random 20');
  const { indices } = await here.makeDelaunay(mesh, cpu);
  const given = { ...mesh, positions: mesh.positions.slice(), indices: mesh.indices.slice() };
  const running = away.makeDelaunay(given, cpu);
  given.positions.fill(0);
  given.indices.fill(0);
  assert.deepEqual((await running).indices, indices);
});

test('the modules come from the sources of `init`', async () => {
  const file = new URL('../../dist/wasm/edgeflip_files_bg.wasm', import.meta.url);
  await assert.rejects(away.init({ webgl2: new Uint8Array(8) }), { code: 'load-failed' });
  await away.init({ base: new URL('.', file), files: new Response(readFileSync(file)) });
  const mesh = await generate('uvsphere 8');
  assert.equal((await away.makeDelaunay(mesh, { ...cpu, weld: true })).status, 'done');
});

test('a session that is freed during a run ends it', async () => {
  const session = await away.FlipSession.create(await generate('random 300'), { ...cpu, threads: 1 });
  const running = session.run();
  session.free();
  await assert.rejects(running, { code: 'freed' });
  await assert.rejects(session.triangles(), { code: 'freed' });
});

test('a run reports, stops by a signal, and passes on what a callback throws', async () => {
  const mesh = await generate('random 100');
  const iterations = [];
  const seen = [];
  const watched = { ...cpu, onIteration: ({ flips }) => iterations.push(flips), onProgress: (one) => seen.push(one) };
  const { flips, flipsPerIteration } = await away.makeDelaunay(mesh, watched);
  assert.deepEqual(iterations, [...flipsPerIteration]);
  assert.deepEqual(seen.at(-1), { iterations: iterations.length, flips });

  const stopped = await away.makeDelaunay(mesh, { ...cpu, signal: AbortSignal.abort() });
  assert.deepEqual([stopped.status, stopped.flips], ['stopped', 0]);
  const large = await generate('random 400');
  const session = await away.FlipSession.create(large, { ...cpu, threads: 1 });
  const controller = new AbortController();
  const early = await session.run({ signal: controller.signal, onProgress: () => controller.abort() });
  assert.equal(early.status, 'stopped');
  const error = new Error('mine');
  const fail = () => {
    throw error;
  };
  await assert.rejects(session.run({ onProgress: fail }), (thrown) => thrown === error);
  const { status, indices } = await session.run();
  assert.equal(status, 'done');
  assert.deepEqual(indices, (await here.makeDelaunay(large, cpu)).indices);
  session.free();
});

test('the calling thread stays free, and the worker keeps no process alive', () => {
  const program = `
    import { generate } from 'edgeflip/files';
    import { makeDelaunay } from 'edgeflip/worker';
    const mesh = await generate('random 600');
    let [longest, last] = [0, performance.now()];
    const timer = setInterval(() => {
      const now = performance.now();
      [longest, last] = [Math.max(longest, now - last), now];
    }, 1);
    // The best of three runs, because the machine may be busy.
    const shares = [];
    for (let i = 0; i < 4; i++) {
      [longest, last] = [0, performance.now()];
      const { timings } = await makeDelaunay({ ...mesh, dimension: 2 }, { backend: 'cpu', threads: 1 });
      if (i > 0) shares.push(longest / timings.total);
    }
    clearInterval(timer);
    console.log(Math.min(...shares) < 0.5 ? 'free' : \`blocked: \${shares}\`);`;
  // Workers of Node take over the options of the process, so the program is a file.
  const file = fileURLToPath(new URL('../../target/worker-test.mjs', import.meta.url));
  writeFileSync(file, program);
  const { stdout, stderr } = spawnSync(process.execPath, [file], { encoding: 'utf8', timeout: 60_000 });
  assert.equal(stdout, 'free\n', stderr);
});
