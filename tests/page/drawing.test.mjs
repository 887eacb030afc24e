// Tests edges that are drawn into the mesh of the page, in Chromium.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { makeDelaunay } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { sharedPage } from './page.mjs';

test('edges that are drawn come in, and stay', async () => {
  const page = await sharedPage();
  await page.page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
  await page.choose('sample', 'models/suzi.glb');
  await page.rest();
  const isShown = (id) => page.page.isVisible(`#${id}`);
  assert.deepEqual([await isShown('draw'), await isShown('limit')], [false, true], 'a surface');
  await page.page.keyboard.press('d');
  assert.equal(await page.page.getAttribute('#draw', 'aria-pressed'), 'false', 'the key does nothing there');
  await page.choose('sample', 'random 24');
  await page.rest();
  assert.deepEqual([await isShown('draw'), await isShown('limit')], [true, false], 'a mesh in the plane');
  const mesh = await generate('random 24');
  await page.choose('speed', '0');
  await page.page.keyboard.press('d');
  const middle = await page.page.evaluate(() => {
    const [left, right] = ['.what', '.side'].map(
      (name) => document.querySelector(`#watch ${name}`).getBoundingClientRect().x,
    );
    return [(left + right) / 2, innerHeight / 2 - 40];
  });
  const drag = async (dx, dy) => {
    const [x, y] = middle;
    await page.page.mouse.move(x - dx, y - dy);
    await page.page.mouse.down();
    await page.page.mouse.move(x + dx, y + dy, { steps: 4 });
    await page.page.mouse.up();
  };
  // The mesh is brought in, and then it plays to the end by itself.
  await drag(120, 90);
  await page.until('the end', ({ state }) => state === 'done');
  const end = await page.rest();
  assert.match(
    end.status,
    /^\d+ flips? in \d+ iterations?, .* ms on the CPU\. Smallest angle on average [^.]*°\.( \d+ edges? stays?, because (it is|they are) locked\.)?$/,
  );
  await drag(120, -90);
  const crossing = await page.until('a message', ({ error }) => error !== '');
  assert.match(crossing.error, /The edge between \d+ and \d+ crosses the locked edge between \d+ and \d+\.\s/);
  await drag(0, 1);
  assert.equal((await page.rest()).facts.Fingerprint, end.facts.Fingerprint, 'a click draws nothing');
  const drawn = await page.download();
  assert.deepEqual(drawn.positions, mesh.positions);
  await page.page.click('#take');
  await page.page.click('#code');
  const [, u, v] = /constraints: \[(\d+), (\d+)\]/.exec(await page.page.evaluate(() => navigator.clipboard.readText()));
  const constraints = [Number(u), Number(v)];
  const { indices } = await makeDelaunay(mesh, { constraints, backend: 'cpu' });
  const edgesOf = (triangles) => {
    const ends = [...triangles].map((from, h) => [from, triangles[h % 3 === 2 ? h - 2 : h + 1]].sort().join());
    return new Set(ends);
  };
  // Random points have no ties.
  assert.deepEqual(edgesOf(drawn.indices), edgesOf(indices));
  await page.page.click('#link');
  await page.page.locator('#away-says').getByText('It opens the sample as it was before you drew edges.').waitFor();
  assert.match(await page.page.textContent('#about'), /^With edges that you drew, /);
  await page.page.keyboard.press('Escape');
  await page.page.keyboard.press('Escape');
  assert.equal(await page.page.getAttribute('#draw', 'aria-pressed'), 'false');
  await page.close();
});
