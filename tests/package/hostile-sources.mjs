// Hostile values as sources of the package's modules, in a worker that has loaded none of them.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { setTimeout as pause } from 'node:timers/promises';
import { parentPort, workerData } from 'node:worker_threads';
import * as edgeflip from 'edgeflip';
import * as files from 'edgeflip/files';
import fc from 'fast-check';
import { hostile } from './hostile.mjs';

const { runs, seed, patience } = workerData;
const modules = {
  edgeflip: edgeflip.init,
  edgeflip_webgl2: edgeflip.initWebGl2,
  edgeflip_threads: edgeflip.initThreads,
  edgeflip_audit: edgeflip.initAudit,
  edgeflip_files: files.initFiles,
};

/** `undefined` is the module beside the package. */
const source = hostile.filter((make) => make() !== undefined);
const property = fc.asyncProperty(fc.constantFrom(...Object.values(modules)), source, async (init, make) => {
  const asked = init(make()).then(() => 'loaded', ({ code }) => code);
  assert.equal(await Promise.race([asked, pause(patience, 'late', { ref: false })]), 'load-failed');
});
await fc.assert(property, { numRuns: runs, seed, endOnFailure: true });

// A source that is right loads them after all, in whatever kind its bytes are, and whatever becomes of them after the call.
const kinds = [(bytes) => bytes, ({ buffer }) => buffer, ({ buffer }) => new DataView(buffer)];
for (const [i, [name, init]] of Object.entries(modules).entries()) {
  const bytes = new Uint8Array(readFileSync(new URL(`../../dist/wasm/${name}_bg.wasm`, import.meta.url)));
  const loaded = init(kinds[i % kinds.length](bytes));
  bytes.fill(0);
  await loaded;
}
const { flips } = await edgeflip.makeDelaunay(await files.generate('random 12'), { backend: 'cpu' });
parentPort.postMessage(flips);
