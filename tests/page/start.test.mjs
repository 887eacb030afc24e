// Tests the server of `npm start`: the page from its sources, and the examples beside it. It reads the existing dist/.

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
