// Tests the demo page in Firefox: plays, scrubs and draws a file on every engine, bit for bit as in Node.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { startFirefox } from '../browsers.mjs';
import { assertPlays, expected, meshFile, openEdgeflip, tidyUp } from './page.mjs';

let browser;
before(async () => (browser = await startFirefox()));
after(tidyUp);

/** Firefox's software renderer takes long to compile the WebGL2 shaders for surfaces. */
const plane = { spec: 'random 24', name: 'plane.off' };
const surface = { spec: 'uvsphere 28 0.1', name: 'sphere.obj' };

for (const { backend, engine, spec, name } of [
  { backend: 'webgpu', engine: 'WebGPU', ...surface },
  { backend: 'webgl2', engine: 'WebGL2, in a worker', ...plane },
  { backend: 'cpu', engine: 'CPU, in a worker', ...surface },
]) {
  test(`a file plays on ${backend} in Firefox, goes back to its own triangles and forward again, bit for bit as in Node`, async (t) => {
    const path = await meshFile(spec, name);
    const want = await expected(path);
    const { facts, fingerprints } = want;
    const page = await openEdgeflip(browser);
    await page.open(path);
    const start = performance.now();
    await page.chooseEngine(backend);
    t.diagnostic(`the engine is there after ${((performance.now() - start) / 1000).toFixed(1)} s`);
    const input = await page.look();
    assert.deepEqual([input.caption, input.facts.Engine, input.facts.Fingerprint], [name, engine, fingerprints[0]]);
    await assertPlays(page, want, engine);

    assert.equal((await page.scrub('Home')).facts.Fingerprint, fingerprints[0]);
    assert.equal((await page.scrub('ArrowRight')).facts.Fingerprint, fingerprints[1]);
    assert.equal((await page.scrub('End')).facts.Fingerprint, facts.Fingerprint);
    await page.close();
  });
}

for (const backend of ['webgpu', 'cpu']) {
  test(`a sheet moves on ${backend} in Firefox, and is Delaunay when it pauses`, async () => {
    const page = await openEdgeflip(browser);
    await page.chooseEngine(backend);
    await page.page.evaluate(() => (document.getElementById('many').value = '2000'));
    // In a narrow window, the gallery is behind the name.
    await page.page.evaluate(() => document.querySelector('[data-spec="moving sheet"]').click());
    await page.until(
      'flips in the frames',
      ({ state, facts }) => state === 'moving' && Number(facts['Flips a frame']) > 0,
    );
    await page.page.click('#play');
    await page.until('no edge left', ({ status }) => /^Every edge is Delaunay/.test(status));
    await page.close();
  });
}
