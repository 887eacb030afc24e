// Tests the tool on small screens, and what lies on what: nothing is wider than the page, the timeline and Play stay on
// the screen, a sheet closes the gallery, and Escape closes only what is on top.
// The picture of the mesh may get another size at any time.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { openPage, startChromium, twoFrames } from '../browsers.mjs';
import { file, sharedPage } from './page.mjs';
import { Picture } from './picture.mjs';

const BUNNY = 'models/bunny.ply';

const press = async ({ page }, ...keys) => {
  await page.evaluate(() => document.activeElement.blur());
  for (const key of keys) await page.keyboard.press(key);
};

async function resize({ page }, width, height) {
  await page.setViewportSize({ width, height });
  await twoFrames(page);
}

/** What is wider than the page, or beside it. */
const tooWide = ({ page }) =>
  page.evaluate(() => {
    const { scrollWidth } = document.scrollingElement;
    const found = scrollWidth > innerWidth ? [`the page: ${scrollWidth}`] : [];
    // The gallery scrolls sideways.
    for (const part of document.querySelectorAll('#watch *, .top *, #keys, #keys *')) {
      if (
        part.closest('svg, #gallery') ||
        part.matches('.unseen') ||
        !part.checkVisibility({ visibilityProperty: true })
      )
        continue;
      const { left, right, width } = part.getBoundingClientRect();
      const name = `${part.tagName} ${part.id || part.className}`;
      if (width > 0 && (left < -0.5 || right > innerWidth + 0.5)) found.push(`${name}: ${left} to ${right}`);
    }
    return found;
  });

/** The named parts that are not wholly on the screen. */
const offScreen = ({ page }, ...selectors) =>
  page.evaluate(
    (names) =>
      names.filter((name) => {
        const { left, top, right, bottom } = document.querySelector(name).getBoundingClientRect();
        return left < 0 || top < 0 || right > innerWidth + 0.5 || bottom > innerHeight + 0.5;
      }),
    selectors,
  );

const isOpen = ({ page }, id) =>
  page.evaluate((name) => document.getElementById(name).matches(':popover-open, [open]'), id);

const isShown = ({ page }, id) => page.evaluate((name) => !document.getElementById(name).hidden, id);

test('nothing is wider than the page on a narrow screen, whatever is open', async () => {
  const page = await sharedPage(BUNNY);
  const close = () => press(page, 'Escape');
  const show = (id, isOn) =>
    page.page.evaluate(([name, on]) => (document.getElementById(name).hidden = !on), [id, isOn]);
  const found = {};
  for (const width of [320, 360, 390]) {
    await resize(page, width, 844);
    const look = async (what) => {
      const wide = await tooWide(page);
      if (wide.length > 0) found[`${what} at ${width}`] = wide;
    };
    await look('the tool');
    for (const [key, what] of [
      ['n', 'an edge'],
      ['c', 'before and now'],
      ['l', 'limits'],
      ['s', 'take away'],
      ['?', 'keys'],
    ]) {
      await press(page, key);
      await look(what);
      await close();
    }
    await page.page.click('#choose');
    await look('the gallery');
    await close();
    await show('busy', true);
    await look('busy');
    await show('busy', false);
    await page.page.setInputFiles('#file', file(`${'a-long-name-'.repeat(8)}.off`, 'OFF\n3 1 0\n0 0 zero\n'));
    await page.until('a message', ({ error, state }) => error !== '' && state !== 'busy');
    await look('an error');
    await page.page.click('#dismiss');
  }
  await page.page.evaluate(() => document.querySelector('[data-spec="moving sheet"]').click());
  await page.until('a mesh that moves', ({ state }) => state === 'moving');
  for (const width of [320, 360, 390]) {
    await resize(page, width, 844);
    const wide = await tooWide(page);
    if (wide.length > 0) found[`a mesh that moves at ${width}`] = wide;
  }
  assert.deepEqual(found, {});
  await page.page.setViewportSize({ width: 1280, height: 720 });
  await page.close();
});

test('the timeline and Play stay on the screen while an edge is inspected, and all of the inspector is in view', async () => {
  const page = await sharedPage(BUNNY);
  const found = {};
  for (const [width, height] of [
    [390, 844],
    [768, 1024],
    [820, 1180],
    [1024, 768],
    [1024, 600],
    [1440, 700],
    // A phone on its side, and 1440 × 900 at 200 %.
    [844, 390],
    [720, 450],
    // 1366 × 768 at 150 %.
    [911, 512],
  ]) {
    await resize(page, width, height);
    await press(page, 'n');
    const off = await offScreen(page, '#play', '#bars', '#status', '#step', '#take', '#compare', '#inspect');
    // What scrolls may cut it off.
    const covered = await page.page.evaluate(() => {
      const { left, right, bottom } = document.querySelector('#inspect > p').getBoundingClientRect();
      return !document.elementFromPoint((left + right) / 2, bottom - 3)?.closest('#inspect');
    });
    if (covered) off.push('the sentence');
    const { height: stage } = await (await page.page.$('#stage')).boundingBox();
    if (stage < 180) off.push(`the mesh: ${stage} pixels`);
    if (off.length > 0) found[`${width} × ${height}`] = off;
    await press(page, 'Escape');
  }
  assert.deepEqual(found, {});
  // With a finger, there is no Escape.
  await resize(page, 390, 844);
  await press(page, 'n');
  assert.equal(await isShown(page, 'inspect'), true);
  await page.page.click('#inspect .close');
  assert.equal(await isShown(page, 'inspect'), false);
  await page.page.setViewportSize({ width: 1280, height: 720 });
  await page.close();
});

