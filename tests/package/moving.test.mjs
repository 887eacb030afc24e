// Tests updates, for meshes that move, on the CPU engine in Node.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Worker } from 'node:worker_threads';
import * as here from 'edgeflip';
import { generate } from 'edgeflip/files';
import * as away from 'edgeflip/worker';

const { FlipSession } = here;

/** The positions of a mesh in the plane, sheared along waves. */
function sheared({ positions }, time) {
  const moved = positions.slice();
  for (let i = 0; i < moved.length; i += 2) {
    moved[i] += 2 * Math.sin(0.4 * positions[i + 1] + time);
    moved[i + 1] += 2 * Math.sin(0.4 * positions[i] - time);
  }
  return moved;
}

const mesh = await generate('random 30');
const onCpu = { backend: 'cpu' };

test('an update flips what it has a budget for, and the next one goes on', async () => {
  const session = await FlipSession.create(mesh, onCpu);
  assert.deepEqual(await session.counters(), {
    updates: 0,
    flips: 0,
    remaining: (await session.counters()).remaining,
    inverted: 0,
    flat: 0,
    undecided: 0,
    nonFinite: 0,
    tooWide: 0,
  });
  let before = (await session.counters()).remaining.stopped;
  for (let updates = 1; before > 0; updates++) {
    session.update({ iterations: 1 });
    const counters = await session.counters();
    assert.equal(counters.updates, updates);
    assert.ok(counters.flips > 0);
    before = counters.remaining.stopped ?? 0;
  }
  const { clean, remaining } = await session.verify();
  assert.ok(clean);
  assert.deepEqual(remaining, {});
});

test('the mesh is Delaunay again in every frame', async () => {
  for (const order of ['reproducible', 'any']) {
    const session = await FlipSession.create(mesh, { ...onCpu, order });
    session.update({ iterations: 64 });
    const first = (await session.counters()).flips;
    for (let frame = 0; frame < 20; frame++) {
      session.update({ positions: sheared(mesh, 0.1 * frame), iterations: 64 });
      const { remaining, inverted, flat, updates } = await session.counters();
      assert.deepEqual([remaining, inverted, flat, updates], [{}, 0, 0, frame + 2]);
    }
    assert.ok((await session.counters()).flips > 2 * first);
    const positions = sheared(mesh, 1.9);
    const fresh = await FlipSession.create({ ...mesh, positions, indices: await session.triangles() }, onCpu);
    assert.equal((await fresh.run()).flips, 0);
    // A run ends the motion: it begins where the updates ended.
    const { flips, iterations, status } = await session.run();
    assert.deepEqual([flips, iterations, status], [0, 0, 'done']);
    assert.equal((await session.counters()).updates, 0);
  }
});

test('a folded sheet is mended where flips can mend it', async () => {
  const square = { positions: new Float32Array([0, 0, 4, 0, 4, 4, 0, 4, 2, 2]), dimension: 2 };
  square.indices = new Uint32Array([0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]);
  const session = await FlipSession.create(square, onCpu);
  // The middle vertex comes to an edge of the boundary, crosses it, then comes back.
  for (const [x, inverted, flat] of [
    [2, 0, 0],
    [0, 0, 1],
    [-1, 1, 0],
    [1, 0, 0],
  ]) {
    const positions = square.positions.slice();
    positions[8] = x;
    session.update({ positions });
    const counters = await session.counters();
    assert.deepEqual([counters.inverted, counters.flat, counters.undecided], [inverted, flat, 0]);
  }
});

test('a number that is not finite freezes its triangles for one frame', async () => {
  const session = await FlipSession.create(mesh, onCpu);
  const positions = sheared(mesh, 0);
  positions[200] = NaN;
  session.update({ positions, iterations: 64 });
  const { nonFinite, undecided, inverted, flat, remaining } = await session.counters();
  assert.ok(nonFinite > 4 && undecided > 2 && inverted + flat === 0 && !remaining.stopped);
  await assert.rejects(session.run(), { code: 'non-finite' });
  session.update({ positions: sheared(mesh, 0), iterations: 64 });
  const { nonFinite: left, undecided: open } = await session.counters();
  assert.deepEqual([left, open], [0, 0]);
  assert.equal((await session.run()).flips, 0);
});

test('the changes name the update of each triangle', async () => {
  const session = await FlipSession.create(mesh, { ...onCpu, trackChanges: true });
  session.update({ iterations: 1 });
  session.update({ iterations: 1 });
  const changes = await session.changes();
  assert.deepEqual([...new Set(changes)].sort(), [0, 1, 2]);
  assert.equal(changes.length, mesh.indices.length / 3);
  const { flips } = await session.counters();
  assert.ok(changes.filter((update) => update > 0).length <= 2 * flips);
  await session.run();
  assert.deepEqual([...new Set(await session.changes())], [0]);
  assert.deepEqual(await (await FlipSession.create(mesh, onCpu)).changes(), new Uint32Array());
  await assert.rejects(FlipSession.create(mesh, { ...onCpu, trackChanges: true, order: 'any' }), {
    code: 'invalid-option',
    message: /^option trackChanges: the order `any` has no changes to track$/,
  });
});

