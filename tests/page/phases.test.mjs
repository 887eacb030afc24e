// Tests the stops between the phases of an iteration in the tool, in Chromium.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { expected, meshFile, sharedPage } from './page.mjs';

/** A mark that only this stop has. */
const MARKS = { 'Label.': 'candidate', 'Select.': 'choice', 'Flip.': 'fresh', 'Update.': 'link' };

test('a small mesh stops at Label, Select, Flip and Update, with the marks of each', async () => {
  const page = await sharedPage('random 12');
  const { rows } = await expected(await meshFile('random 12', 'twelve.off'));
  const [, labelled, flips] = rows[0].map(Number);
  const stop = async (key, name) => {
    await page.page.keyboard.press(key);
    const { status } = await page.until(name, (seen) => seen.status.startsWith(name));
    // The marks may come some frames after the status.
    await page.page.waitForFunction((kind) => document.querySelector(`#thread .phase.${kind}`), MARKS[name]);
    return status;
  };
  const marks = () =>
    page.page.evaluate(() => {
      const kinds = [...document.querySelectorAll('#thread .phase')].map((path) => path.classList[1]);
      return Object.fromEntries([...new Set(kinds)].map((kind) => [kind, kinds.filter((one) => one === kind).length]));
    });
  assert.equal(await stop('.', 'Label.'), `Label. ${labelled} edges can flip.`);
  assert.deepEqual(await marks(), { candidate: labelled });
  assert.match(await stop('.', 'Select.'), new RegExp(`: ${flips} flip, ${labelled - flips} wait\\.$`));
  const { choice } = await marks();
  assert.ok(choice >= 2 * flips && choice <= 2 * labelled, `${choice} arrows`);
  assert.equal(await stop('.', 'Flip.'), `Flip. ${flips} edges flipped at once.`);
  assert.equal((await page.look()).at, '1');
  assert.deepEqual(await marks(), { old: flips, fresh: flips });
  await stop('.', 'Update.');
  assert.ok((await marks()).link > 0);
  await page.page.click('#phase');
  await page.until('the next label', ({ status }) => status === `Label. ${rows[1][1]} edges can flip.`);
  for (const name of ['Update.', 'Flip.', 'Select.']) await stop(',', name);
  assert.equal((await page.look()).at, '0');
  // On a phone, no key lies on another.
  await page.page.setViewportSize({ width: 390, height: 844 });
  const overlaps = await page.page.evaluate(() => {
    const boxes = [...document.querySelectorAll('.keys button, .does :is(button, select)')].map((key) => ({
      id: key.id,
      box: key.getBoundingClientRect(),
    }));
    const seen = boxes.filter(({ box }) => box.width > 0);
    return seen.flatMap(({ id, box }, i) =>
      seen
        .slice(i + 1)
        .filter(
          ({ box: other }) =>
            box.left < other.right - 0.5 &&
            other.left < box.right - 0.5 &&
            box.top < other.bottom - 0.5 &&
            other.top < box.bottom - 0.5,
        )
        .map((other) => `${id} and ${other.id}`),
    );
  });
  assert.deepEqual(overlaps, []);
  await page.page.setViewportSize({ width: 1280, height: 720 });
  // Whatever else moves the iteration ends the stop.
  await page.scrub('End');
  assert.deepEqual(await marks(), {});
  await page.close();
});

test('a mesh of over 500 triangles has no stops', async () => {
  const page = await sharedPage('random 24');
  assert.equal(await page.page.isVisible('#phase'), false);
  const before = (await page.look()).status;
  await page.page.keyboard.press('.');
  assert.equal((await page.look()).status, before);
  await page.close();
});
