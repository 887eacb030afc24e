// Tests updates on WebGPU in Chromium: the same triangles as the CPU in every frame, without a call that waits.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { closeAll, openPage, serve, startChromium } from '../browsers.mjs';
import { repository } from './project.mjs';

after(closeAll);
const updates = Number(process.env.EDGEFLIP_UPDATES ?? 300);

const chromium = await startChromium();
const { page, problems } = await openPage(chromium, `${await serve(repository)}package.json`);
await page.evaluate(prepare);
// The document has no icon.
problems.length = 0;

/** Runs in the page: defines what the tests call. */
async function prepare() {
  const { FlipSession } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  Object.assign(window, { FlipSession, generate, maps: 0, live: 0 });
  const { mapAsync } = GPUBuffer.prototype;
  GPUBuffer.prototype.mapAsync = function (...args) {
    window.maps++;
    return mapAsync.apply(this, args);
  };
  const { createBuffer } = GPUDevice.prototype;
  GPUDevice.prototype.createBuffer = function (descriptor) {
    const buffer = createBuffer.call(this, descriptor);
    window.live += buffer.size;
    const { destroy } = buffer;
    buffer.destroy = () => {
      window.live -= buffer.size;
      destroy.call(buffer);
    };
    return buffer;
  };
  /** The positions of a mesh along waves. */
  window.moved = ({ positions, dimension }, time) => {
    const moved = positions.slice();
    for (let i = 0; i < moved.length; i += dimension) {
      if (dimension === 2) {
        moved[i] += 3 * Math.sin(0.5 * positions[i + 1] + time);
        moved[i + 1] += 3 * Math.sin(0.5 * positions[i] - time);
      } else {
        const factor = 1 + 0.2 * Math.sin(5 * positions[i + 2] + time);
        moved[i] *= factor;
        moved[i + 1] /= factor;
      }
    }
    return moved;
  };
  /** Two sessions on the mesh: on WebGPU, and on the CPU. */
  window.pair = (mesh, options) =>
    Promise.all(['webgpu', 'cpu'].map((backend) => FlipSession.create(mesh, { ...options, backend })));
  /** Whether two sessions have the same triangles and counts. */
  window.equal = async (sessions) => {
    const [found, expected] = await Promise.all(
      sessions.map(async (session) =>
        JSON.stringify([await session.counters(), [...(await session.triangles())], [...(await session.changes())]]),
      ),
    );
    if (found !== expected) throw new Error(`${found.slice(0, 300)}\nis not\n${expected.slice(0, 300)}`);
    return (await sessions[0].counters()).flips;
  };
}

test('arrays: WebGPU gives what the CPU gives, after every update', async () => {
  const flips = await page.evaluate(async () => {
    let flips = 0;
    for (const spec of ['random 20', 'uvsphere 14', 'regular 12']) {
      const mesh = await generate(spec);
      const sessions = await pair(mesh, { maxNormalAngle: 40, trackChanges: true });
      for (let frame = 0; frame < 12; frame++) {
        const positions = moved(mesh, 0.3 * frame);
        if (frame === 5) positions[30] = NaN;
        for (const session of sessions) session.update({ positions, iterations: frame % 4 });
        flips += await equal(sessions);
      }
      // So they do after new positions, at once.
      for (const session of sessions) {
        await session.setPositions(moved(mesh, 4));
        session.update({ positions: moved(mesh, 4.5), iterations: 3 });
      }
      flips += await equal(sessions);
      // After a run, which ends the motion, updates begin again.
      for (const session of sessions) {
        await session.run();
        session.update({ positions: moved(mesh, 5), iterations: 2 });
      }
      flips += await equal(sessions);
      for (const session of sessions) session.free();
      // Counts disturb no run, and know positions that are new.
      const others = await pair(mesh, { maxNormalAngle: 40 });
      for (const session of others) {
        await session.step();
        await session.counters();
        await session.step();
        await session.run();
      }
      flips += await equal(others);
      for (const session of others) {
        await session.setPositions(mesh.positions.map((x, i) => (i % mesh.dimension ? x : -x)));
        await session.counters();
        await session.run();
      }
      await equal(others);
      for (const session of others) session.free();
    }
    return flips;
  });
  assert.ok(flips > 1000, `${flips} flips`);
});

