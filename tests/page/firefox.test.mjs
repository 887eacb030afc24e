// Tests the demo page in Firefox: plays, scrubs and draws a file on every engine, bit for bit as in Node; moves a mesh;
// and what a visitor does besides.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { readMesh } from 'edgeflip/files';
import { startFirefox } from '../browsers.mjs';
import { assertSelected, hashOf, LESSON, openAt } from './lesson.mjs';
import { assertPlays, expected, file, first, meshFile, openEdgeflip, pageInFirefox } from './page.mjs';
import { coloursIn, kitesGlb } from './textured.mjs';

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
    const page = await pageInFirefox();
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

test('textures and colours of vertices are drawn in Firefox', async () => {
  const page = await pageInFirefox();
  await page.open(file('kites.glb', kitesGlb()));
  await page.page.waitForSelector('[data-surface=file]');
  const { red, green, blue } = coloursIn(await page.stillPicture(1));
  const said = JSON.stringify({ red, green, blue });
  assert.ok(red.share > 0.005 && green.share > 0.005 && blue.share > 0.005, said);
  assert.ok(red.at < green.at && green.at < blue.at, said);
  await page.close();
});

for (const backend of ['webgpu', 'cpu']) {
  test(`a sheet moves on ${backend} in Firefox, and is Delaunay when it pauses`, async () => {
    const page = await pageInFirefox();
    await page.page.evaluate(() => (document.getElementById('many').value = '2000'));
    // In a narrow window, the gallery is behind the name.
    await page.page.evaluate(() => document.querySelector('[data-spec="moving sheet"]').click());
    // Another engine in the meantime would end the worker, and with it a request for the module of files.
    await page.until('a mesh that moves', ({ state }) => state === 'moving');
    await page.choose('backend', backend);
    const { facts } = await page.until(
      'flips in the frames',
      ({ state, facts }) => state === 'moving' && Number(facts['Flips a frame']) > 0,
    );
    assert.equal(facts.Engine, backend === 'cpu' ? 'CPU, in a worker' : 'WebGPU');
    await page.page.click('#play');
    await page.until('no edge left', ({ status }) => /^Every edge is Delaunay/.test(status));
    await page.close();
  });
}

test('β, an inspected edge, before and now, a saved file and a link in Firefox', async () => {
  const page = await openEdgeflip(await startFirefox());
  await page.page.evaluate(() => {
    const make = URL.createObjectURL;
    URL.createObjectURL = (blob) => {
      window.saved = blob;
      return make.call(URL, blob);
    };
    const beta = document.getElementById('beta');
    beta.value = '60';
    beta.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await page.until('a new run', ({ facts, state }) => facts['Crease limit β'] === '60°' && state === 'ready');
  const { indices, facts, fingerprints } = await expected(first.path, 60);
  assert.equal((await page.playToEnd()).facts.Fingerprint, facts.Fingerprint);
  const result = await page.picture();
  assert.equal((await page.scrub('Home')).facts.Fingerprint, fingerprints[0]);

  const press = async (key) => {
    await page.page.evaluate(() => document.activeElement.blur());
    await page.page.keyboard.press(key);
  };
  const text = (id) => page.page.evaluate((name) => document.getElementById(name).textContent, id);
  await press('n');
  assert.match(await text('inspect'), /Flips now.*\d+°.*more than 180°/s);
  await press('Escape');

  const input = await page.picture();
  await page.scrub('End');
  await press('c');
  await page.page.evaluate(() => {
    const cut = document.getElementById('cut');
    cut.value = '1000';
    cut.dispatchEvent(new Event('input', { bubbles: true }));
    document.getElementById('halves').style.opacity = '0';
  });
  const left = await page.picture();
  assert.ok(left.differsFrom(input) < left.differsFrom(result), 'left of the cut is the input');
  await press('c');

  await page.page.click('#take');
  await page.page.click('#download');
  await page.page.waitForFunction(() => window.saved);
  const saved = await page.page.evaluate(async () => [...new Uint8Array(await window.saved.arrayBuffer())]);
  assert.deepEqual((await readMesh(Uint8Array.from(saved), first.path)).indices, indices);

  const link = new URL(page.page.url());
  link.hash = 'watch?mesh=uvsphere+28+0.1&at=1&engine=cpu&beta=60';
  await page.page.goto('about:blank');
  await page.page.goto(link.href);
  const sphere = await expected(await meshFile(surface.spec, 'linked.ply'), 60);
  const opened = await page.until('its iteration', ({ at, measured }) => at === '1' && measured === '1');
  assert.deepEqual([opened.caption, opened.facts.Fingerprint], [surface.spec, sphere.fingerprints[1]]);
  await page.close();
});

test('the link of a lesson in the playground opens in the same state in Firefox', async () => {
  const { page, problems } = await openAt(await startFirefox(), hashOf({ ...LESSON, edge: [2, 7] }));
  const { why } = await assertSelected(page, LESSON, 2);
  assert.match(why.join(), /^[\d.]+° \+ [\d.]+° is [\d.]+°, more than 180°\. .* So it waits in this round/);
  await page.close();
  assert.deepEqual(problems, []);
});
