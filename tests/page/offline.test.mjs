// Tests the page in Chromium on a server that sends no headers, in a folder of it: at the second visit it is
// cross-origin isolated, and it needs no network.

import assert from 'node:assert/strict';
import { cpSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { generate } from 'edgeflip/files';
import { openPage, serve, startChromium } from '../browsers.mjs';
import { EdgeflipPage, expected, fingerprintOf, first, folder, meshFile } from './page.mjs';

test('after a visit to the tool, the page needs no network and no headers', async () => {
  cpSync(fileURLToPath(new URL('../../target/www', import.meta.url)), join(folder, 'some/where'), { recursive: true });
  const address = `${await serve(folder)}some/where/`;
  const { page, problems } = await openPage(await startChromium(), `${address}#watch`, true);
  const edgeflip = new EdgeflipPage(page, problems);
  await edgeflip.rest();
  assert.equal(await page.evaluate(() => crossOriginIsolated), false);
  const scope = await page.evaluate(async () => (await navigator.serviceWorker.ready).scope);
  assert.equal(scope, address);

  await page.context().setOffline(true);
  await page.reload();
  await edgeflip.rest();
  assert.equal(await page.evaluate(() => crossOriginIsolated), true);
  const want = await expected(first.path, first.maxNormalAngle);
  assert.equal((await edgeflip.playToEnd()).facts.Fingerprint, want.facts.Fingerprint);

  for (const [backend, engine] of [
    ['webgpu', 'WebGPU'],
    ['webgl2', 'WebGL2, in a worker'],
  ]) {
    const path = await meshFile('random 24', `${backend}.off`);
    const { facts } = await expected(path);
    await edgeflip.open(path);
    await edgeflip.chooseEngine(backend);
    const end = await edgeflip.playToEnd();
    assert.deepEqual([end.facts.Engine, end.facts.Fingerprint], [engine, facts.Fingerprint]);
  }
  await edgeflip.chooseEngine('cpu');
  await edgeflip.choose('sample', 'shear 16');
  await edgeflip.until('the sample', ({ caption }) => caption === 'shear 16');
  const seen = await edgeflip.rest();
  assert.equal(seen.facts.Fingerprint, fingerprintOf((await generate('shear 16')).indices));
  await edgeflip.choose('sample', 'models/suzi.glb');
  await edgeflip.until('a model', ({ caption }) => caption === 'suzi.glb');
  await edgeflip.rest();
  for (const [section, part] of [
    ['explain', '.explain-handle'],
    ['engines', '#engines canvas, #engines svg'],
    ['paper', '#paper tbody tr'],
  ]) {
    await page.evaluate((id) => document.getElementById(id).scrollIntoView(), section);
    await page.locator(part).first().waitFor({ state: 'attached' });
  }
  // The documents are kept; the API reference and the examples are too large for that.
  const kept = await page.evaluate(async () => {
    const [name] = await caches.keys();
    return (await (await caches.open(name)).keys()).map(({ url }) => url);
  });
  assert.ok(kept.some((url) => url.includes('/docs/options.html')));
  assert.deepEqual(
    kept.filter((url) => /\/api\/|\/examples\/(assets|\w+\.html)/.test(url) && !url.includes('examples/index.html')),
    [],
  );
  await page.goto(`${address}docs/options.html`);
  assert.equal(await page.textContent('h1'), 'Options');
  await edgeflip.close();
});
