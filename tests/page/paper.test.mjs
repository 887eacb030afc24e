// Tests the section "The paper, run again": its numbers are those that were measured, and its plots those of the package.

import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import { FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { MESHES } from '../../tools/paper/theirs.mjs';
import site from '../../www/vite.config.js';
import { openPage, serve, startChromium } from '../browsers.mjs';
import { sharedPage } from './page.mjs';

const results = new URL('../../benches/results/', import.meta.url);

/** The flips of each iteration. */
async function flipsOf(spec) {
  const session = await FlipSession.create(await generate(spec), { backend: 'cpu' });
  const flips = [];
  for await (const iteration of session) flips.push(iteration.flips);
  session.free();
  return flips;
}

test('the table has the numbers of the paper and of the newest measurements on a GPU', async () => {
  const name = readdirSync(results)
    .filter((file) => /-paper-\w+\.json$/.test(file) && !file.includes('cores'))
    .sort()
    .at(-1);
  const { meshes } = JSON.parse(readFileSync(new URL(name, results)));
  const edgeflip = await sharedPage();
  const { page } = edgeflip;
  await page.evaluate(() => document.getElementById('paper').scrollIntoView());
  await page.waitForSelector('.paper-table tbody tr');
  const rows = await page.evaluate(() =>
    [...document.querySelectorAll('.paper-table tbody tr')].map((row) =>
      [...row.cells].map(({ textContent }) => textContent),
    ),
  );
  assert.equal(rows.length, meshes.length);
  const digits = (x) => x.toLocaleString('en', { maximumSignificantDigits: 3 });
  meshes.forEach(({ id, triangles, iterations, gpu, lawson }, i) => {
    const theirs = MESHES.find((mesh) => mesh.id === id);
    assert.equal(rows[i][1], triangles.toLocaleString('en'));
    const ours = [`${iterations}`, digits(gpu.total), digits(lawson.total), digits(lawson.total / gpu.total)];
    assert.deepEqual([rows[i][3], rows[i][5], rows[i][7], rows[i][9]], ours);
    assert.deepEqual(
      [rows[i][4], rows[i][6]],
      theirs ? [digits(1000 * theirs.gpu), digits(1000 * theirs.cpu)] : ['–', '–'],
    );
    assert.equal(rows[i][2], theirs ? `${theirs.iterations}` : '–');
    assert.equal(rows[i][8], theirs ? digits(theirs.speedUp) : '–');
  });
  await edgeflip.close();
});

test('four cells say from which size on the GPU is faster', async () => {
  const name = readdirSync(results)
    .filter((file) => /-paper-\w+\.json$/.test(file) && !file.includes('cores'))
    .sort()
    .at(-1);
  const { crossover } = JSON.parse(readFileSync(new URL(name, results)));
  /** The smallest size from which the GPU is faster at all larger sizes. */
  const from = (family, against) => {
    const sizes = crossover.filter((size) => size.family === family);
    const slower = sizes.filter((size) => size.gpu >= size[against]).map(({ edges }) => edges);
    const faster = sizes.map(({ edges }) => edges).filter((edges) => edges > Math.max(0, ...slower));
    // A square of n × n cells.
    const n = (Math.sqrt(1 + 3 * Math.min(...faster)) - 1) / 3;
    assert.ok(Number.isInteger(n));
    return `${(2 * n * n).toLocaleString('en')} triangles`;
  };
  const edgeflip = await sharedPage();
  const { page } = edgeflip;
  await page.evaluate(() => document.getElementById('paper').scrollIntoView());
  await page.waitForSelector('.paper-sizes');
  const rows = await page
    .locator('.paper-sizes tbody tr')
    .evaluateAll((all) => all.map((row) => [...row.cells].map(({ textContent }) => textContent)));
  assert.deepEqual(rows, [
    ['Many edges flip', from('random', 'cpu'), from('random', 'cores')],
    ['No edge flips', from('delaunay', 'cpu'), from('delaunay', 'cores')],
  ]);
  const reference = await page.locator('.paper-reference li').first().textContent();
  assert.match(
    reference,
    /Navarro.*Hitschfeld-Kahler.*Scheihing.*Edge-Flips\. Sent to .* in August 2010\. We follow the manuscript of 28 February 2011/,
  );
  await edgeflip.close();
});

/** Scrolls to the plots until they run: the page may still bring the section of the link to the top. */
async function showPlots(page) {
  await page.waitForFunction(() => {
    document.querySelector('.paper-pair')?.scrollIntoView();
    return document.querySelector('.paper-pair figcaption');
  });
}

test('the time of a small run is not that of the engine’s start', async () => {
  const address = await serve(fileURLToPath(new URL('../../target/www', import.meta.url)), site.preview.headers);
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  const SLOW = 3000;
  // The engine comes late.
  await page.route('**/edgeflip_bg-*.wasm', async (route) => {
    await pause(SLOW);
    await route.continue();
  });
  await page.goto(`${address}#paper`);
  await showPlots(page);
  const caption = page.locator('#paper figure[data-spec="strips 16"] figcaption', { hasText: 'iterations' });
  const [, ms] = (await caption.textContent({ timeout: 60_000 })).match(/ in ([\d.,]+) ms on this computer’s CPU\.$/);
  assert.ok(Number(ms.replace(',', '')) < SLOW / 2, ms);
  assert.deepEqual(problems, []);
  await page.close();
});

test('the plots have the flips of the package', async () => {
  const edgeflip = await sharedPage();
  const { page } = edgeflip;
  await page.evaluate(() => document.getElementById('paper').scrollIntoView());
  await showPlots(page);
  const figure = (spec) => page.locator(`#paper figure[data-spec="${spec}"]`);
  for (const [spec, nodes] of [
    ['uvsphere 600', 0],
    ['strips 16', 0],
    ['strips 8', 8],
    ['strips 12', 12],
  ]) {
    if (nodes) await page.click(`#paper [data-nodes="${nodes}"]`);
    const flips = await flipsOf(spec);
    const sum = flips.reduce((total, count) => total + count, 0).toLocaleString('en');
    const caption = figure(spec).locator('figcaption', { hasNotText: 'Running' });
    const text = await caption.textContent({ timeout: 90_000 });
    assert.ok(text.startsWith(`${sum} flips in ${flips.length} iterations, `), text);
    const drawn = await figure(spec).locator('.count').allTextContents();
    assert.deepEqual(
      drawn,
      flips.map((count) => count.toLocaleString('en')),
      spec,
    );
  }
  await edgeflip.close();
});
