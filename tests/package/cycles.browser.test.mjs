// Memory in Chromium after many sessions on the CPU and on WebGPU: those that were freed and those that were forgotten
// leave no buffer on the GPU and nothing in the module. EDGEFLIP_CYCLES changes their number. Uses the existing dist/.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { closeAll, openPage, serve, startChromium } from '../browsers.mjs';
import { full } from '../full.mjs';
import { repository } from './project.mjs';

after(closeAll);
const count = Number(process.env.EDGEFLIP_CYCLES ?? (full ? 100 : 10));

/** Runs in the page: keeps count of the bytes of GPU buffers, and defines `cycle`. */
async function prepare() {
  const { FlipSession } = await import('/dist/index.js');
  const { generate } = await import('/dist/files.js');
  const { memory } = await (await import('/dist/wasm/edgeflip.js')).default('/dist/wasm/edgeflip_bg.wasm');
  let live = 0;
  const { createBuffer } = GPUDevice.prototype;
  const collected = new FinalizationRegistry((buffer) => buffer.count());
  GPUDevice.prototype.createBuffer = function (descriptor) {
    const buffer = createBuffer.call(this, descriptor);
    const held = {
      bytes: buffer.size,
      count() {
        live -= held.bytes;
        held.bytes = 0;
      },
    };
    live += held.bytes;
    collected.register(buffer, held);
    const { destroy } = buffer;
    buffer.destroy = () => {
      held.count();
      destroy.call(buffer);
    };
    return buffer;
  };
  const mesh = await generate('random 20');
  window.cycle = async (backend, count, isFreed) => {
    for (let i = 0; i < count; i++) {
      const session = await FlipSession.create(mesh, { backend });
      if ((await session.run()).flips === 0) throw new Error('no flips');
      if (isFreed) session.free();
    }
  };
  window.bytes = () => ({ gpu: live, wasm: memory.buffer.byteLength });
}

test('sessions leave nothing behind', async () => {
  const chromium = await startChromium();
  const { page } = await openPage(chromium, `${await serve(repository)}tests/engines.html`);
  await page.evaluate(prepare);
  const bytes = async () => {
    for (let i = 0; i < 4; i++) {
      await page.requestGC();
      await page.waitForTimeout(100);
    }
    return page.evaluate(() => window.bytes());
  };
  for (const backend of ['webgpu', 'cpu']) {
    for (const isFreed of [true, false]) {
      const cycle = async () => {
        for (let left = count; left > 0; left -= 100) {
          await page.evaluate((args) => window.cycle(...args), [backend, Math.min(left, 100), isFreed]);
          if (!isFreed) await page.requestGC();
        }
      };
      await cycle();
      let before = await bytes();
      // A leak grows in every round; other memory may grow once.
      const grown = [];
      for (let round = 0; round < 3; round++) {
        await cycle();
        const after = await bytes();
        grown.push(
          Object.keys(after)
            .filter((kind) => after[kind] > 1.1 * before[kind])
            .join(),
        );
        if (backend === 'webgpu' && isFreed) assert.ok(before.gpu > 0, 'the buffers are counted');
        if (!grown.at(-1)) break;
        before = after;
      }
      const what = `${backend}, ${isFreed ? 'freed' : 'forgotten'}`;
      assert.equal(grown.at(-1), '', `${what}: grew in each round: ${grown.join('; ')}`);
    }
  }
});
