// Tests the npm package in Node, which has no WebGPU: the CPU engine, errors, abort.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { EDGE_STATES, EdgeflipError, FlipSession, makeDelaunay } from 'edgeflip';
import { generate } from 'edgeflip/files';

/** A thin diamond, split along its long diagonal. */
const diamond = () => ({
  positions: new Float32Array([-3, 0, 0, -1, 3, 0, 0, 1]),
  indices: new Uint32Array([0, 1, 2, 0, 2, 3]),
  dimension: 2,
});

/**
 * The paper's worst case (its figure 11) with n nodes: 1 2 3 2 1 flips for 8. Two strips between the points
 * q_j = (j, 0) and p_i = (m + i, m), where m = n / 2.
 */
function strips(n) {
  const m = n / 2;
  const positions = [];
  for (let j = 0; j < m; j++) positions.push(j, 0);
  for (let i = 0; i < m; i++) positions.push(m + i, m);
  const indices = [];
  for (let i = 0; i + 1 < m; i++) indices.push(0, m + i + 1, m + i);
  for (let j = 0; j + 1 < m; j++) indices.push(j, j + 1, 2 * m - 1);
  return { positions: new Float32Array(positions), indices: new Uint32Array(indices), dimension: 2 };
}

const refused = (code, pattern) => (error) => {
  assert.ok(error instanceof EdgeflipError && error instanceof Error, String(error));
  assert.equal(error.code, code, error.message);
  assert.match(error.message, pattern);
  return true;
};

test('auto says why it uses neither WebGPU nor WebGL2', async () => {
  const { backend, fallback } = await makeDelaunay(await generate('random 200'));
  assert.equal(backend, 'cpu');
  assert.match(
    fallback,
    /^backend webgpu is not available: there is no WebGPU here.*; webgl2 is left out: it takes longer than the cpu$/,
  );
});

test('makeDelaunay flips the long diagonal', async () => {
  const mesh = diamond();
  const result = await makeDelaunay(mesh);
  assert.deepEqual([...result.indices], [3, 1, 2, 0, 1, 3]);
  assert.equal(result.status, 'done');
  assert.equal(result.backend, 'cpu');
  assert.equal(result.fallback, 'the cpu finishes 2 triangles sooner');
  assert.equal(result.adapter, undefined);
  assert.deepEqual([result.iterations, result.flips, result.edges, result.boundaryEdges], [1, 1, 5, 4]);
  assert.deepEqual([...result.flipsPerIteration], [1]);
  assert.deepEqual(result.remaining, {});
  assert.ok(result.timings.total >= 0);
  assert.deepEqual(mesh, diamond());
});

test('strips flip as in the paper, whole and step by step', async () => {
  const mesh = strips(8);
  const seen = [];
  const whole = await makeDelaunay(mesh, { backend: 'cpu' });
  const watched = await makeDelaunay(mesh, { onIteration: ({ index, flips }) => seen.push([index, flips]) });
  assert.deepEqual([...whole.flipsPerIteration], [1, 2, 3, 2, 1]);
  assert.deepEqual(seen, [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 2],
    [4, 1],
  ]);
  assert.deepEqual(watched.indices, whole.indices);
});

test('16-bit indices, and doubles that are 32-bit floats, give the same result', async () => {
  const mesh = strips(12);
  const narrow = { ...mesh, positions: Float64Array.from(mesh.positions), indices: Uint16Array.from(mesh.indices) };
  assert.deepEqual((await makeDelaunay(narrow)).indices, Uint16Array.from((await makeDelaunay(mesh)).indices));
});

test('doubles are not rounded', async () => {
  // The diamond in metres of Web Mercator, a micrometre wide: as 32-bit floats, all its vertices are one point.
  const mesh = diamond();
  const positions = Float64Array.from(mesh.positions, (x) => 12e6 + x * 1e-6);
  const [doubles, rounded] = [positions, Float32Array.from(positions)].map((positions) => ({ ...mesh, positions }));
  assert.equal((await makeDelaunay(doubles)).flips, 1);
  assert.equal((await makeDelaunay(rounded)).flips, 0);

  const session = await FlipSession.create(rounded);
  assert.equal((await session.run()).flips, 0);
  const moving = session.setPositions(positions);
  positions.fill(0);
  await moving;
  assert.equal((await session.run()).flips, 1);
  assert.ok((await session.verify()).clean);
  await session.setPositions(rounded.positions);
  assert.equal((await session.run()).flips, 0);
  session.free();
});

test('a surface keeps its creases and counts them', async () => {
  // Two triangles at a right angle. Both have very small angles at their common edge.
  const mesh = {
    positions: new Float32Array([0, 0, 0, 4, 0, 0, 2, 0.5, 0, 2, 0, 0.5]),
    indices: new Uint32Array([0, 1, 2, 1, 0, 3]),
    dimension: 3,
  };
  assert.deepEqual((await makeDelaunay(mesh)).remaining, { angle: 1 });
});

