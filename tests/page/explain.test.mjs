// Tests the figures of the section "How a mesh becomes Delaunay" in Chromium. Serves the existing target/www.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { EDGE_STATES, FlipSession } from 'edgeflip';
import site from '../../www/vite.config.js';
import { closeAll, openPage, serve, startChromium } from '../browsers.mjs';
import { assertSelected, drawn, edgesOf, enginesRounds, hashOf, key, LESSON, meshIn, openAt } from './lesson.mjs';

after(closeAll);

let shared;

/** The page with the section, which all tests share. Each uses figures of its own, or the places where it finds them. */
async function openPageOnce() {
  const address = await serve(fileURLToPath(new URL('../../target/www', import.meta.url)), site.preview.headers);
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  // The first view, above the section, stands still too.
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await page.goto(`${address}#explain`);
  await page.locator('.explain-figures .explain-handle').nth(4).waitFor();
  return { page, problems };
}

/** Opens the section. `figure(n)` has what is in small figure `n`, from 1. */
async function openSection() {
  shared ??= openPageOnce();
  const { page, problems } = await shared;
  const figure = (number) => {
    const element = page.locator('.explain-figures .explain-figure').nth(number - 1);
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

test('the arrow keys move handles', async () => {
  const { figure, problems } = await openSection();
  const { handle, places } = figure(1);
  const [[x, y]] = await places();
  await handle(0).press('ArrowLeft');
  await handle(0).press('Shift+ArrowDown');
  assert.deepEqual(await places(), [[x - 6, y + 1]]);
  assert.deepEqual(problems, []);
});

test('a figure that loops stands still with reduced motion, and plays when asked', async () => {
  const { figure, problems } = await openSection();
  const { button, caption, says } = figure(3);
  assert.equal(await caption(), 'A ridge: this edge is not Delaunay');
  await button.click();
  await says('A valley: the surface has sunk');
  assert.deepEqual(problems, []);
});

test('the first figure scrambles, the engine heals, and the numbers follow', async () => {
  const { page, problems } = await openSection();
  const slider = page.locator('#why-scramble');
  const at = async (flips) => {
    await slider.fill(`${flips}`);
    await page.locator('.why-says', { hasText: new RegExp(`^${flips} flips`) }).waitFor();
    const texts = await page.locator('.why-number').allTextContents();
    return texts.map((text) => Number(text.match(/[\d.]+/)[0]));
  };
  const few = await at(0);
  const [angle, best, ...errors] = few;
  assert.equal(angle, best);
  for (let i = 0; i < errors.length; i += 2) assert.equal(errors[i], errors[i + 1]);
  const many = await at(600);
  assert.ok(many[0] < best);
  for (let i = 2; i < many.length; i += 2) {
    assert.ok(many[i] > 1.2 * many[i + 1], `${many}`);
    assert.equal(many[i + 1], few[i + 1], 'edgeflip makes the same triangles of both');
  }
  assert.match(await page.locator('.why-says').textContent(), /healed by \d+ flips in \d+ iterations$/);
  assert.deepEqual(problems, []);
});

/** The playground of a new page. */
async function openPlayground(hash) {
  const { page, problems } = await openAt(await startChromium(), hash);
  const part = (name) => page.locator('.playground').getByRole('button', { name, exact: true });
  const press = (name) => part(name).click();
  /** Clicks at a place in the units of the drawing. */
  const clickAt = async ([x, y]) => {
    const drawing = page.locator('.playground-drawing');
    const { width } = await drawing.boundingBox();
    await drawing.click({ position: { x: (x * width) / 640, y: (y * width) / 640 } });
  };
  /** The address, once it has what was done. */
  const address = async (has) => {
    await page.waitForURL((url) => has.test(url.hash));
    return page.url();
  };
  const says = (text) => page.locator('.playground-says', { hasText: text }).waitFor();
  return { page, problems, part, press, clickAt, address, says };
}

test('a lesson: eight points, two rounds phase by phase, an edge explained, and the link opens in the same state', async () => {
  const { page, problems, part, press, clickAt, address } = await openPlayground('#explain');
  await press('Clear');
  for (const point of LESSON.points) await clickAt(point);
  const mesh = meshIn(await address(/points=.{32}&/));
  for (const [i, [x, y]] of mesh.points.entries()) {
    assert.ok(Math.hypot(x - LESSON.points[i][0], y - LESSON.points[i][1]) < 2, `${x}, ${y}`);
  }
  const rounds = await enginesRounds(mesh);
  for (const [round, { states }] of rounds.slice(0, 2).entries()) {
    await press('Label');
    const { kinds, labels } = await drawn(page);
    const candidates = [...(states.flips ?? []), ...(states.waits ?? [])].sort();
    assert.deepEqual(kinds.candidate, candidates);
    assert.equal(labels.length, candidates.length);
    await press('Select');
    await assertSelected(page, mesh, round);
    await press('Flip');
    const flipped = await drawn(page);
    assert.equal(flipped.kinds.fresh.length, states.flips.length);
    assert.deepEqual(edgesOf(flipped.kinds), edgesOf(rounds[round + 1].states));
    await press('Update');
    const updated = await drawn(page);
    assert.deepEqual([updated.stop, updated.kinds.fresh], [['Update'], undefined]);
    assert.ok(updated.arrows > 0);
  }
  await press('Select');
  const [[a, b]] = rounds[2].states.flips.map((edge) => edge.split('-').map(Number));
  const middle = [0, 1].map((axis) => (mesh.points[a][axis] + mesh.points[b][axis]) / 2);
  await clickAt(middle);
  const shown = await assertSelected(page, mesh, 2);
  assert.match(shown.why.join(), /^[\d.]+° \+ [\d.]+° is [\d.]+°, more than 180°\. .* flips in this round\.$/);
  const link = await address(/at=2\.select&edge=/);
  assert.equal(key(...meshIn(link).edge.split('-')), key(a, b));
  // It goes back by a phase, and on.
  await press('Back');
  assert.deepEqual((await drawn(page)).stop, ['Label']);
  await part('Label').press('ArrowRight');
  assert.deepEqual(await drawn(page), shown);
  await page.close();

  const other = await openPlayground(link.slice(link.indexOf('#')));
  assert.deepEqual(await drawn(other.page), shown);
  const top = await other.page.locator('.playground').evaluate((element) => element.getBoundingClientRect().top);
  assert.ok(top > -20 && top < 400, `the playground is in view: ${top}`);
  // Another link in the same page.
  await other.page.evaluate((hash) => (location.hash = hash), hashOf({ ...LESSON, at: '0.select' }));
  await other.page.locator('.playground-why').waitFor({ state: 'hidden' });
  await assertSelected(other.page, LESSON, 0);
  await other.page.close();
  assert.deepEqual([...problems, ...other.problems], []);
});

test('points are added, moved and removed by keys, and a link with wrong triangles joins them anew', async () => {
  // biome-ignore format: one row
  const mesh = { points: [[100, 440], [500, 445], [320, 400], [300, 100]], triangles: [0, 1, 2] };
  const { page, problems, part, press } = await openPlayground(hashOf(mesh));
  const count = async () => (await drawn(page)).points.length;
  assert.equal(edgesOf((await drawn(page)).kinds).length, 6);
  await press('Add a point');
  const handle = (i) => page.locator('.playground .explain-handle').nth(i);
  assert.equal(await handle(4).evaluate((element) => element === document.activeElement), true);
  const [x, y] = (await drawn(page)).points[4];
  await handle(4).press('ArrowLeft');
  await handle(4).press('Shift+ArrowDown');
  assert.deepEqual((await drawn(page)).points[4], [x - 6, y + 1]);
  await handle(4).press('Delete');
  assert.equal(await count(), 4);
  await press('Remove the point');
  assert.equal(await count(), 3);
  for (let i = 0; i < 12; i++) await handle(2).press('ArrowDown');
  const moved = await drawn(page);
  assert.equal(moved.points[2][1], 466);
  assert.deepEqual(moved.kinds, { boundary: ['0-1', '0-2', '1-2'] });
  await press('Start again');
  await press('Explain an edge');
  assert.match((await drawn(page)).why.join(), /more than 180°/);
  for (let rounds = 0; (await part('Round').getAttribute('aria-disabled')) !== 'true'; rounds++) {
    assert.ok(rounds < 10);
    await press('Round');
  }
  const stop = page.locator('.playground-stop');
  assert.match((await drawn(page)).caption, /^Delaunay: no edge can flip\. After \d rounds: \d+ flips$/);
  assert.match(await stop.textContent(), /^Delaunay No edge can flip/);
  await press('Label');
  assert.match((await drawn(page)).caption, /^Delaunay: no edge can flip$/);
  await press('Clear');
  assert.equal((await drawn(page)).caption, 'Set three points to make a triangle');
  assert.match(await stop.textContent(), /^No triangle yet/);
  await press('Start again');
  assert.match(await stop.textContent(), /^Points, joined somehow/);
  await press('Label');
  const covered = await page.evaluate(() => {
    const boxes = (part) =>
      [...document.querySelectorAll(`.playground ${part}`)].map((element) => element.getBoundingClientRect());
    return boxes('.playground-labels text').map(
      (text) =>
        boxes('.explain-handle .explain-knob').filter(
          (point) =>
            point.left < text.right && text.left < point.right && point.top < text.bottom && text.top < point.bottom,
        ).length,
    );
  });
  assert.ok(covered.length > 4 && covered.every((points) => points === 0), `points under labels: ${covered}`);
  await page.close();
  assert.deepEqual(problems, []);
});

test('a point that is dragged over an edge is joined anew, and the page says so', async () => {
  const { page, problems, says } = await openPlayground(
    hashOf({
      points: [
        [100, 100],
        [500, 120],
        [300, 400],
        [300, 200],
      ],
    }),
  );
  const handle = page.locator('.playground .explain-handle').nth(3);
  await dragBy(page, handle, 0, 60);
  const before = await drawn(page);
  assert.equal(edgesOf(before.kinds).length, 6);
  assert.ok(before.points[3][1] > 220);
  await dragBy(page, handle, 250, 0);
  await says('joined anew');
  const after = await drawn(page);
  assert.ok(after.kinds.boundary.length === 4 && edgesOf(after.kinds).length === 5, JSON.stringify(after.kinds));
  await page.close();
  assert.deepEqual(problems, []);
});
