// Tests lecture mode of the tool in Chromium: what is hidden, the type, the keys of a clicker, the link, and how it ends.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { pageForBeta, sharedPage } from './page.mjs';

const BUNNY = 'models/bunny.ply';
const TOOLS = ['.top', '#gallery', '.does', '#angles', '#details', '#explain'];
const WORDS = ['#caption', '#about', '#status', '#legend .row', '#bars svg text'];

const press = async ({ page }, key) => {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press(key);
};

const isLecture = ({ page }) => page.evaluate(() => document.body.hasAttribute('data-lecture'));

/** The sizes of type, in pixels. */
const sizes = ({ page }, selectors) =>
  page.evaluate(
    (all) => all.map((selector) => Number.parseFloat(getComputedStyle(document.querySelector(selector)).fontSize)),
    selectors,
  );

test('lecture mode hides the tools and enlarges the type', async () => {
  const page = await sharedPage(BUNNY);
  const before = await sizes(page, WORDS);
  await press(page, 'n');
  const [small] = await sizes(page, ['#inspect p']);
  await press(page, 'Escape');
  await press(page, 'h');
  for (const tool of TOOLS) assert.equal(await page.page.isVisible(tool), false, tool);
  for (const kept of ['#caption', '#legend', '#status', '#bars', '#play'])
    assert.ok(await page.page.isVisible(kept), kept);
  assert.deepEqual(
    await sizes(page, WORDS),
    before.map((size) => 1.5 * size),
  );
  for (const [width, height] of [
    [1280, 720],
    [1024, 768],
    [390, 844],
  ]) {
    await page.page.setViewportSize({ width, height });
    await press(page, 'n');
    assert.match(await page.page.textContent('#inspect header'), /^(Flips now|Waits|Kept)/);
    if (width === 1280) assert.deepEqual(await sizes(page, ['#inspect p']), [1.5 * small]);
    const over = await page.page.evaluate(() => {
      const side = document.querySelector('.side');
      return [document.documentElement.scrollWidth - innerWidth, side.scrollHeight - side.clientHeight];
    });
    assert.deepEqual(over, [0, 0], `${width} × ${height}: nothing is cut off`);
  }
  await page.page.setViewportSize({ width: 1280, height: 720 });
  await page.page.click('#end-lecture');
  assert.equal(await isLecture(page), false);
  await press(page, 'Escape');
  for (const tool of TOOLS) assert.ok(await page.page.isVisible(tool), tool);
  assert.deepEqual(await sizes(page, WORDS), before);
  await page.close();
});

test('in a lecture, arrows and a clicker step, a key explains an edge, and Escape ends it', async () => {
  const page = await sharedPage(BUNNY);
  const at = async (stop) => page.until(`iteration ${stop}`, (seen) => seen.at === stop && seen.measured === stop);
  await press(page, 'PageDown');
  await page.page.waitForTimeout(300);
  assert.equal((await page.rest()).at, '0', 'else the key is of the browser');
  await press(page, 'h');
  assert.equal(await page.page.evaluate(() => scrollY), 0);
  for (const [key, stop] of [
    ['PageDown', '1'],
    ['ArrowRight', '2'],
    ['PageUp', '1'],
    ['ArrowLeft', '0'],
  ]) {
    await press(page, key);
    await at(stop);
  }
  // A clicker works where the pointer was last, too.
  await page.page.focus('#slider');
  await page.page.keyboard.press('PageDown');
  await at('1');
  await press(page, 'n');
  assert.equal(await page.page.isVisible('#legend-section'), false, 'the edge takes the place of the legend');
  assert.match(await page.page.textContent('#inspect p'), /°|stays/);
  await press(page, 'Escape');
  assert.deepEqual([await isLecture(page), await page.page.isVisible('#inspect')], [true, false]);
  await press(page, 'Escape');
  assert.equal(await isLecture(page), false);
  await press(page, '?');
  assert.ok((await page.page.locator('#keys kbd').allTextContents()).includes('H'));
  await page.page.keyboard.press('Escape');
  await page.close();
});

test('a link opens lecture mode, and the copied link of a lecture does so too', async () => {
  const page = await pageForBeta();
  await page.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  const copied = async () => {
    await press(page, 'k');
    await page.page.waitForFunction(() => document.getElementById('notice').textContent.startsWith('Link copied'));
    return page.page.evaluate(() => navigator.clipboard.readText());
  };
  assert.doesNotMatch(await copied(), /lecture/);
  await page.follow('#watch?mesh=random+24&at=1&lecture');
  await page.until('iteration 1', ({ at, measured }) => at === '1' && measured === '1');
  assert.ok(await isLecture(page));
  const link = await copied();
  assert.match(link, /#watch\?mesh=random\+24&at=1.*&lecture$/);
  await page.follow('#watch?mesh=random+24&at=0');
  assert.equal(await isLecture(page), false);
  // A worker whose script is still on its way would count as a failed request.
  await page.page.waitForLoadState('networkidle');
  await page.page.goto('about:blank');
  await page.page.goto(link);
  await page.until('iteration 1', ({ at, measured }) => at === '1' && measured === '1');
  assert.ok(await isLecture(page));
  await page.close();
});
