// Tests the engines of the package in dist/ in real browsers: the parity matrix, quads and locks. Each browser uses one
// page for all tests, so that it compiles the kernels once: a software GPU compiles longer than it runs. Prints the
// matrix last.

import assert from 'node:assert/strict';
import { existsSync } from 'node:fs';
import { after, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { closeAll, openPage, serve, startFirefox } from './browsers.mjs';
import { enginePage } from './engine-page.mjs';
import { full } from './full.mjs';

const repository = fileURLToPath(new URL('..', import.meta.url));
for (const [file, command] of [
  ['dist/index.js', 'npm run build'],
  ['target/parity.json', 'npm test -- parity'],
  ['target/quads/batches.json', 'npm test -- parity'],
]) {
  assert.ok(existsSync(repository + file), `${file} is missing; run ${command}`);
}
const { fill, matrix } = await import('./parity/matrix.mjs');
const { check } = await import('./quads/browsers.mjs');
const { untangles } = await import('./package/folds.mjs');
const { holdLocks } = await import('./package/locks.mjs');
const { moves } = await import('./package/motions.mjs');

// In the short run, a software GPU leaves out what takes it longest, and the table says `full` there.
const all = () => true;
/** Long runs and large meshes. */
const isSmall = ({ indices, iterations }) => (indices.length / 3) * (1 + iterations.length) < 3_000;
/** The kernels for doubles and for deviations. */
const isPlain = ({ isWide, deviation }) => !isWide && deviation === null;

/**
 * `meshes` and `quads`: which of them the GPU engines run. `watched`: the most iterations of a run that is compared after
 * each. `most`: the frames of a motion in the full run.
 *
 * @type {{ name: string, open: () => ReturnType<typeof enginePage>, meshes: (mesh: any) => boolean,
 *   quads: (batch: any) => boolean, engines: { backend: string, watched: number, most: number }[] }[]}
 */
const browsers = [
  {
    name: 'Chromium',
    open: enginePage,
    meshes: full ? all : isSmall,
    quads: all,
    engines: [
      { backend: 'cpu', watched: 1000, most: 2000 },
      // A software GPU takes seconds for a frame of WebGPU.
      { backend: 'webgpu', watched: 200, most: 60 },
      { backend: 'webgl2', watched: 200, most: 400 },
    ],
  },
  {
    name: 'Firefox',
    open: async () => openPage(await startFirefox(), `${await serve(repository)}tests/engines.html`),
    meshes: full ? all : (mesh) => isSmall(mesh) && isPlain(mesh),
    quads: full ? all : isPlain,
    engines: [
      { backend: 'webgpu', watched: 150, most: 2000 },
      { backend: 'webgl2', watched: 150, most: 2000 },
    ],
  },
];
const titles = { cpu: 'CPU wasm', webgpu: 'WebGPU', webgl2: 'WebGL2' };

after(closeAll);
process.on('exit', () => console.log(`\n${matrix()}`));

// In parallel: Firefox mostly waits.
describe('engines', { concurrency: true }, () => {
  for (const { name, open, meshes, quads, engines } of browsers) {
    test(`in ${name}`, { timeout: full ? 3_600_000 : 900_000 }, async (t) => {
      const { page, problems } = await open();
      await page.evaluate(async () => {
        for (const part of ['parity', 'quads']) await import(`/tests/${part}/page.js`);
      });
      for (const engine of engines.map((engine) => ({ ...engine, title: `${titles[engine.backend]} ${name}` }))) {
        const takes = engine.backend === 'cpu' ? all : meshes;
        await t.test(`${engine.title} gives the results of the simulation`, () => fill(page, engine, takes));
        const frames = full ? engine.most : 17;
        await t.test(`${engine.title} untangles in updates as the CPU in Node does`, () => moves(page, engine, frames));
        if (engine.backend === 'cpu') continue;
        await t.test(`${engine.title} decides quads as big integers do`, () => check(page, engine, quads));
        await t.test(`${engine.title} untangles as the CPU does`, () => untangles(page, engine));
        // In Firefox, each wait for the GPU takes 100 ms.
        if (name === 'Firefox') continue;
        await t.test(`${engine.title} holds locks and limits when the vertices move`, () => holdLocks(page, engine));
      }
      assert.deepEqual(problems, []);
    });
  }
});
