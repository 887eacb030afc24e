// Tests what the page tells a visitor besides the mesh: what was copied, which section is on the screen, and a first view
// from which the mesh can be told.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { sharedPage } from './page.mjs';

const press = async ({ page }, key) => {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press(key);
};

test('what is copied is said where the visitor sees it, also that the browser forbids it', async () => {
  const page = await sharedPage();
  const notice = page.page.locator('#notice');
  await page.page.evaluate(() => (navigator.clipboard.writeText = () => Promise.reject(new Error('forbidden'))));
  await press(page, 'k');
  await notice.getByText('Not copied').waitFor({ state: 'visible' });
  await page.page.click('#take');
  await page.page.click('#code');
  await page.page.locator('#away-says').getByText('Not copied').waitFor({ state: 'visible' });
  await page.page.evaluate(() => delete navigator.clipboard.writeText);
  await page.page.keyboard.press('Escape');
  await notice.getByText('Not copied').waitFor({ state: 'detached', timeout: 20_000 });
  await page.close();
});

test('a terrain is first seen from above, and other meshes as before', async () => {
  const page = await sharedPage();
  await page.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  /** The angle of the camera over the horizon, in degrees. A click on the picture puts the camera into the link. */
  const height = async (spec) => {
    await page.choose('sample', spec);
    await page.until(
      `${spec} to open`,
      ({ state, caption }) => caption === spec.replace('models/', '') && state !== 'busy',
    );
    await page.page.mouse.click(240, 300);
    await page.page.waitForFunction(() => document.getElementById('notice').textContent === '');
    await press(page, 'k');
    await page.page.locator('#notice').getByText('Link copied').waitFor();
    const numbers = new URLSearchParams((await page.page.evaluate(() => navigator.clipboard.readText())).split('?')[1])
      .get('view')
      .split('_')
      .map(Number);
    const [x, y, z] = [0, 1, 2].map((k) => numbers[k] - numbers[3 + k]);
    await page.page.evaluate(() => (document.getElementById('notice').textContent = ''));
    return (Math.atan2(y, Math.hypot(x, z)) * 180) / Math.PI;
  };
  const terrain = await height('models/terrain.obj');
  assert.ok(terrain > 35 && terrain < 50, `${terrain}° over the horizon`);
  for (const spec of ['models/bunny.ply', 'models/suzi.glb', 'uvsphere 28 0.1']) {
    assert.equal(Math.round(await height(spec)), 15, spec);
  }
  await page.close();
});

test('the section on the screen is marked in the navigation', async () => {
  const page = await sharedPage();
  const marked = () =>
    page.page.evaluate(() =>
      Array.from(document.querySelectorAll('.top nav [aria-current=location]'), (link) => link.hash),
    );
  const until = (want) =>
    page.page.waitForFunction(
      (hash) =>
        [...document.querySelectorAll('.top nav [aria-current=location]')].map((link) => link.hash).join() === hash,
      want,
    );
  await until('#watch');
  for (const id of ['explain', 'engines', 'paper']) {
    // What is above it may come in meanwhile.
    await page.page.waitForFunction((name) => {
      document.getElementById(name).scrollIntoView();
      return document.querySelector('.top nav [aria-current=location]')?.hash === `#${name}`;
    }, id);
  }
  // The last one is shorter than the screen.
  await page.page.setViewportSize({ width: 1280, height: 1400 });
  await page.page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
  await until('#package');
  await page.page.setViewportSize({ width: 1280, height: 720 });
  await page.page.evaluate(() => scrollTo(0, 0));
  await until('#watch');
  await page.page.evaluate(() => (location.hash = '#first'));
  await page.page.waitForSelector('#first canvas', { state: 'visible' });
  await until('');
  assert.deepEqual(await marked(), []);
  await page.close();
});