test('locked edges never flip and are counted', async () => {
  const mesh = strips(8);
  const session = await FlipSession.create(mesh);
  const { v1, v2 } = await session.edges();
  session.free();
  const all = [...v1.keys()].flatMap((edge) => [v2[edge], v1[edge]]);
  for (const lockedEdges of [all, Uint32Array.from(all)]) {
    const { flips, status, remaining } = await makeDelaunay(mesh, { lockedEdges });
    assert.deepEqual([flips, status, remaining], [0, 'done', { locked: 1 }]);
  }
  assert.equal((await makeDelaunay(mesh, { lockedEdges: [] })).flips, 9);
});

test('locked triangles and the borders of groups stay', async () => {
  const mesh = strips(8);
  const numbers = Array.from({ length: mesh.indices.length / 3 }, (_, triangle) => triangle);
  for (const options of [{ lockedTriangles: numbers }, { groups: Uint32Array.from(numbers) }]) {
    const session = await FlipSession.create(mesh, options);
    const { flips, remaining } = await session.run();
    assert.deepEqual([flips, remaining], [0, { locked: 1 }]);
    assert.deepEqual((await session.verify()).remaining, { locked: 1 });
    session.free();
  }
  assert.equal((await makeDelaunay(mesh, { lockedTriangles: [], groups: numbers.map(() => 3) })).flips, 9);
});

test('`reorient` reverses triangles before the run', async () => {
  const mesh = strips(8);
  const indices = mesh.indices.map((_, i, all) => all[i % 6 < 3 ? i : i - (i % 3) + ((3 - (i % 3)) % 3)]);
  const turned = { ...mesh, positions: Float32Array.from(mesh.positions), indices };
  const plain = await makeDelaunay(turned);
  assert.ok(plain.inconsistentEdges > 0 && plain.turnedTriangles === 0);
  const session = await FlipSession.create(turned, { reorient: true });
  const { flips, inconsistentEdges, turnedTriangles, remaining } = await session.run();
  assert.deepEqual([flips, inconsistentEdges, remaining], [9, 0, {}]);
  assert.ok(turnedTriangles === 2 || turnedTriangles === 3, `${turnedTriangles}`);
  assert.ok((await session.verify()).clean);
  session.free();
});

test('errors have codes', async () => {
  const mesh = diamond();
  const bad = (change) => makeDelaunay({ ...mesh, ...change });
  const positions = Float32Array.from(mesh.positions);
  positions[5] = NaN;
  await assert.rejects(bad({ positions }), refused('non-finite', /vertex 2: coordinate y/));
  await assert.rejects(
    bad({ positions: Float64Array.of(0, 0, 1, 0, 0.1, NaN) }),
    refused('non-finite', /vertex 2: coordinate y/),
  );
  await assert.rejects(bad({ positions: [0, '0'] }), refused('invalid-input', /positions/));
  await assert.rejects(bad({ indices: [0, 1, -2] }), refused('invalid-input', /indices: .* number 2 is -2/));
  await assert.rejects(bad({ dimension: 4 }), refused('invalid-input', /dimension: 4 is not 2 or 3/));
  await assert.rejects(bad({ indices: Uint32Array.of(0, 1, 7) }), refused('index-out-of-range', /triangle 0.* 7 /));
  await assert.rejects(bad({ indices: Uint32Array.of(0, 1) }), refused('ragged-array', /indices has 2/));
  await assert.rejects(makeDelaunay(mesh, { backend: 'webgpu' }), refused('backend-unavailable', /backend webgpu/));
  await assert.rejects(makeDelaunay(mesh, { backend: 'gpu' }), refused('invalid-option', /backend/));
  await assert.rejects(makeDelaunay(mesh, { order: 1 }), refused('invalid-option', /order/));
  await assert.rejects(
    makeDelaunay(mesh, { device: {} }),
    refused('invalid-option', /device: an object is not a GPUDevice/),
  );
  await assert.rejects(makeDelaunay(mesh, { maxNormalAngle: 200 }), refused('invalid-option', /maxNormalAngle: 200/));
  await assert.rejects(
    makeDelaunay(mesh, { maxDeviation: -1 }),
    refused('invalid-option', /maxDeviation: -1 is not a distance/),
  );
  await assert.rejects(
    makeDelaunay(mesh, { maxDeviation: '1' }),
    refused('invalid-option', /maxDeviation: .* is not a number/),
  );
  await assert.rejects(makeDelaunay(mesh, { maxIterations: -1 }), refused('invalid-option', /maxIterations/));
  const locking = (lockedEdges) => makeDelaunay(mesh, { lockedEdges });
  await assert.rejects(
    locking([0, 1, 1, 3]),
    refused('invalid-option', /lockedEdges: .*no edge between vertices 1 and 3/),
  );
  await assert.rejects(locking([0, 1, 2]), refused('ragged-array', /lockedEdges has 3 numbers.*multiple of 2/));
  await assert.rejects(
    makeDelaunay(mesh, { lockedTriangles: [2] }),
    refused('invalid-option', /lockedTriangles: there is no triangle 2; the mesh has 2/),
  );
  await assert.rejects(makeDelaunay(mesh, { groups: [2] }), refused('invalid-option', /groups: it has 1 numbers/));
  await assert.rejects(makeDelaunay(mesh, { groups: 'all' }), refused('invalid-option', /groups: 'all' is neither/));
  for (const wrong of [null, 'edges', [0, -1], [0, 0.5], ['0', '1'], new Float32Array(2)]) {
    await assert.rejects(locking(wrong), refused('invalid-option', /lockedEdges: .* is neither/));
  }
});

