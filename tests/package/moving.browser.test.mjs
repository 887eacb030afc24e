// Tests updates on WebGPU and WebGL2 in Chromium: the same triangles as the CPU in every frame, and on WebGPU without a
// call that waits.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { closeAll } from '../browsers.mjs';
import { enginePage } from '../engine-page.mjs';
import { full } from '../full.mjs';

after(closeAll);
const updates = Number(process.env.EDGEFLIP_UPDATES ?? (full ? 300 : 40));

let page;
let problems;
before(async () => {
  ({ page, problems } = await enginePage());
  await page.evaluate(prepare);
});

/** Runs in the page: defines what the tests call. */
async function prepare() {
  const { FlipSession } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  // Buffers that are being mapped now, the most at a time, and the most bytes of one.
  Object.assign(window, { FlipSession, generate, mapping: 0, maps: 0, mapped: 0, live: 0 });
  const { mapAsync } = GPUBuffer.prototype;
  GPUBuffer.prototype.mapAsync = function (...args) {
    window.maps = Math.max(window.maps, ++window.mapping);
    window.mapped = Math.max(window.mapped, args[2] ?? this.size);
    return mapAsync.apply(this, args).finally(() => window.mapping--);
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
  /** Sessions on the mesh, one for each engine. */
  window.sessionsOn = (mesh, options, backends = ['webgpu', 'cpu', 'webgl2']) =>
    Promise.all(backends.map((backend) => FlipSession.create(mesh, { ...options, backend })));
  /** Fails unless all sessions have the same triangles, counts and changes. Returns their flips. */
  window.equal = async (sessions) => {
    const [first, ...others] = await Promise.all(
      sessions.map(async (session) =>
        JSON.stringify([await session.counters(), [...(await session.triangles())], [...(await session.changes())]]),
      ),
    );
    for (const other of others) {
      if (other !== first) throw new Error(`${first.slice(0, 300)}\nis not\n${other.slice(0, 300)}`);
    }
    return (await sessions[0].counters()).flips;
  };
}

test('arrays: all engines give the same after every update', async () => {
  const specs = full ? ['random 20', 'uvsphere 14', 'regular 12'] : ['random 12', 'uvsphere 10'];
  const flips = await page.evaluate(async (specs) => {
    let flips = 0;
    for (const spec of specs) {
      const mesh = await generate(spec);
      const lockedEdges = mesh.indices.subarray(0, 2);
      const sessions = await sessionsOn(mesh, { maxNormalAngle: 40, lockedEdges, trackChanges: true });
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
      const others = await sessionsOn(mesh, { maxNormalAngle: 40 });
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
  }, specs);
  assert.ok(flips > (full ? 1000 : 300), `${flips} flips`);
});

test('random motions of dirty meshes', async () => {
  const flips = await page.evaluate(async () => {
    let seed = 20261125;
    /** A whole number below `end`, from a linear congruential generator. */
    const below = (end) => {
      seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
      return Math.floor((seed / 2 ** 32) * end);
    };
    const positions = (dimension) => Float32Array.from({ length: 16 * dimension }, () => below(7) - 3);
    const sheet = await generate('random 4');
    let flips = 0;
    for (let mesh = 0; mesh < 24; mesh++) {
      const dimension = 2 + (mesh % 2);
      // A sheet, and triangles that make edges non-manifold.
      const indices = [...sheet.indices];
      while (indices.length < sheet.indices.length + 3 * (mesh % 8)) {
        const [a, b, c] = [below(16), below(16), below(16)];
        if (a !== b && b !== c && c !== a) indices.push(a, b, c);
      }
      const maxDeviation = mesh % 4 === 3 ? 0.75 : Infinity;
      const options = { maxNormalAngle: 120, maxDeviation, trackChanges: true };
      const sessions = await sessionsOn({ positions: positions(dimension), indices, dimension }, options);
      for (let frame = 0; frame < 5; frame++) {
        const moved = positions(dimension);
        if (frame === 2) moved[below(32)] = NaN;
        const iterations = below(5);
        for (const session of sessions) session.update({ positions: moved, iterations });
        flips += await equal(sessions);
      }
      for (const session of sessions) session.free();
    }
    return flips;
  });
  assert.ok(flips > 200, `${flips} flips`);
});

test('edges that span too many bits are left alone, by the same rule on both GPU engines', async () => {
  const counts = await page.evaluate(async () => {
    const counts = [];
    for (const [spec, maxDeviation] of [
      ['random 12', Infinity],
      ['uvsphere 12', 0.5],
      // A limit that no edge reaches costs no bits.
      ['uvsphere 12', 1e18],
    ]) {
      const mesh = await generate(spec);
      const sessions = await sessionsOn(mesh, { maxDeviation, trackChanges: true }, ['webgpu', 'webgl2']);
      const positions = moved(mesh, 1);
      for (const number of [1e-30, 3e38, 0.25]) {
        positions[40] = number;
        for (const session of sessions) session.update({ positions, iterations: 64 });
        await equal(sessions);
        counts.push((await sessions[1].counters()).tooWide);
      }
      // The last positions span few bits: the CPU agrees.
      const [cpu] = await sessionsOn({ ...mesh, indices: await sessions[0].triangles() }, { maxDeviation }, ['cpu']);
      cpu.update({ positions, iterations: 0 });
      counts.push(
        JSON.stringify((await cpu.counters()).remaining) === JSON.stringify((await sessions[1].counters()).remaining),
      );
      for (const session of [...sessions, cpu]) session.free();
    }
    return counts;
  });
  for (let i = 0; i < counts.length; i += 4) {
    assert.ok(counts[i] > 2 && counts[i] < 40 && counts[i + 1] > 2 && counts[i + 1] < 40, `${counts}`);
    assert.deepEqual(counts.slice(i + 2, i + 4), [0, true]);
  }
});

test('the error of an update that had to wait comes with the next call', async () => {
  const results = await page.evaluate(async () => {
    const away = await import('/dist/worker.js');
    const mesh = await generate('random 12');
    const doubles = Float64Array.from(mesh.positions, (x) => x / 3);
    const results = [];
    for (const of of [FlipSession, away.FlipSession]) {
      for (const backend of ['webgpu', 'webgl2']) {
        const session = await of.create(mesh, { backend });
        const running = session.run();
        session.update({ positions: doubles });
        await running;
        results.push(await session.counters().catch(({ code }) => code), (await session.counters()).updates);
        // The next update may throw the error instead, and the one after it goes on.
        const again = session.run();
        session.update({ positions: doubles });
        await again;
        try {
          session.update();
        } catch ({ code }) {
          results.push(code);
        }
        await session.counters().catch(({ code }) => results.push(code));
        session.update();
        results.push((await session.counters()).updates > 0);
        session.free();
      }
    }
    return results;
  });
  const each = ['backend-limit', 0, 'backend-limit', true];
  assert.deepEqual(results, [...each, ...each, ...each, ...each]);
});

test('buffers: without gaps, with an offset and a stride, and written by the page', async () => {
  const results = await page.evaluate(async () => {
    const results = [];
    for (const spec of ['random 20', 'uvsphere 14']) {
      const mesh = await generate(spec);
      const { dimension } = mesh;
      const sessions = await sessionsOn(mesh, {}, ['webgpu', 'cpu']);
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
    /^invalid-input: positions: a Float32Array is not a GPUBuffer of this page$/,
    /^invalid-input: positions: the buffer has \d+ bytes, and the mesh needs \d+$/,
    /^invalid-input: indices: -1 is not a number of them$/,
    /^invalid-input: the buffers of the mesh cannot be read: /,
    /^(index-out-of-range|ragged-array): /,
  ].entries()) {
    assert.match(results[i + 1], pattern);
  }
});

test('frames ask for one number of an earlier frame, and leave nothing behind', async () => {
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
      return { maps: window.maps, mapped: window.mapped, live: window.live };
    };
    Object.assign(window, { maps: 0, mapped: 0 });
    const before = await all(10);
    const after = await all(updates);
    const counters = await session.counters();
    const { violations } = await session.verify();
    session.free();
    return { before, after, counters, violations };
  }, updates);
  // How many triangles were turned over: it comes when it comes.
  assert.deepEqual([found.after.maps, found.after.mapped], [1, 4]);
  assert.equal(found.after.live, found.before.live);
  assert.equal(found.counters.updates, updates + 10);
  assert.deepEqual(found.violations, []);
  assert.ok(found.counters.flips > updates);
});

test('nothing was logged', () => assert.deepEqual(problems, []));
