// Tests the server of `npm start`: the page from its sources, and what it links to beside it. It reads the existing dist/.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { createServer } from 'vite';
import { openPage, startChromium } from '../browsers.mjs';
import { EdgeflipPage } from './page.mjs';

let server, address;
before(async () => {
  const configFile = fileURLToPath(new URL('../../www/vite.config.js', import.meta.url));
  server = await createServer({ configFile, logLevel: 'silent', server: { port: 0, hmr: false } });
  await server.listen();
  [address] = server.resolvedUrls.local;
});
after(() => server.close());

test('the server of npm start serves the page', async () => {
  const { page, problems } = await openPage(await startChromium(), `${address}#watch?mesh=random+24`);
  const edgeflip = new EdgeflipPage(page, problems);
  await edgeflip.rest();
  assert.equal(await page.evaluate(() => document.body.dataset.mesh), 'random 24');
  assert.equal(await page.evaluate(() => crossOriginIsolated), true);
  await edgeflip.close();
});

test('the server of npm start serves the examples', async () => {
  for (const name of ['sheet', 'waves', 'relax']) {
    const { page, problems } = await openPage(await startChromium(), `${address}examples/${name}.html`);
    await page.waitForSelector('canvas');
    assert.match(await page.title(), /edgeflip/);
    assert.deepEqual(problems, [], name);
    await page.close();
  }
});

test('the server of npm start serves the documents and the API reference', async () => {
  const { page, problems } = await openPage(await startChromium(), `${address}README.html`);
  for (const [path, title] of [
    ['docs/options.html', 'Options'],
    ['examples/index.html', 'Examples'],
    ['examples/gltf.mjs.html', 'examples/gltf.mjs'],
    ['api/index.html', 'edgeflip'],
  ]) {
    // Else going on would break off the request for the icon, which counts as a problem.
    await page.waitForLoadState('networkidle');
    await page.goto(`${address}${path}`);
    assert.equal(await page.textContent('h1'), title);
    assert.ok(await page.evaluate(() => document.styleSheets.length > 0));
  }
  const answer = await fetch(`${address}docs/nothing.html`, { headers: { Accept: 'text/css' } });
  assert.equal(answer.status, 404);
  assert.deepEqual(problems, []);
  await page.close();
});
