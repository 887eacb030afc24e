// Tests what the tool of the page says and shows of a result in Chromium: its sentences, before and now, the saved picture.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { expected, file, first, sharedPage } from './page.mjs';
import { Picture } from './picture.mjs';

const BUNNY = 'models/bunny.ply';

const press = async ({ page }, key) => {
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press(key);
};

test('the sentences of a run count one and many', async () => {
  const page = await sharedPage();
  // A quad whose edge flips, once and twice.
  const points = ['0 0', '0.9 0.2', '1 1', '0 1'];
  const mesh = (quads) => {
    const lines = Array.from({ length: quads }, (_, i) => points.map((point) => `${point} ${i}`)).flat();
    const faces = Array.from({ length: quads }, (_, i) =>
      [`0 1 2`, `0 2 3`].map((f) => f.replace(/\d/g, (v) => 4 * i + +v)),
    );
    return `OFF\n${4 * quads} ${2 * quads} 0\n${lines.join('\n')}\n${faces
      .flat()
      .map((f) => `3 ${f}\n`)
      .join('')}`;
  };
  for (const [quads, input, result] of [
    [
      1,
      '1 edge is wrong. Press play.',
      /^1 flip in 1 iteration, [^,]* ms on the CPU\. Smallest angle on average [\d.]+° → [\d.]+°\.$/,
    ],
    [2, '2 edges are wrong, and all flip at once. Press play.', /^2 flips in 1 iteration, [^,]* on the CPU\. Smallest/],
  ]) {
    await page.open(file(`quads ${quads}.off`, mesh(quads)));
    await page.until(input, ({ status }) => status === input);
    assert.match((await page.playToEnd()).status, result);
  }
  await page.close();
});

test('before and now at the input compares it with the result', async () => {
  const page = await sharedPage(BUNNY);
  const { fingerprints, rows } = await expected(first.path, first.maxNormalAngle);
  const isShown = () => page.page.isVisible('#halves');
  for (const how of ['before any run', 'after a run']) {
    assert.equal((await page.look()).at, '0', how);
    await press(page, 'c');
    const seen = await page.until('the result', ({ state, at, measured }) => state === 'done' && measured === at);
    assert.deepEqual(
      [seen.at, seen.facts.Fingerprint, await isShown()],
      [`${rows.length}`, fingerprints.at(-1), true],
      how,
    );
    await press(page, 'c');
    assert.equal(await isShown(), false);
    await press(page, 'Home');
    await page.rest();
  }
  // Where nothing flips, there is no result to compare with.
  await page.choose('sample', 'regular 16');
  await page.until('a lattice', ({ caption, state }) => caption === 'regular 16' && state !== 'busy');
  await page.rest();
  await press(page, 'c');
  assert.match((await page.rest()).status, /^Already Delaunay/);
  assert.equal(await isShown(), false);
  await page.close();
});

test('a saved picture has the input and the result beside each other, and the result in words', async () => {
  const page = await sharedPage(BUNNY);
  await page.page.evaluate(() => {
    const { fillText } = OffscreenCanvasRenderingContext2D.prototype;
    window.written = [];
    OffscreenCanvasRenderingContext2D.prototype.fillText = function (words, ...more) {
      window.written.push(words);
      fillText.call(this, words, ...more);
    };
  });
  const save = async () => {
    const [download] = await Promise.all([page.page.waitForEvent('download'), press(page, 'p')]);
    const picture = new Picture(readFileSync(await download.path()));
    await page.rest();
    return {
      name: download.suggestedFilename(),
      picture,
      words: await page.page.evaluate(() => window.written.splice(0)),
    };
  };
  /** The pixels of a part: from the left, the share of the width. */
  const part = ({ width, height, pixels }, from, to, rows = height) =>
    pixels.filter((_, i) => i < rows * width && (i % width) / width >= from && (i % width) / width < to);
  const differing = (some, others) => some.reduce((sum, colour, i) => sum + (colour !== others[i]), 0) / some.length;
  const { status } = await page.rest();
  const input = await save();
  assert.equal(input.name, 'bunny-after-0.png');
  assert.deepEqual(input.words, [`Stanford bunny, 3,674 triangles. ${status.replace(' Press play.', '')}`]);
  await press(page, 'End');
  const end = await page.until('the end', ({ state, measured, at }) => state === 'done' && measured === at);
  const both = await save();
  assert.equal(both.name, `bunny-after-${end.at}.png`);
  assert.deepEqual(both.words, ['Before', 'After', end.status]);
  const { width, height } = input.picture;
  assert.deepEqual([both.picture.width, both.picture.height], [2 * width, height]);
  assert.ok(width >= 900, `${width} wide`);
  const rows = Math.floor(0.8 * height);
  const [left, right, alone] = [
    part(both.picture, 0, 0.5, rows),
    part(both.picture, 0.5, 1, rows),
    part(input.picture, 0, 1, rows),
  ];
  assert.ok(differing(left, alone) < 0.02, `left: ${differing(left, alone)} of the input`);
  assert.ok(differing(right, alone) > 0.02, `right: ${differing(right, alone)} of the input`);
  const after = await page.look();
  assert.deepEqual([after.at, after.facts.Fingerprint, after.state], [end.at, end.facts.Fingerprint, 'done']);
  const corner = both.picture.pixels[both.picture.width * (both.picture.height - 1)];
  await press(page, 't');
  const dark = (await save()).picture;
  assert.deepEqual(
    [corner.toString(16), dark.pixels[dark.width * (dark.height - 1)].toString(16)],
    ['f5f7f9', 'a0e14'],
  );
  await press(page, 't');
  await page.close();
});