test('buffers: without gaps, with an offset and a stride, and written by the page', async () => {
  const results = await page.evaluate(async () => {
    const results = [];
    for (const spec of ['random 20', 'uvsphere 14']) {
      const mesh = await generate(spec);
      const { dimension } = mesh;
      const sessions = await pair(mesh, {});
      const { device, positions } = await sessions[0].gpu();
      const usage = GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC | GPUBufferUsage.COPY_DST;
      for (const [offset, stride, time] of [
        [0, dimension, 1],
        [5, dimension, 2],
        [0, 4, 3],
        [7, 9, 4],
      ]) {
        const numbers = moved(mesh, time);
        const spread = new Float32Array(offset + (numbers.length / dimension) * stride).fill(NaN);
        for (let i = 0; i < numbers.length; i++) {
          spread[offset + Math.floor(i / dimension) * stride + (i % dimension)] = numbers[i];
        }
        const buffer = device.createBuffer({ size: spread.byteLength, usage });
        device.queue.writeBuffer(buffer, 0, spread);
        sessions[0].update({ buffer, offset, stride });
        sessions[1].update({ positions: numbers });
        results.push(await equal(sessions));
        buffer.destroy();
      }
      const numbers = moved(mesh, 6);
      device.queue.writeBuffer(positions, 0, numbers);
      sessions[0].update();
      sessions[1].update({ positions: numbers });
      results.push(await equal(sessions));
      const short = device.createBuffer({ size: 64, usage });
      for (const [session, options] of [
        [sessions[0], { buffer: short }],
        [sessions[1], { buffer: positions }],
        [sessions[0], { positions: new Float64Array(numbers.length) }],
      ]) {
        try {
          session.update(options);
          results.push('no error');
        } catch ({ code, message }) {
          results.push(`${code}: ${message}`);
        }
      }
      results.push(await equal(sessions));
      for (const session of sessions) session.free();
    }
    return results;
  });
  for (const result of [results.slice(0, 9), results.slice(9)]) {
    assert.ok([...result.slice(0, 5), result[8]].every((flips) => flips > 0));
    assert.match(result[5], /^position-count: option buffer: it has 64 bytes; \d+ vertices end at byte \d+$/);
    assert.match(result[6], /^invalid-option: option buffer: the session is on cpu/);
    assert.match(result[7], /^backend-limit: .*32-bit floats/);
  }
});

test('a mesh in buffers of the device', async () => {
  const results = await page.evaluate(async () => {
    const mesh = await generate('random 12');
    const device = await (await navigator.gpu.requestAdapter()).requestDevice();
    const buffer = (array, usage) => {
      const buffer = device.createBuffer({ size: array.byteLength + 64, usage: usage | GPUBufferUsage.COPY_DST });
      device.queue.writeBuffer(buffer, 0, array);
      return buffer;
    };
    const spread = new Float32Array(3 + (mesh.positions.length / 2) * 4);
    for (let i = 0; i < mesh.positions.length; i++) {
      spread[3 + Math.floor(i / 2) * 4 + (i % 2)] = mesh.positions[i];
    }
    const positions = buffer(spread, GPUBufferUsage.COPY_SRC | GPUBufferUsage.STORAGE);
    const indices = buffer(mesh.indices, GPUBufferUsage.COPY_SRC);
    const [vertices, triangles] = [mesh.positions.length / 2, mesh.indices.length / 3];
    const given = { positions, indices, dimension: 2, stride: 4, offset: 3, vertices, triangles };
    const options = { backend: 'webgpu', device };
    const session = await FlipSession.fromBuffers(given, options);
    const cpu = await FlipSession.create(mesh, { backend: 'cpu' });
    session.update({ buffer: positions, stride: 4, offset: 3 });
    cpu.update();
    const results = [await equal([session, cpu])];
    session.free();
    const fails = async (mesh, options) => {
      try {
        await FlipSession.fromBuffers(mesh, options);
        return 'no error';
      } catch ({ code, message }) {
        return `${code}: ${message}`;
      }
    };
    results.push(
      await fails(given, {}),
      await fails({ ...given, positions: mesh.positions }, options),
      await fails({ ...given, vertices: vertices + 10 }, options),
      await fails({ ...given, triangles: -1 }, options),
      await fails({ ...given, indices: buffer(mesh.indices, GPUBufferUsage.INDEX) }, options),
      await fails({ ...given, triangles: undefined, indices: positions }, options),
    );
    device.destroy();
    return results;
  });
  assert.ok(results[0] > 10);
  for (const [i, pattern] of [
    /^invalid-option: option device: give the device of the buffers$/,
    /^invalid-input: positions: an object is not a GPUBuffer of this page$/,
    /^invalid-input: positions: the buffer has \d+ bytes, and the mesh needs \d+$/,
    /^invalid-input: indices: -1 is not a number of them$/,
    /^invalid-input: the buffers of the mesh cannot be read: /,
    /^(index-out-of-range|ragged-array): /,
  ].entries()) {
    assert.match(results[i + 1], pattern);
  }
});

test('frames do not wait, and leave nothing behind', async () => {
  const found = await page.evaluate(async (updates) => {
    const mesh = await generate('random 12');
    const session = await FlipSession.create(mesh, { backend: 'webgpu' });
    const { device } = await session.gpu();
    const all = async (count) => {
      for (let frame = 0; frame < count; frame++) {
        session.update({ positions: moved(mesh, 0.1 * frame) });
        // A page waits for the next frame.
        if (frame % 60 === 59) await device.queue.onSubmittedWorkDone();
      }
      return { maps: window.maps, live: window.live };
    };
    window.maps = 0;
    const before = await all(10);
    const after = await all(updates);
    const counters = await session.counters();
    const { clean } = await session.verify();
    session.free();
    return { before, after, counters, clean };
  }, updates);
  assert.equal(found.after.maps, 0);
  assert.equal(found.after.live, found.before.live);
  assert.equal(found.counters.updates, updates + 10);
  assert.ok(found.clean && found.counters.flips > updates);
});

test('nothing was logged', () => assert.deepEqual(problems, []));
