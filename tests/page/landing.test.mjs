// Tests where a link to a section leads: the top of the section is at the top of the view, also after the sections above
// have been loaded, and a visitor who scrolls is left alone. It reads target/www.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { setTimeout as pause } from 'node:timers/promises';
import { fileURLToPath } from 'node:url';
import site from '../../www/vite.config.js';
import { openPage, serve, startChromium, twoFrames } from '../browsers.mjs';
import { EdgeflipPage } from './page.mjs';

/** Opens the page, and loads the tool only if it is asked for. */
async function openFirst([width, height], hash = '') {
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  await page.addInitScript(() => (window.requestIdleCallback = () => 0));
  await page.emulateMedia({ reducedMotion: 'reduce' });
  await page.setViewportSize({ width, height });
  const address = await serve(fileURLToPath(new URL('../../target/www', import.meta.url)), site.preview.headers);
  await page.goto(`${address}${hash}`);
  return new EdgeflipPage(page, problems);
}

/** Follows a link in the bar. On a narrow screen, the bar is a menu. */
async function choose({ page }, section) {
  if (await page.isVisible('#menu')) await page.click('#menu');
  await page.click(`.top nav a[href="#${section}"]`);
}

/** Waits until the sections are there that were loaded, and the page has kept its height for half a second. */
async function settle({ page }, section) {
  await page.waitForSelector(`#${section} h2`);
  for (let [height, since] = [0, performance.now()]; performance.now() - since < 500; await pause(50)) {
    const now = await page.evaluate(() => document.documentElement.scrollHeight);
    if (now !== height) [height, since] = [now, performance.now()];
  }
}

/** How far below the top of the view a section begins. */
const topOf = ({ page }, section) =>
  page.evaluate((id) => document.getElementById(id).getBoundingClientRect().top, section);

for (const [width, height, anchors] of [
  [1440, 900, true],
  [1440, 900, false],
  [390, 844, false],
]) {
  const where = anchors ? '' : ' in a browser that does not anchor its scrolling, as Safari';
  test(`a link to a section leads to its top, ${width} wide${where}`, async () => {
    const first = await openFirst([width, height]);
    if (!anchors) await first.page.evaluate(() => (document.documentElement.style.overflowAnchor = 'none'));
    await first.page.waitForSelector('#live:not([hidden])');
    const tops = {};
    for (const section of ['explain', 'package', 'engines', 'package', 'paper']) {
      await choose(first, section);
      await settle(first, section);
      tops[`${Object.keys(tops).length} ${section}`] = Math.abs(await topOf(first, section)) < 3;
      if (section === 'package') {
        assert.equal(new URL(first.page.url()).hash, '#package');
        // The key Tab goes on from the section.
        await first.page.keyboard.press('Tab');
        assert.ok(await first.page.evaluate(() => document.getElementById('package').contains(document.activeElement)));
        await first.page.evaluate(() => document.activeElement.blur());
      }
    }
    assert.ok(Object.values(tops).every(Boolean), JSON.stringify(tops));
    await first.close();
  });
}

test('an address with a section leads to its top, and a visitor who scrolls is left alone', async () => {
  const first = await openFirst([1440, 900], '#paper');
  const { page } = first;
  await settle(first, 'paper');
  assert.ok(Math.abs(await topOf(first, 'paper')) < 3, `${await topOf(first, 'paper')}`);
  // What comes late above the section moves nothing.
  const grow = async (pixels) => {
    await page.evaluate((height) => {
      document.querySelector('#explain .wrap').style.paddingTop = `${height}px`;
    }, pixels);
    await twoFrames(page);
  };
  await grow(700);
  assert.ok(Math.abs(await topOf(first, 'paper')) < 3, `${await topOf(first, 'paper')}`);
  await page.mouse.move(700, 400);
  await page.mouse.wheel(0, 250);
  await page.waitForFunction(() => document.getElementById('paper').getBoundingClientRect().top < -200);
  await settle(first, 'paper');
  const scrolled = await topOf(first, 'paper');
  await page.evaluate(() => (document.querySelector('#package .wrap').style.paddingTop = '500px'));
  await grow(0);
  await settle(first, 'paper');
  assert.ok(Math.abs((await topOf(first, 'paper')) - scrolled) < 3, `${scrolled}, ${await topOf(first, 'paper')}`);
  await first.close();
});

test('the bar lies over the tool when the page is scrolled', async () => {
  const first = await openFirst([1440, 900], '#watch');
  await first.rest();
  const covered = await first.page.evaluate(async () => {
    const parts = [...document.querySelectorAll('#watch .time, #watch .side, #gallery')];
    const seen = [];
    for (const part of parts) {
      scrollTo({ top: scrollY + part.getBoundingClientRect().bottom - 40, behavior: 'instant' });
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      for (let x = 8; x < innerWidth; x += 40)
        if (!document.elementFromPoint(x, 32).closest('.top')) seen.push(`${part.id || part.className} at ${x}`);
    }
    return seen;
  });
  assert.deepEqual(covered, []);
  await first.close();
});
