// Terrains on WebGPU and WebGL2 in Chromium: the same triangles as those of their plans on the CPU, in every frame, and
// buffers of three coordinates.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { closeAll } from '../browsers.mjs';
import { enginePage } from '../engine-page.mjs';

after(closeAll);

let page;
before(async () => {
  ({ page } = await enginePage());
  await page.evaluate(async () => {
    const { FlipSession } = await import('/dist/index.js');
    const { generate } = await import('/dist/files.js');
    const AXES = { xy: [0, 1, 2], xz: [2, 0, 1], yz: [1, 2, 0] };
    /** Gives a plan heights. */
    const raised = (plan, plane, time) => {
      const [u, v, up] = AXES[plane];
      const positions = new Float32Array((plan.length / 2) * 3);
      for (let i = 0; 2 * i < plan.length; i++) {
        positions[3 * i + u] = plan[2 * i];
        positions[3 * i + v] = plan[2 * i + 1];
        positions[3 * i + up] = Math.sin(i + time);
      }
      return positions;
    };
    const waves = (plan, time) => plan.map((x, i) => x + 0.4 * Math.sin(0.7 * i + time));
    /** The numbers in a buffer of a device. */
    const numbersIn = async (device, buffer, Type) => {
      const staging = device.createBuffer({
        size: buffer.size,
        usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST,
      });
      const encoder = device.createCommandEncoder();
      encoder.copyBufferToBuffer(buffer, 0, staging, 0, buffer.size);
      device.queue.submit([encoder.finish()]);
      await staging.mapAsync(GPUMapMode.READ);
      const numbers = new Type(staging.getMappedRange().slice(0));
      staging.destroy();
      return [...numbers];
    };
    const equal = (a, b, what) => {
      const [x, y] = [a, b].map((value) => JSON.stringify(value));
      if (x !== y) throw new Error(`${what}: ${x?.slice(0, 200)} is not ${y?.slice(0, 200)}`);
    };
    Object.assign(window, { terrains: { FlipSession, generate, raised, waves, numbersIn, equal } });
  });
});

for (const plane of ['xy', 'xz', 'yz']) {
  test(`runs and updates in the plane ${plane}`, async () => {
    const flips = await page.evaluate(async (plane) => {
      const { FlipSession, generate, raised, waves, numbersIn, equal } = window.terrains;
      const plan = await generate('random 14');
      const terrain = { ...plan, positions: raised(plan.positions, plane, 0), plane };
      const device = await (await navigator.gpu.requestAdapter()).requestDevice();
      const cpu = await FlipSession.create(plan, { backend: 'cpu' });
      const gpu = await FlipSession.create(terrain, { backend: 'webgpu', device });
      const gl = await FlipSession.create(terrain, { backend: 'webgl2' });
      const all = [cpu, gpu, gl];
      const results = await Promise.all(all.map((session) => session.run()));
      for (const { indices, flips, remaining } of results) {
        equal(
          [[...indices], flips, remaining],
          [[...results[0].indices], results[0].flips, results[0].remaining],
          'run',
        );
      }
      const same = async (what) => {
        const [first, ...others] = await Promise.all(all.map(async (session) => [...(await session.triangles())]));
        for (const other of others) equal(other, first, what);
      };
      const heightsAre = async (positions, what) =>
        equal(await numbersIn(device, (await gpu.gpu()).positions, Float32Array), [...positions], what);
      const usage = GPUBufferUsage.COPY_SRC | GPUBufferUsage.COPY_DST | GPUBufferUsage.STORAGE;
      const { length } = terrain.positions;

      // 1. An array, before the page has asked for buffers, and after.
      for (const time of [1, 2]) {
        const moved = waves(plan.positions, time);
        cpu.update({ positions: moved });
        const high = raised(moved, plane, time);
        for (const session of [gpu, gl]) session.update({ positions: high });
        high.fill(0);
        await same(`array ${time}`);
        await heightsAre(raised(moved, plane, time), `array ${time}`);
      }
      // 2. The buffer of the session, which the page writes.
      const { positions, indices } = await gpu.gpu();
      let moved = waves(plan.positions, 3);
      let high = raised(moved, plane, 3);
      device.queue.writeBuffer(positions, 0, high);
      gpu.update();
      cpu.update({ positions: moved });
      gl.update({ positions: high });
      await same('buffer of the session');
      equal(await numbersIn(device, indices, Uint32Array), [...(await cpu.triangles())], 'indices');
      // 3. A buffer of the page, without gaps and with gaps.
      for (const stride of [3, 5]) {
        moved = waves(plan.positions, 10 + stride);
        high = raised(moved, plane, 10 + stride);
        const spread = new Float32Array(2 + (length / 3) * stride);
        high.forEach((x, i) => {
          spread[2 + Math.floor(i / 3) * stride + (i % 3)] = x;
        });
        const buffer = device.createBuffer({ size: spread.byteLength, usage });
        device.queue.writeBuffer(buffer, 0, spread);
        gpu.update({ buffer, offset: 2, ...(stride > 3 && { stride }) });
        cpu.update({ positions: moved });
        gl.update({ positions: high });
        await same(`stride ${stride}`);
        await heightsAre(high, `stride ${stride}`);
        // 4. A session that begins with it.
        const given = { positions: buffer, offset: 2, stride, vertices: length / 3, dimension: 2, plane };
        const list = device.createBuffer({ size: terrain.indices.byteLength, usage });
        device.queue.writeBuffer(list, 0, terrain.indices);
        const other = await FlipSession.fromBuffers({ ...given, indices: list }, { backend: 'webgpu', device });
        const plain = await FlipSession.create({ ...plan, positions: moved }, { backend: 'cpu' });
        equal([...(await other.run()).indices], [...(await plain.run()).indices], 'from buffers');
        other.update({ buffer, offset: 2, stride });
        plain.update({ positions: moved });
        equal([...(await other.triangles())], [...(await plain.triangles())], 'from buffers, updated');
        other.free();
        plain.free();
      }
      // 5. All positions at once.
      moved = waves(plan.positions, 20);
      high = raised(moved, plane, 20);
      await Promise.all([cpu.setPositions(moved), gpu.setPositions(high), gl.setPositions(high)]);
      const again = await Promise.all(all.map((session) => session.run()));
      for (const { indices } of again) equal([...indices], [...again[0].indices], 'setPositions');
      await heightsAre(high, 'setPositions');
      const few = device.createBuffer({ size: 4 * length - 4, usage });
      let why;
      try {
        gpu.update({ buffer: few });
      } catch ({ code }) {
        why = code;
      }
      equal(why, 'position-count', 'short buffer');
      for (const session of all) session.free();
      await new Promise((resolve) => setTimeout(resolve, 50));
      device.destroy();
      return results[0].flips;
    }, plane);
    assert.ok(flips > 20, `${flips}`);
  });
}