test('a signal stops a run after a complete iteration', async () => {
  const session = await FlipSession.create(strips(40));
  const controller = new AbortController();
  const stopped = await session.run({
    signal: controller.signal,
    onProgress: ({ iterations }) => iterations === 3 && controller.abort(),
  });
  assert.deepEqual([stopped.status, stopped.iterations, stopped.flips], ['stopped', 3, 6]);
  assert.ok(stopped.remaining.stopped > 0);
  assert.ok((await session.verify()).clean);
  const done = await session.run();
  assert.equal(done.status, 'done');
  assert.deepEqual(done.indices, (await makeDelaunay(strips(40))).indices);
  session.free();
});

test('a run lets timers fire, so a timeout can stop it', async () => {
  const result = await makeDelaunay(strips(4000), { signal: AbortSignal.timeout(30) });
  assert.equal(result.status, 'stopped');
  const before = await makeDelaunay(strips(8), { signal: AbortSignal.abort() });
  assert.deepEqual([before.status, before.iterations], ['stopped', 0]);
});

test('maxIterations and Lawson’s order', async () => {
  const capped = await makeDelaunay(strips(8), { maxIterations: 2 });
  assert.deepEqual([capped.status, capped.flips], ['stopped', 3]);
  const any = await makeDelaunay(strips(8), { order: 'any' });
  assert.deepEqual([any.status, any.remaining, any.flips], ['done', {}, 9]);
});

test('a session iterates, returns its edges and audits them', async () => {
  const session = await FlipSession.create(strips(8));
  const flips = [];
  for await (const iteration of session) flips.push(iteration.flips);
  assert.deepEqual(flips, [1, 2, 3, 2, 1]);
  assert.equal(await session.step(), undefined);
  const [triangles, edges, audit] = await Promise.all([session.triangles(), session.edges(), session.verify()]);
  const none = new Uint32Array();
  const lists = { remainingEdges: {}, invertedTriangles: none, flatTriangles: none };
  assert.deepEqual(audit, { clean: true, violations: [], unlisted: 0, remaining: {}, ...lists });
  assert.equal(edges.v1.length, (await session.result()).edges);
  edges.ta.forEach((ta, edge) => {
    assert.equal(triangles[ta], edges.v1[edge]);
    if (edges.tb[edge] !== 0xffffffff) assert.equal(triangles[edges.tb[edge]], edges.v2[edge]);
  });
  assert.deepEqual([await session.backend(), await session.gpu()], ['cpu', undefined]);
  session.free();
});

test('an audit names the edges that remain', async () => {
  // A roof with the ridge 0-1, at which its two sides have very small angles. Next to it a thin diamond, split along
  // 4-6.
  const mesh = {
    positions: Float32Array.of(0, 0, 0, 4, 0, 0, 2, 0.5, 0, 2, 0, 0.5, 7, 0, 0, 10, -1, 0, 13, 0, 0, 10, 1, 0),
    indices: Uint32Array.of(0, 1, 2, 1, 0, 3, 4, 5, 6, 4, 6, 7),
    dimension: 3,
  };
  const session = await FlipSession.create(mesh);
  const before = await session.verify();
  assert.deepEqual(before.remaining, { angle: 1, stopped: 1 });
  assert.deepEqual(before.remainingEdges, { angle: Uint32Array.of(0, 1), stopped: Uint32Array.of(4, 6) });
  await session.run();
  assert.deepEqual((await session.verify()).remainingEdges, { angle: Uint32Array.of(0, 1) });
  session.free();

  const capped = await FlipSession.create(strips(40), { maxIterations: 1 });
  const { remaining } = await capped.run();
  const { stopped } = (await capped.verify()).remainingEdges;
  assert.equal(stopped.length, 2 * remaining.stopped);
  const [triangles, states] = [await capped.triangles(), await capped.edgeStates()];
  const waits = Array.from(triangles, (v, h) => [v, triangles[h % 3 === 2 ? h - 2 : h + 1]]).filter(
    ([u, v], h) => u < v && ['flips', 'waits'].includes(EDGE_STATES[states[h]]),
  );
  assert.deepEqual([...stopped], waits.sort(([a, b], [c, d]) => a - c || b - d).flat());
  capped.free();
});

