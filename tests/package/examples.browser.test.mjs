// The pages in examples/, served by `examples/vite.config.js`, in Chromium. Uses the existing dist/.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { createServer } from 'vite';
import { closeAll, openPage, startChromium } from '../browsers.mjs';
import { repository } from './project.mjs';

let server;
let chromium;
before(async () => {
  const configFile = join(repository, 'examples/vite.config.js');
  server = await createServer({ configFile, logLevel: 'warn', server: { port: 0 } });
  await server.listen();
  chromium = await startChromium();
});
after(async () => {
  await closeAll();
  await server.close();
});

const open = (name) => openPage(chromium, `${server.resolvedUrls.local[0]}${name}`);
const stateOf = (page, pattern) =>
  page
    .waitForFunction(
      (pattern) => {
        const { value } = document.querySelector('output');
        return new RegExp(pattern).test(value) && value;
      },
      pattern,
      { timeout: 60_000 },
    )
    .then((handle) => handle.jsonValue());

test('a worker flips, and the page shows its progress', async () => {
  const { page, problems } = await open('worker.html?size=100');
  await page.click('#run:enabled');
  assert.match(await stateOf(page, '^done'), /^done: \d{4,} flips in \d+ iterations on cpu$/);
  assert.ok(await page.isDisabled('#run'));
  assert.deepEqual(problems, []);
  await page.close();
});

test('three.js draws a geometry that became Delaunay', async () => {
  const { page, problems } = await open('three.html');
  await page.waitForSelector('#flip:enabled');
  const picture = () => page.locator('canvas').screenshot();
  /** The first picture that differs, because the software GPU takes its time. */
  const pictureAfter = async (old) => {
    for (const start = performance.now(); performance.now() - start < 30_000; await page.waitForTimeout(200)) {
      const now = await picture();
      if (!now.equals(old)) return now;
    }
    return old;
  };
  await page.waitForTimeout(1000);
  const before = await picture();
  assert.deepEqual(await picture(), before);
  await page.click('#flip');
  assert.match(await stateOf(page, ' flips on '), /^\d{3,} flips on (cpu|webgpu)$/);
  assert.notDeepEqual(await pictureAfter(before), before);
  assert.deepEqual(problems, []);
  await page.close();
});
