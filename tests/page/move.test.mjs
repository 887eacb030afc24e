// Tests the meshes that move on the page in Chromium, on every engine: what is saved is Delaunay, points can be dragged,
// and a run takes their place again.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { FlipSession } from 'edgeflip';
import { MOVING } from '../../www/models/samples.js';
import { startChromium } from '../browsers.mjs';
import { full } from '../full.mjs';
import { assertSameMesh, expected, first, loseDevice, openEdgeflip, sharedPage } from './page.mjs';

const ENGINES = { webgpu: 'WebGPU', webgl2: 'WebGL2, in a worker', cpu: 'CPU, in a worker' };
/** What each engine moves in the short run; in the full run, each moves everything. */
const SHORT = { webgpu: 'sheet', webgl2: 'relax', cpu: 'waves' };
const BETAS = { sheet: 10, waves: 30, relax: 10 };

const moving = (page) => page.until('a mesh that moves', ({ state }) => state === 'moving');

/** Shows a mesh of about 2,000 triangles that moves. Then chooses the engine, which no other mesh has to wait for. */
async function show(page, kind, backend) {
  await page.page.evaluate(() => (document.getElementById('many').value = '2000'));
  await page.choose('sample', `moving ${kind}`);
  const shown = await moving(page);
  if (shown.backend === backend) return shown;
  await page.choose('backend', backend);
  return moving(page);
}

/** Pauses, and returns what is shown then. */
async function pauseAll(page) {
  await page.page.click('#play');
  return page.until('no edge left', ({ state, status }) => state === 'paused' && /^(Every|Paused)/.test(status));
}

/** The number of edges of a saved mesh that can flip, and that are kept. */
async function left({ positions, indices, dimension }, kind) {
  const mesh = { positions, indices, dimension };
  const session = await FlipSession.create(mesh, { backend: 'cpu', maxNormalAngle: BETAS[kind] });
  const { flips, remaining } = await session.run();
  session.free();
  return { flips, kept: Object.values(remaining).reduce((sum, count) => sum + count, 0) };
}

for (const [backend, engine] of Object.entries(ENGINES)) {
  test(`meshes move on ${backend}, and are Delaunay when they pause`, async () => {
    const page = await sharedPage();
    for (const { kind, name } of MOVING.filter(({ kind }) => kind in BETAS && (full || kind === SHORT[backend]))) {
      await show(page, kind, backend);
      assert.equal(await page.page.textContent('#caption'), name);
      const { facts } = await page.until(
        'flips in the frames',
        ({ facts, status }) => Number(facts['Flips a frame']) > 0 && /flips a frame, \d+ frames? a second/.test(status),
      );
      assert.equal(facts.Engine, engine);
      const one = await page.picture();
      await page.until(
        'another frame',
        ({ facts: next }) => next['From frame to frame'] !== facts['From frame to frame'],
      );
      // A slow machine draws few frames, between which little moves.
      const end = performance.now() + 60_000;
      while (one.differsFrom(await page.picture()) <= 0.01)
        assert.ok(performance.now() < end, `${kind}: the picture stays for 60 s`);
      const seen = await pauseAll(page);
      const mesh = await page.download();
      assert.equal(mesh.indices.length / 3, Number(facts.Triangles.replaceAll(',', '')));
      const { flips, kept } = await left(mesh, kind);
      assert.deepEqual([flips, `${kept}`], [0, seen.facts['Not Delaunay, and cannot flip']], kind);
      assert.equal(seen.facts['Left for the next frame'], '0');
      // A second picture of the same moment.
      assert.equal((await page.picture()).differsFrom(await page.picture()), 0, `${kind}: the picture moves`);
    }
    await page.close();
  });
}

/** Runs in the page: the frames of a mesh that moves flip no edges, so that a pause has something to flip. */
function withoutFlips() {
  const { postMessage } = Worker.prototype;
  const halt = (part) => {
    if (part === null || typeof part !== 'object' || ArrayBuffer.isView(part)) return;
    if (part.positions && 'iterations' in part) part.iterations = 0;
    else Object.values(part).forEach(halt);
  };
  Worker.prototype.postMessage = function (message, ...more) {
    halt(message);
    return postMessage.call(this, message, ...more);
  };
}

test('a pause flips what the frames have left', async () => {
  const page = await openEdgeflip(await startChromium(), withoutFlips);
  await show(page, 'sheet', 'cpu');
  await page.until('edges that are left', ({ facts }) => Number(facts['Left for the next frame']) > 0);
  const seen = await pauseAll(page);
  assert.equal(seen.facts['Left for the next frame'], '0');
  assert.equal((await left(await page.download(), 'sheet')).flips, 0);
  await page.close();
});

