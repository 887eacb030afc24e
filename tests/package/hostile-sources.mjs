// Passes hostile values as sources of the package's modules, in a worker that has loaded none of the modules.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { setTimeout as pause } from 'node:timers/promises';
import { parentPort, workerData } from 'node:worker_threads';
import * as edgeflip from 'edgeflip';
import * as files from 'edgeflip/files';
import * as points from 'edgeflip/points';
import fc from 'fast-check';
import { hostile } from './hostile.mjs';

const { runs, seed, patience } = workerData;
const inits = [
  ...['core', 'webgl2', 'threads', 'untangle', 'audit', 'files'].map(
    (name) => (source) => edgeflip.init({ [name]: source }),
  ),
  (source) => files.init({ files: source }),
  ...['points', 'threads'].map((name) => (source) => points.init({ [name]: source })),
];

/** All hostile values except `undefined`, which means the module next to the package. */
const source = hostile.filter((make) => make() !== undefined);
const property = fc.asyncProperty(fc.constantFrom(...inits), source, async (init, make) => {
  const asked = init(make()).then(
    () => 'loaded',
    ({ code }) => code,
  );
  assert.equal(await Promise.race([asked, pause(patience, 'late', { ref: false })]), 'load-failed');
});
await fc.assert(property, { numRuns: runs, seed, endOnFailure: true });

// Afterwards a valid source loads each module: bytes of any kind, even if the caller changes them after the call.
const modules = {
  core: 'edgeflip',
  webgl2: 'edgeflip_webgl2',
  threads: 'edgeflip_threads',
  untangle: 'edgeflip_untangle',
  audit: 'edgeflip_audit',
  files: 'edgeflip_files',
};
const kinds = [(bytes) => bytes, ({ buffer }) => buffer, ({ buffer }) => new DataView(buffer)];
for (const [i, [name, file]] of Object.entries(modules).entries()) {
  const bytes = new Uint8Array(readFileSync(new URL(`../../dist/wasm/${file}_bg.wasm`, import.meta.url)));
  const loaded = edgeflip.init({ [name]: kinds[i % kinds.length](bytes) });
  bytes.fill(0);
  await loaded;
}
for (const [name, file] of Object.entries({ points: 'edgeflip_points', threads: 'edgeflip_points_threads' })) {
  await points.init({ [name]: readFileSync(new URL(`../../dist/wasm/${file}_bg.wasm`, import.meta.url)) });
}
assert.deepEqual([...points.triangulateSync([0, 0, 1, 0, 0, 1]).triangles], [0, 1, 2]);

// A value that is not an object of sources, or not a folder, is an error of this package. An object without sources is
// valid.
const given = fc.oneof(
  hostile.map((make) => () => make()),
  hostile.map((make) => () => ({ base: make(), core: 0 })),
  hostile.map((make) => () => ({ other: make(), core: 0 })),
);
const sources = fc.asyncProperty(given, async (make) => {
  const asked = edgeflip.init(make()).then(
    () => 'loaded',
    ({ name, code }) => (name === 'EdgeflipError' ? code : name),
  );
  const end = await Promise.race([asked, pause(patience, 'late', { ref: false })]);
  assert.ok(['loaded', 'load-failed', 'invalid-input', 'invalid-option'].includes(end), end);
});
await fc.assert(sources, { numRuns: runs, seed, endOnFailure: true });

const { flips } = await edgeflip.makeDelaunay(await files.generate('random 12'), { backend: 'cpu' });
parentPort.postMessage(flips);
