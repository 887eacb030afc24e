// Tests `makeDelaunaySync`: without a wait, it gives the results and the errors of `makeDelaunay`.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { test } from 'node:test';
import { init, makeDelaunay, makeDelaunaySync } from 'edgeflip';
import { generate } from 'edgeflip/files';

const alone = { backend: 'cpu', threads: 1 };
const quad = {
  positions: new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]),
  indices: new Uint32Array([0, 1, 2, 0, 2, 3]),
  dimension: 2,
};

test('before `init`, the error says what to do', () => {
  const program = `import { makeDelaunaySync } from 'edgeflip';
    try { makeDelaunaySync({}); } catch ({ code, message }) { console.log(code, message); }`;
  const { stdout } = spawnSync(process.execPath, ['--input-type=module', '-e', program], { encoding: 'utf8' });
  assert.match(stdout, /^load-failed the engines are not loaded; call `await init\(\)` before makeDelaunaySync\n$/);
});

/** The outcome of a call, without times. */
const outcome = async (call) => {
  try {
    const { timings, ...result } = await call();
    assert.ok(timings.total >= 0);
    return result;
  } catch ({ name, code, message }) {
    return { name, code, message };
  }
};

/** Both functions give the same. */
async function same(mesh, options = {}) {
  const sync = await outcome(() => makeDelaunaySync(mesh, options));
  assert.deepEqual(sync, await outcome(() => makeDelaunay(mesh, options && { ...options, ...alone })));
  return sync;
}

test('results are those of `makeDelaunay`', async () => {
  await init();
  let flips = 0;
  for (const family of ['random 12', 'grid 9', 'uvsphere 14', 'random 40', 'uvsphere 40']) {
    const mesh = await generate(family);
    const { positions, indices, dimension } = mesh;
    const triangles = indices.length / 3;
    const options = [
      {},
      { maxIterations: 1 },
      { order: 'any' },
      { lockedTriangles: Uint8Array.of(0, 5), lockedEdges: Array.from(indices.subarray(0, 2)) },
      { groups: Uint8Array.from({ length: triangles }, (_, t) => t % 7) },
      ...(dimension === 3 ? [{ maxNormalAngle: 40, maxDeviation: 0.01 }] : []),
    ];
    for (const chosen of options) flips += (await same(mesh, chosen)).flips;
    await same({ ...mesh, positions: Float64Array.from(positions, (x) => x + 1e-12) });
    const turned = Uint16Array.from(indices);
    turned.subarray(0, 3).reverse();
    const { indices: result, inconsistentEdges } = await same({ ...mesh, indices: turned });
    assert.ok(result instanceof Uint16Array);
    assert.ok(inconsistentEdges > 0);
  }
  assert.ok(flips > 1000, `${flips} flips`);
  const { hint } = await same({ ...quad, indices: [0, 1, 2, 3, 4, 5], positions: new Int8Array(12) });
  assert.match(hint, /^No two triangles share an edge/);
});

test('errors are those of `makeDelaunay`, and the next call works', async () => {
  await init();
  const wrong = [
    [undefined],
    [{ ...quad, dimension: '2' }],
    [{ ...quad, indices: [0, 1, 9] }],
    [{ ...quad, indices: [0, 1] }],
    [{ ...quad, positions: [0, 1, 2] }],
    [{ ...quad, positions: Float64Array.of(0, 0, 1, NaN, 2, 0, 3, 3) }],
    [quad, null],
    [quad, { maxNormalAngle: 'wide' }],
    [quad, { maxNormalAngle: -1 }],
    [quad, { lockedEdges: [0, 1, 0] }],
    [quad, { lockedEdges: [1, 3] }],
    [quad, { groups: [1] }],
    [quad, { maxNormalAngel: 3 }],
  ];
  for (const [mesh, options] of wrong) {
    const { name, code } = await same(mesh, options);
    assert.equal(name, 'EdgeflipError', JSON.stringify(options));
    assert.notEqual(code, 'internal');
    assert.equal((await same(quad)).flips, 1);
  }
  for (const name of ['backend', 'device', 'threads', 'weld', 'reorient', 'signal', 'onProgress']) {
    assert.throws(() => makeDelaunaySync(quad, { [name]: 1 }), { code: 'invalid-option', message: new RegExp(name) });
  }
});

test('ten thousand calls leave nothing behind, and a call is faster than one that waits', async (t) => {
  await init();
  /** The least microseconds of a call. */
  const least = async (batches, batch) => {
    let least = Infinity;
    for (let i = 0; i < batches; i++) {
      const start = performance.now();
      await batch();
      least = Math.min(least, (performance.now() - start) * 10);
    }
    return least;
  };
  const sync = () => {
    for (let i = 0; i < 100; i++) assert.equal(makeDelaunaySync(quad).flips, 1);
  };
  await least(50, sync);
  const { memory } = await (await import('../../dist/wasm/edgeflip.js')).default();
  const bytes = memory.buffer.byteLength;
  const here = await least(100, sync);
  assert.equal(memory.buffer.byteLength, bytes);
  const waiting = await least(50, async () => {
    for (let i = 0; i < 100; i++) await makeDelaunay(quad, alone);
  });
  t.diagnostic(`${here.toFixed(1)} µs, and ${waiting.toFixed(1)} µs with waits`);
  assert.ok(here < waiting);
});