test('wrong options of an update are refused and change nothing', async () => {
  const session = await FlipSession.create(mesh, onCpu);
  const before = await session.triangles();
  const { positions } = mesh;
  for (const [options, code, message] of [
    [{ iterations: 65 }, 'invalid-option', /option iterations: 65 is not a whole number from 0 to 64/],
    [{ iterations: -1 }, 'invalid-option', /option iterations: -1 is not a whole number from 0 to 64/],
    [{ iteration: 1 }, 'invalid-option', /did you mean iterations\?/],
    [{ positions: positions.subarray(2) }, 'position-count', /1798/],
    [{ positions, stride: 2 }, 'invalid-option', /stride is not an option; there are positions, iterations/],
    [{ positions: { 0: 1 } }, 'invalid-input', /neither a typed array nor an array of numbers/],
    [{ positions: [1, 2] }, 'position-count', /has 2 numbers/],
    [{ buffer: {} }, 'invalid-option', /option buffer: an object is not a GPUBuffer of this page/],
    [{ buffer: {}, positions }, 'invalid-option', /give only one of them/],
    [{ buffer: {}, stride: 1 }, 'invalid-option', /option stride: 1 is not a whole number of at least 2/],
    [{ buffer: {}, offset: 0.5 }, 'invalid-option', /option offset: 0.5/],
    [null, 'invalid-input', /options: null is not an object/],
  ]) {
    assert.throws(() => session.update(options), { name: 'EdgeflipError', code, message });
  }
  assert.equal((await session.counters()).updates, 0);
  assert.deepEqual(await session.triangles(), before);
  session.free();
  for (let turn = 0; turn < 3; turn++) {
    assert.throws(() => session.update(), { name: 'EdgeflipError', code: 'freed' });
    await assert.rejects(session.counters(), { code: 'freed' });
    // By now, the module has freed the session.
    await new Promise((resolve) => setTimeout(resolve));
  }
});

/** Sends messages to workers without the first vertex. */
function losing(send) {
  const { postMessage } = Worker.prototype;
  Worker.prototype.postMessage = function (call, transfer) {
    const [update] = call.args[2];
    update.positions = update.positions.subarray(2);
    return postMessage.call(this, call, transfer);
  };
  try {
    send();
  } finally {
    Worker.prototype.postMessage = postMessage;
  }
}

test('the error of an update goes to the next update or to `counters`, and to no other call', async () => {
  for (const entry of [here, away]) {
    const session = await entry.FlipSession.create(mesh, onCpu);
    /** An update that waits for an earlier call, and then fails; the one in the worker loses a vertex on its way. */
    const fail = async () => {
      const call = session.triangles();
      if (entry === here) session.update({ positions: mesh.positions.subarray(2) });
      else losing(() => session.update({ positions: mesh.positions }));
      await call;
      await session.backend();
    };
    await fail();
    assert.ok((await session.edges()).v1.length > 0);
    assert.equal((await session.run()).status, 'done');
    assert.ok((await session.verify()).clean);
    await session.setPositions(mesh.positions);
    await assert.rejects(session.counters(), { code: 'position-count' });
    assert.equal((await session.counters()).updates, 0);
    await fail();
    assert.throws(() => session.update(), { code: 'position-count' });
    session.update();
    assert.equal((await session.counters()).updates, 1);
    session.free();
  }
});

test('an update waits for an earlier call, and has copied its positions', async () => {
  const session = await FlipSession.create(mesh, onCpu);
  const [positions, run] = [sheared(mesh, 1), session.run()];
  session.update({ positions, iterations: 64 });
  positions.fill(NaN);
  const counters = await session.counters();
  assert.deepEqual([counters.updates, counters.nonFinite, counters.remaining], [1, 0, {}]);
  assert.equal((await run).status, 'done');
});

test('several threads and a worker give the same', async () => {
  const large = await generate('random 190');
  const one = await FlipSession.create(large, { ...onCpu, threads: 1 });
  const two = await FlipSession.create(large, { ...onCpu, threads: 2 });
  const worker = await away.FlipSession.create(large, { ...onCpu, threads: 1 });
  for (let frame = 0; frame < 4; frame++) {
    const positions = sheared(large, 0.2 * frame);
    const counted = [];
    for (const session of [one, two, worker]) {
      session.update({ positions, iterations: 2 });
      counted.push([await session.counters(), await session.triangles()]);
    }
    assert.deepEqual(counted[1], counted[0]);
    assert.deepEqual(counted[2], counted[0]);
  }
});

test('updates leave nothing behind', async () => {
  const session = await FlipSession.create(mesh, onCpu);
  const { memory } = await (await import('../../dist/wasm/edgeflip.js')).default();
  const frames = (count) => {
    for (let frame = 0; frame < count; frame++) session.update({ positions: sheared(mesh, 0.1 * frame) });
    return memory.buffer.byteLength;
  };
  const before = frames(10);
  assert.equal(frames(Number(process.env.EDGEFLIP_UPDATES ?? 1000)), before);
});
