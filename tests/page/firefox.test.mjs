// The demo page in Firefox: a file played, scrubbed and drawn on both engines, bit for bit as in Node.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { startFirefox } from '../browsers.mjs';
import { expected, meshFile, openEdgeflip, tidyUp } from './page.mjs';

let browser;
before(async () => (browser = await startFirefox()));
after(tidyUp);

for (const [backend, engine] of [['webgpu', 'WebGPU'], ['cpu', 'CPU, in a worker']]) {
  test(`a file plays on ${backend} in Firefox, goes back to its own triangles and forward again, bit for bit as in Node`, async (t) => {
    const path = await meshFile('uvsphere 28 0.1', 'sphere.obj');
    const { rows, facts, fingerprints } = await expected(path);
    const page = await openEdgeflip(browser);
    await page.open(path);
    const start = performance.now();
    await page.chooseEngine(backend);
    t.diagnostic(`the engine is there after ${((performance.now() - start) / 1000).toFixed(1)} s`);
    const input = await page.look();
    assert.deepEqual([input.caption, input.facts.Engine, input.facts.Fingerprint], ['sphere.obj', engine, fingerprints[0]]);
    const inputPicture = await page.picture();
    assert.ok(inputPicture.colours > 3, `${inputPicture.colours} colours of the input`);

    const end = await page.playToEnd();
    assert.deepEqual(end.rows.map((row) => row.slice(0, 4)), rows);
    for (const [fact, value] of Object.entries(facts)) assert.equal(end.facts[fact], value, fact);
    if (backend === 'webgpu') {
      assert.match(end.facts.Adapter, /\S/);
      assert.ok(Number(end.facts.Dispatches.replaceAll(',', '')) >= 3 * rows.length, `${end.facts.Dispatches} dispatches`);
    } else {
      assert.deepEqual([end.facts.Adapter, end.facts.Dispatches], [undefined, undefined]);
    }
    const endPicture = await page.picture();
    assert.ok(endPicture.colours > 3, `${endPicture.colours} colours of the result`);
    assert.ok(endPicture.differsFrom(inputPicture) > 0.01, 'the result looks like the input');

    assert.equal((await page.scrub('Home')).facts.Fingerprint, fingerprints[0]);
    assert.equal((await page.scrub('ArrowRight')).facts.Fingerprint, fingerprints[1]);
    assert.equal((await page.scrub('End')).facts.Fingerprint, facts.Fingerprint);
    await page.close();
  });
}
