// Memory in Node after many sessions: those that were freed and those that were forgotten leave nothing behind.
// EDGEFLIP_CYCLES changes the number of sessions on several threads.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';

setFlagsFromString('--expose-gc');
const gc = runInNewContext('gc');
const [small, large] = [await generate('random 30'), await generate('random 190')];
const cycles = Number(process.env.EDGEFLIP_CYCLES ?? 200);

/** Collects what nobody holds. The engine reports collected objects between tasks only. */
async function collect() {
  for (let i = 0; i < 3; i++) {
    gc();
    await pause(5);
  }
}

/** Memory in bytes, without what nobody holds. */
async function bytes() {
  await collect();
  const { memory } = await (await import('../../dist/wasm/edgeflip.js')).default();
  const { heapUsed, external, rss } = process.memoryUsage();
  return { wasm: memory.buffer.byteLength, heap: heapUsed + external, rss };
}

async function run(mesh, threads, count, isFreed) {
  for (let i = 0; i < count; i++) {
    const session = await FlipSession.create(mesh, { backend: 'cpu', threads });
    assert.ok((await session.run()).flips > 0);
    if (isFreed) session.free();
    else if (i % 50 === 49) await collect();
  }
}

for (const [mesh, threads, count] of [
  [small, 1, 1000],
  [large, 2, cycles],
]) {
  for (const isFreed of [true, false]) {
    test(`${count} sessions on ${threads} threads that are ${isFreed ? 'freed' : 'forgotten'}`, async () => {
      await run(mesh, threads, count, isFreed);
      let before = await bytes();
      // A leak grows in every round; other memory may grow once.
      const grown = [];
      for (let round = 0; round < 3; round++) {
        await run(mesh, threads, count, isFreed);
        const after = await bytes();
        grown.push(
          Object.keys(after)
            .filter((kind) => after[kind] > 1.1 * before[kind])
            .join(),
        );
        if (!grown.at(-1)) break;
        before = after;
      }
      assert.equal(grown.at(-1), '', `grew in each round: ${grown.join('; ')}`);
    });
  }
}