test('a sheet closes the gallery, and Escape closes only what is on top', async () => {
  const page = await sharedPage(BUNNY);
  await resize(page, 390, 844);
  const openGallery = async () => {
    await page.page.click('#choose');
    assert.equal(await isOpen(page, 'gallery'), true);
  };
  for (const [open, id] of [
    [() => press(page, 'l'), 'limits'],
    [() => press(page, 's'), 'away'],
    [() => press(page, '?'), 'keys'],
    [() => page.page.click('#menu'), 'sections'],
  ]) {
    await openGallery();
    await open();
    assert.deepEqual([await isOpen(page, id), await isOpen(page, 'gallery')], [true, false], id);
    await page.page.keyboard.press('Escape');
    assert.equal(await isOpen(page, id), false, id);
  }
  await openGallery();
  await page.page.keyboard.press('Escape');
  assert.equal(await isOpen(page, 'gallery'), false);
  await openGallery();
  await page.choose('sample', 'roof 16');
  await page.until('the sample', ({ caption, state }) => caption === 'roof 16' && state !== 'busy');
  assert.equal(await isOpen(page, 'gallery'), false);
  await page.rest();

  // From below: before and now, the inspector, a sheet, a message.
  const layers = async () => [
    await isShown(page, 'error'),
    await isOpen(page, 'limits'),
    await isShown(page, 'inspect'),
    await isShown(page, 'halves'),
  ];
  await press(page, 'c');
  await page.page.waitForSelector('#halves:not([hidden])');
  await press(page, 'n', 'l');
  assert.deepEqual(await layers(), [false, true, true, true]);
  await press(page, 'Escape');
  assert.deepEqual(await layers(), [false, false, true, true]);
  await page.page.evaluate(() => (document.getElementById('error').hidden = false));
  await press(page, 'Escape');
  assert.deepEqual(await layers(), [false, false, true, true]);
  await press(page, 'Escape');
  assert.deepEqual(await layers(), [false, false, false, true]);
  await press(page, 'Escape');
  assert.deepEqual(await layers(), [false, false, false, false]);
  await page.page.setViewportSize({ width: 1280, height: 720 });
  await page.close();
});

test('the list of keys begins at its top and has its button in view on a low screen', async () => {
  const page = await sharedPage();
  await resize(page, 720, 400);
  await press(page, '?');
  assert.deepEqual(await offScreen(page, '#keys h2', '#keys button'), []);
  await page.page.keyboard.press('Escape');
  await page.page.setViewportSize({ width: 1280, height: 720 });
  await page.close();
});

test('details that open below the screen are scrolled into view', async () => {
  const page = await sharedPage(BUNNY);
  await resize(page, 1024, 600);
  await page.page.click('#details summary');
  await page.page.waitForFunction(() => {
    const side = document.querySelector('.side').getBoundingClientRect();
    return document.querySelector('[data-fact=Vertices]')?.getBoundingClientRect().bottom <= side.bottom;
  });
  await page.page.setViewportSize({ width: 1280, height: 720 });
  await page.close();
});

test('lines are drawn without a copy of the picture, also right after the view got another size', async () => {
  const page = await sharedPage();
  await page.page.evaluate(() => {
    const { beginRenderPass, copyTextureToTexture } = GPUCommandEncoder.prototype;
    window.calls = { passes: 0, copies: 0 };
    Object.assign(GPUCommandEncoder.prototype, {
      beginRenderPass(...args) {
        window.calls.passes++;
        return beginRenderPass.apply(this, args);
      },
      copyTextureToTexture(...args) {
        window.calls.copies++;
        return copyTextureToTexture.apply(this, args);
      },
    });
    window.restore = () => Object.assign(GPUCommandEncoder.prototype, { beginRenderPass, copyTextureToTexture });
  });
  // Edges that have flipped are drawn too.
  await press(page, 'ArrowRight');
  for (const height of ['60%', '70%', '60%', '']) {
    await page.page.evaluate((to) => (document.getElementById('view').style.height = to), height);
    // The page draws, and then the view gets its size, in the same frame.
    await twoFrames(page.page);
  }
  await page.rest();
  const { passes, copies } = await page.page.evaluate(() => {
    window.restore();
    return window.calls;
  });
  assert.ok(passes >= 4, `${passes} pictures`);
  assert.equal(copies, 0);
  // Errors of the GPU would be on the console.
  await page.close();
});

for (const colorScheme of ['light', 'dark']) {
  test(`each row of the paper’s table has its line, also under the column that stays, in ${colorScheme}`, async () => {
    const tool = await sharedPage();
    const [address] = tool.page.url().split('#');
    await tool.close();
    const browser = await startChromium();
    const { page } = await openPage(
      { newPage: () => browser.newPage({ colorScheme, viewport: { width: 390, height: 844 } }) },
      `${address}#paper`,
    );
    await page.waitForSelector('.paper-table tbody tr');
    const rows = await page.evaluate(() => {
      const box = document.querySelector('.paper-table');
      box.scrollIntoView({ block: 'center' });
      box.scrollLeft = 120;
      document.querySelector('.top').hidden = true;
      return Array.from(box.querySelectorAll('tr'), (row) => row.getBoundingClientRect().bottom);
    });
    const { width, pixels } = new Picture(await page.screenshot());
    const at = (x, y) => pixels[width * y + x];
    const ground = at(4, 400);
    // A line is a pixel, rounded up or down.
    const without = (x) =>
      rows.filter((bottom) => [-2, -1, 0].every((by) => at(x, Math.round(bottom) + by) === ground));
    assert.ok(rows.length > 8);
    assert.deepEqual([without(24), without(160)], [[], []]);
    // The note under it is in view as a whole.
    const note = await page.locator('.paper-table caption span').boundingBox();
    assert.ok(note.x >= 0 && note.x + note.width <= 390, JSON.stringify(note));
    await page.close();
  });
}