for (const backend of full ? Object.keys(ENGINES) : ['webgpu']) {
  test(`a point is dragged on ${backend}, and the mesh stays Delaunay`, async () => {
    const page = await sharedPage();
    await show(page, 'relax', backend);
    await pauseAll(page);
    const before = await page.download();
    const box = await (await page.page.$('#view')).boundingBox();
    const middle = await page.page.evaluate(() => {
      const side = document.querySelector('.side').getBoundingClientRect().left - 24;
      const gallery = document.getElementById('gallery').getBoundingClientRect().right + 16;
      return (side + gallery) / 2;
    });
    const y = box.y + box.height * 0.45;
    await page.page.mouse.move(middle, y);
    await page.page.mouse.down();
    for (let i = 1; i <= 10; i++) {
      await page.page.mouse.move(middle + 6 * i, y);
      await page.page.waitForTimeout(100);
    }
    await page.page.mouse.up();
    // The page follows the pointer as fast as it can draw. Then the longest way leads to the right.
    const end = performance.now() + 60_000;
    for (;;) {
      const after = await page.download();
      const ways = Array.from({ length: before.positions.length / 2 }, (_, v) =>
        [0, 1].map((k) => after.positions[2 * v + k] - before.positions[2 * v + k]),
      );
      const [longest] = ways.sort(([ax, ay], [bx, by]) => Math.hypot(bx, by) - Math.hypot(ax, ay));
      const { flips } = await left(after, 'relax');
      if (longest[0] > 0.05 && flips === 0) break;
      assert.ok(performance.now() < end, `after 60 s the longest way is ${longest}, and ${flips} edges can flip`);
      await page.page.waitForTimeout(200);
    }
    await page.close();
  });
}

test('a link opens a mesh that moves, and a run takes its place', async () => {
  const page = await openEdgeflip(await startChromium());
  await page.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  const clipboard = () => page.page.evaluate(() => navigator.clipboard.readText());
  await show(page, 'waves', 'cpu');
  await page.page.click('#take');
  await page.page.click('#link');
  await page.page.locator('#away-says', { hasText: 'Link copied' }).waitFor();
  const link = await clipboard();
  await page.page.click('#code');
  await page.page.locator('#away-says', { hasText: 'Code copied' }).waitFor();
  const code = (await clipboard()).replace(/^import.*$/gm, '');
  const { generate } = await import('edgeflip/files');
  const run = new Function('FlipSession', 'generate', `return (async () => { ${code} return triangles; })()`);
  assert.equal((await run(FlipSession, generate)).length, 3 * 2048);
  await page.page.keyboard.press('Escape');

  await page.choose('sample', 'models/bunny.ply');
  const seen = await page.rest();
  const want = await expected(first.path, first.maxNormalAngle);
  assert.equal(seen.facts.Fingerprint, want.fingerprints[0]);
  assert.equal(await page.page.isVisible('#bars'), true);
  assertSameMesh(await page.download(), want.mesh, 'of the bunny');

  await page.page.goto('about:blank');
  await page.page.goto(link);
  await moving(page);
  assert.equal(await page.page.textContent('#caption'), 'A sphere with waves');
  assert.equal(await page.page.isVisible('#bars'), false);
  await page.close();
});

test('with reduced motion, a mesh moves only when it is played', async () => {
  const page = await sharedPage();
  await page.page.emulateMedia({ reducedMotion: 'reduce' });
  await page.choose('sample', 'moving sheet');
  await page.until('a still', ({ state, facts }) => state === 'paused' && facts.Triangles === '19,602');
  await page.page.evaluate(() => document.activeElement.blur());
  await page.page.keyboard.press('Space');
  await moving(page);
  await page.page.emulateMedia({ reducedMotion: null });
  await page.close();
});

test('a mesh that moves begins again after the GPU was lost', async () => {
  const page = await sharedPage();
  await show(page, 'sheet', 'webgpu');
  await loseDevice(page);
  const { error } = await page.until('a message', ({ error, state }) => error !== '' && state === 'moving');
  assert.match(error, /The GPU was lost \(.*\)\. The mesh began again\./);
  const { facts } = await page.until('frames', ({ facts }) => Number(facts['Flips a frame']) > 0);
  assert.equal(facts.Engine, 'WebGPU');
  await page.close();
});
