// Tests that the words and numbers of the tool are true of what is shown: at a stop, after a scramble, while a run plays,
// beside locked edges, and where there is little room.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { expected, file, first, meshFile, sharedPage } from './page.mjs';

const press = async ({ page }, key) => {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press(key);
};

const textOf = ({ page }, selector) => page.textContent(selector);

/** What the page says under the buttons of "Take away" after a click on one of them. */
async function saysAfter(page, id) {
  await page.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.page.click('#take');
  await page.page.click(`#${id}`);
  await page.page.waitForFunction(() => document.getElementById('away-says').textContent !== '');
  const says = await textOf(page, '#away-says');
  await page.page.keyboard.press('Escape');
  return { says, copied: await page.page.evaluate(() => navigator.clipboard.readText()) };
}

test('the sentence of a phase goes when another mesh opens', async () => {
  const page = await sharedPage('random 12');
  await press(page, '.');
  await page.until('a stop', ({ status }) => status.startsWith('Label.'));
  // Too large for the states of its edges to be known at once.
  const large = await meshFile('random 105', 'large.off');
  const { status } = await page.open(large);
  assert.match(status, /^[\d,]+ edges are wrong/);
  assert.equal(await page.page.locator('#thread .phase').count(), 0);
  await page.close();
});

test('after a scramble, a mesh is still of its sample, and what is said of it, its link and its code is true', async () => {
  const page = await sharedPage('regular 16');
  const about = () => textOf(page, '#about');
  assert.match(await about(), /^All ties: no edge flips, 450 triangles/);
  const input = await page.look();
  await page.page.click('#scramble');
  await page.until('other triangles', ({ state, measured, facts }) => {
    return state === 'ready' && measured === '0' && facts.Fingerprint !== input.facts.Fingerprint;
  });
  assert.equal(await about(), 'Edges scrambled, 450 triangles');
  const marked = await page.page.evaluate(() => document.querySelector('#gallery [aria-pressed=true]')?.dataset.spec);
  assert.equal(marked, 'regular 16');
  await press(page, 'ArrowRight');
  await page.until('an iteration', ({ at, measured }) => at === '1' && measured === '1');
  const link = await saysAfter(page, 'link');
  assert.equal(link.says, 'Link copied. It opens the sample as it was before it was scrambled.');
  const parts = new URLSearchParams(link.copied.split('?')[1]);
  assert.deepEqual([parts.get('mesh'), parts.get('at')], ['regular 16', '0']);
  assert.match((await saysAfter(page, 'code')).says, /^Code copied\. Save the scrambled input/);
  // A mesh of the visitor has no link.
  await page.open(file('one.off', 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n'));
  assert.match((await saysAfter(page, 'link')).says, /^A link opens samples only/);
  await page.close();
});

test('angles that are not measured yet are marked, and a small mesh has its own at every stop and at the end', async () => {
  const page = await sharedPage('models/bunny.ply');
  const { facts, rows } = await expected(first.path, first.maxNormalAngle);
  const seen = () =>
    page.page.evaluate(() => [
      document.getElementById('angles-typical').textContent,
      document.getElementById('angles').classList.contains('is-past'),
    ]);
  const [before, after] = facts['Smallest on average'].match(/[\d.]+/g).map((angle) => Math.round(Number(angle)));
  assert.deepEqual(await seen(), [`smallest on average ${before}°`, false]);
  await page.page.evaluate(() => window.hold('measure'));
  await press(page, 'ArrowRight');
  await page.page.waitForFunction(() => document.getElementById('slider').value === '1');
  assert.deepEqual(await seen(), [`smallest on average ${before}° → …`, true]);
  await page.page.evaluate(() => window.letGo());
  const one = await page.until('an iteration', ({ measured }) => measured === '1');
  const [now, isPast] = await seen();
  assert.match(now, /→ \d+°$/);
  assert.equal(isPast, false);
  assert.equal(
    one.status,
    `After iteration 1 of ${rows.length}: ${rows[1][2]} edges flip next, ${rows[1][1] - rows[1][2]} wait.`,
  );

  // While it plays, with half a minute between iterations.
  await press(page, 'Home');
  await page.rest();
  await page.page.evaluate(() => (document.querySelector('#speed option').value = '30000'));
  await page.page.selectOption('#speed', '30000');
  await page.page.click('#play');
  await page.page.waitForFunction(() => /→ \d/.test(document.getElementById('angles-typical').textContent));
  assert.deepEqual([(await page.look()).state, await seen()], ['playing', [now, false]]);
  await page.page.click('#play');
  await page.rest();
  // The last iteration is the end: nothing is waited for after it.
  await page.page.evaluate((at) => {
    const slider = document.getElementById('slider');
    slider.value = `${at}`;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }, rows.length - 1);
  await page.until('the last but one', ({ at, measured }) => at === `${rows.length - 1}` && measured === at);
  await page.page.click('#play');
  const end = await page.until('the end', ({ state, measured, at }) => state === 'done' && measured === at, 25);
  assert.equal(end.at, `${rows.length}`);
  assert.deepEqual(await seen(), [`smallest on average ${before}° → ${after}°`, false]);
  await page.page.evaluate(() => (document.querySelector('#speed option').value = '1000'));
  await page.close();
});

test('the legend counts locked edges, and the mesh says in plain words what they keep', async () => {
  const page = await sharedPage('models/flange.obj');
  assert.equal(
    await textOf(page, '#about'),
    'A part cut from solids, in four materials, 1,568 triangles. 560 edges stay to keep the materials (usemtl).',
  );
  const locks = page.page.locator('#legend .locks');
  assert.equal(await locks.textContent(), 'Lockedkept where they are560');
  await page.showLimits();
  await page.page.uncheck('#groups');
  await page.until('a run without locks', ({ state, measured }) => state === 'ready' && measured === '0');
  await locks.waitFor({ state: 'detached' });
  await page.page.check('#groups');
  await locks.waitFor();
  await page.rest();
  await page.page.evaluate(() => document.getElementById('limits').hidePopover());

  // In the plane, nothing is kept for the shape.
  await page.open(await meshFile('random 105', 'plane.off'));
  await page.page.waitForFunction(() => /\d/.test(document.querySelector('#legend [data-state=flips] b')?.textContent));
  assert.doesNotMatch(await textOf(page, '#legend'), /Kept|Locked/);
  assert.match(await textOf(page, '#legend'), /Boundary/);
  await page.close();
});

test('on a phone, the labels of the timeline do not touch, and no button shows beside the sheet that it opened', async () => {
  const page = await sharedPage('strips 16');
  await page.page.setViewportSize({ width: 390, height: 844 });
  const labels = () =>
    page.page.evaluate(() => {
      const texts = [...document.querySelectorAll('#bars text')].map((text) => ({
        words: text.textContent,
        box: text.getBoundingClientRect(),
      }));
      const low = Math.max(...texts.map(({ box }) => box.bottom));
      return texts
        .filter(({ box }) => box.bottom > low - 5)
        .sort((one, other) => one.box.left - other.box.left)
        .map(({ words, box }) => ({ words, from: box.left, to: box.right }));
    });
  for (const key of ['Home', 'ArrowRight', 'End', 'ArrowLeft']) {
    await press(page, key);
    await page.rest();
    const seen = await labels();
    assert.deepEqual([seen[0].words, seen.at(-1).words], ['Input', 'Result']);
    assert.ok(seen.length > 6, `${seen.length} labels`);
    for (const [i, { words, to }] of seen.slice(0, -1).entries()) {
      assert.ok(seen[i + 1].from >= to + 3, `${words} touches ${seen[i + 1].words}`);
    }
  }
  const colour = () => page.page.evaluate(() => getComputedStyle(document.getElementById('take')).backgroundColor);
  const closed = await colour();
  await press(page, 's');
  assert.equal(await colour(), closed);
  await press(page, 'Escape');
  await page.page.setViewportSize({ width: 1280, height: 720 });
  await page.close();
});
