// Tests the figures of the section "How a mesh becomes Delaunay" in Chromium. Serves the existing target/www.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { EDGE_STATES, FlipSession } from 'edgeflip';
import site from '../../www/vite.config.js';
import { closeAll, openPage, serve, startChromium } from '../browsers.mjs';

after(closeAll);

let shared;

/** The page with the section, which all tests share. Each uses figures of its own, or the places where it finds them. */
async function openPageOnce() {
  const address = await serve(fileURLToPath(new URL('../../target/www', import.meta.url)), site.preview.headers);
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  // The first view, above the section, stands still too.
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await page.goto(`${address}#explain`);
  await page.locator('.explain-handle').nth(5).waitFor();
  return { page, problems };
}

/** Opens the section. `figure(n)` has what is in figure `n`, from 1. */
async function openSection() {
  shared ??= openPageOnce();
  const { page, problems } = await shared;
  const figure = (number) => {
    const element = page.locator('.explain-figure').nth(number - 1);
    return {
      handle: (index) => element.locator('.explain-handle').nth(index),
      button: element.locator('.explain-play'),
      caption: () => element.locator('.explain-caption').textContent(),
      // Three rounds last longer than 30 s where frames are slow: a frame moves the figure by at most 100 ms.
      says: (text) => element.locator('.explain-caption', { hasText: text }).waitFor({ timeout: 90_000 }),
      texts: () => element.locator('svg text').allTextContents(),
      count: (state) => element.locator(`.explain-bold.explain-${state}`).count(),
      /** The places of the handles, in the units of the drawing. */
      places: async () =>
        [...(await element.innerHTML()).matchAll(/translate\(([^)]*)/g)].map(([, at]) => at.split(',').map(Number)),
    };
  };
  return { page, figure, problems };
}

/** The angle at a corner in degrees, to one decimal. */
function angle([x, y], [ax, ay], [bx, by]) {
  const cosine = ((ax - x) * (bx - x) + (ay - y) * (by - y)) / Math.hypot(ax - x, ay - y) / Math.hypot(bx - x, by - y);
  return Math.round((1800 / Math.PI) * Math.acos(cosine)) / 10;
}

/** Drags a handle by pixels. */
async function dragBy(page, handle, x, y) {
  await handle.locator('.explain-knob').last().hover();
  const { x: left, y: top, width } = await handle.locator('.explain-knob').last().boundingBox();
  await page.mouse.down();
  await page.mouse.move(left + width / 2 + x, top + width / 2 + y, { steps: 5 });
  await page.mouse.up();
}

test('a point that is dragged into the circle makes the triangle not Delaunay', async () => {
  const { page, figure, problems } = await openSection();
  const { handle, says } = figure(1);
  await dragBy(page, handle(0), -80, 0);
  await says('A point is inside');
  await dragBy(page, handle(0), 80, 0);
  await says('The circle is empty');
  assert.deepEqual(problems, []);
});

test('the two angles are right, and the engine decides', async () => {
  const { page, figure, problems } = await openSection();
  const { handle, places, says, caption, texts } = figure(2);
  const check = async () => {
    const points = await places();
    const [upper, lower] = [points[2], points[3]].map((corner) => angle(corner, points[0], points[1]));
    const shown = [upper, lower, upper + lower].map((degrees) => `${degrees.toFixed(1)}°`);
    assert.deepEqual(await texts(), shown);
    const mesh = { positions: Float64Array.from(points.flat()), indices: [0, 1, 2, 1, 0, 3], dimension: 2 };
    const session = await FlipSession.create(mesh, { backend: 'cpu' });
    const state = EDGE_STATES[(await session.edgeStates())[0]];
    session.free();
    assert.match(await caption(), state === 'flips' ? /flips$/ : /stays$/);
  };
  await says('the edge flips');
  await check();
  await dragBy(page, handle(0), 80, 0);
  await dragBy(page, handle(1), -80, 0);
  await says('the edge stays');
  await check();
  assert.deepEqual(problems, []);
});

test('the arrow keys move handles, and turn the edge', async () => {
  const { page, figure, problems } = await openSection();
  const { handle, places } = figure(1);
  const [[x, y]] = await places();
  await handle(0).press('ArrowLeft');
  await handle(0).press('Shift+ArrowDown');
  assert.deepEqual(await places(), [[x - 6, y + 1]]);
  const turning = figure(4);
  await turning.handle(0).press('ArrowRight');
  await turning.says('After: triangles');
  await dragBy(page, turning.handle(0), 80, -70);
  await turning.says('Before: triangles');
  assert.deepEqual(problems, []);
});

test('figures that loop stand still with reduced motion, and play when asked', async () => {
  const { figure, problems } = await openSection();
  const { button, caption, says, count } = figure(3);
  assert.equal(await caption(), 'Round 1: 2 edges flip, 2 wait');
  assert.deepEqual([await count('flips'), await count('waits')], [2, 2]);
  await button.click();
  await says('Round 2: 2 edges flip');
  assert.deepEqual([await count('flips'), await count('waits')], [2, 0]);
  await says('After 3 rounds: every edge is Delaunay');
  assert.deepEqual([await count('flips'), await count('waits')], [0, 0]);
  assert.deepEqual(problems, []);
});
