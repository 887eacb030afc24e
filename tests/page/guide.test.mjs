// Tests the guide of a first visit in Chromium.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { openPage, startChromium } from '../browsers.mjs';
import { EdgeflipPage, sharedPage } from './page.mjs';

/** Opens the first view, and follows "Watch it work". */
async function arrive(page, address) {
  await page.page.goto('about:blank');
  await page.page.goto(address);
  await page.page.click('.way.first');
  await page.rest();
}

/** A new page, and the address of the first view. */
async function newPage(...scripts) {
  const tool = await sharedPage();
  const [address] = tool.page.url().split('#');
  await tool.close();
  const { page, problems } = await openPage(await startChromium(), 'about:blank');
  for (const script of scripts) await page.addInitScript(script);
  return { page: new EdgeflipPage(page, problems), address };
}

const isShown = ({ page }) => page.isVisible('#guide:not(:empty)');

test('the guide explains an edge that flips, plays once, and ends at a click; it comes once a visit', async () => {
  const { page, address } = await newPage();
  await arrive(page, address);
  await page.page.waitForSelector('#guide:not(:empty)');
  assert.equal(await page.page.textContent('#guide'), 'Click any edge to ask why.');
  assert.match(await page.page.textContent('#inspect header'), /^Flips now/);
  assert.equal((await page.look()).at, '0');
  await page.choose('speed', '0');
  const end = await page.until('the end', ({ state, at, measured }) => state === 'done' && measured === at);
  assert.match(end.status, /^[\d,]+ flips in/);
  assert.ok(await isShown(page), 'it stays until the visitor does something');
  const { x, y, width, height } = await (await page.page.$('#view')).boundingBox();
  await page.page.mouse.click(x + 0.42 * width, y + height / 2);
  assert.equal(await isShown(page), false);
  assert.ok(await page.page.isVisible('#inspect'));

  await arrive(page, address);
  await page.page.waitForTimeout(500);
  assert.deepEqual([await isShown(page), await page.page.isVisible('#inspect')], [false, false], 'in the same visit');
  await page.close();
});

test('a key ends the guide before it plays, and less motion keeps it from playing; it needs no storage', async () => {
  const forbidStorage = () => {
    Object.defineProperty(window, 'sessionStorage', {
      get() {
        throw new DOMException('denied', 'SecurityError');
      },
    });
  };
  const { page, address } = await newPage(forbidStorage);
  await arrive(page, address);
  await page.page.waitForSelector('#guide:not(:empty)');
  await page.page.keyboard.press('Shift');
  assert.equal(await isShown(page), false);
  await page.page.waitForTimeout(4000);
  assert.equal((await page.rest()).at, '0', 'after a key');

  await page.page.emulateMedia({ reducedMotion: 'reduce' });
  await arrive(page, address);
  await page.page.waitForSelector('#guide:not(:empty)');
  assert.match(await page.page.textContent('#inspect header'), /^Flips now/);
  await page.page.waitForTimeout(4000);
  assert.deepEqual([(await page.rest()).at, await isShown(page)], ['0', true], 'with less motion');

  // A link that says more has no guide.
  await page.page.goto('about:blank');
  await page.page.goto(address);
  await page.page.evaluate(() => (location.hash = '#watch?mesh=models/bunny.ply'));
  await page.rest();
  await page.page.waitForTimeout(300);
  assert.equal(await isShown(page), false);
  await page.close();
});