test('the states of the edges predict every step', async () => {
  const session = await FlipSession.create(strips(8));
  const counts = [];
  for (;;) {
    const states = Array.from(await session.edgeStates(), (number) => EDGE_STATES[number]);
    const count = (state) => states.filter((name) => name === state).length;
    assert.deepEqual([states.length, count('boundary')], [18, 8]);
    const iteration = await session.step();
    assert.equal(count('flips') / 2, iteration?.flips ?? 0);
    assert.equal((count('flips') + count('waits')) / 2, iteration?.labelled ?? 0);
    if (!iteration) break;
    counts.push(count('flips') / 2);
  }
  assert.deepEqual(counts, [1, 2, 3, 2, 1]);
  session.free();
});

test('after the vertices move, the session continues like a new session', async () => {
  const mesh = strips(12);
  const session = await FlipSession.create(mesh);
  await session.step();
  // Stretched in the other direction, so that other edges are not Delaunay.
  const positions = mesh.positions.map((x, i) => (i % 2 ? 16 * x : x));
  const indices = await session.triangles();
  const moving = session.setPositions(positions);
  positions.fill(0);
  await moving;
  const before = await session.result();
  assert.deepEqual([before.iterations, before.flips, before.indices], [0, 0, indices]);
  const result = await session.run();
  const expected = await makeDelaunay({
    ...mesh,
    indices,
    positions: mesh.positions.map((x, i) => (i % 2 ? 16 * x : x)),
  });
  assert.ok(result.flips > 0);
  assert.deepEqual([result.indices, result.flipsPerIteration], [expected.indices, expected.flipsPerIteration]);
  await session.setPositions(Float64Array.from(mesh.positions));
  assert.deepEqual((await session.run()).remaining, {});
  assert.ok((await session.verify()).clean);
  await assert.rejects(session.setPositions(new Float32Array(3)), refused('position-count', /has 3 numbers/));
  await assert.rejects(session.setPositions(new Float32Array(24).fill(NaN)), refused('non-finite', /vertex 0/));
  await assert.rejects(session.setPositions([0, '0']), refused('invalid-input', /positions/));
  session.free();
  await assert.rejects(session.setPositions(mesh.positions), refused('freed', /freed/));
});

test('the caller may change the arguments after a call has returned', async () => {
  const large = await generate('grid 190');
  for (const [given, threads] of [
    [strips(12), 1],
    [large, 1],
    [large, 2],
  ]) {
    const options = { backend: 'cpu', threads };
    const { indices, flips } = await makeDelaunay(given, options);
    const mesh = { ...given, positions: given.positions.slice(), indices: given.indices.slice() };
    const asked = makeDelaunay(mesh, options);
    mesh.indices.fill(0);
    structuredClone(mesh.positions, { transfer: [mesh.positions.buffer] });
    const result = await asked;
    assert.deepEqual([result.indices, result.flips], [indices, flips]);
    await assert.rejects(
      makeDelaunay(mesh, options),
      refused('invalid-input', /^positions: the buffer was transferred/),
    );
  }
});

test('a refused session does not affect others', async () => {
  const session = await FlipSession.create(strips(12));
  const throwing = {
    get lockedEdges() {
      throw new Error('mine');
    },
  };
  await assert.rejects(
    FlipSession.create(strips(12), throwing),
    refused('invalid-input', /^the options cannot be read: mine$/),
  );
  await assert.rejects(makeDelaunay(null), refused('invalid-input', /^mesh: null is not an object$/));
  await assert.rejects(makeDelaunay(strips(12), null), refused('invalid-input', /^options: null is not an object$/));
  assert.equal((await session.run()).status, 'done');
  session.free();
});

test('a freed session refuses calls, including waiting calls', async () => {
  const session = await FlipSession.create(strips(40));
  const running = session.run();
  session.free();
  session.free();
  await assert.rejects(running, refused('freed', /freed/));
  await assert.rejects(session.triangles(), refused('freed', /freed/));
});

test('an exception of a callback passes through unchanged', async () => {
  const mine = new Error('mine');
  await assert.rejects(
    makeDelaunay(strips(8), {
      onProgress: () => {
        throw mine;
      },
    }),
    (error) => error === mine,
  );
});
