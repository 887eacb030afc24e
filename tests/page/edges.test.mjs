// Tests how the page draws meshes of more triangles than it counts states of, in Chromium: their edges where these are
// long enough on screen, elsewhere a tint of each triangle.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { EDGE_STATES, FlipSession } from 'edgeflip';
import { generate } from 'edgeflip/files';
import { startChromium } from '../browsers.mjs';
import { openEdgeflip } from './page.mjs';

/** 50,562 triangles, in a square. */
const MESH = 'random 160';
/** Zooms at which its edges have less than 2 pixels, and more than 15. */
const [FAR, NEAR] = [0.3, 12];

const withoutWebGpu = () => Object.defineProperty(navigator, 'gpu', { value: undefined });

const at = (zoom) => `#watch?${new URLSearchParams({ mesh: MESH, view: `0_0_3_0_0_0_${zoom}` })}`;

/** What the page says of the picture: whether it has edges or tints. */
const says = ({ page }) => page.evaluate(() => document.getElementById('uncoloured').dataset.draws);

/** The numbers of pixels in the colour of flips, in that of edges or darker than a face, and as light as a face. */
function countsOf({ pixels }) {
  const counts = { hot: 0, grey: 0, tinted: 0, face: 0, all: pixels.length };
  for (const pixel of pixels) {
    const [r, g, b] = [pixel >> 16, (pixel >> 8) & 255, pixel & 255];
    if (r > g + 60) counts.hot++;
    else if (r < 215) counts.grey++;
    else if (r < 242) counts.tinted++;
    else if (r > 247 && b > 247) counts.face++;
  }
  return counts;
}

/** The number of edges in each state of the legend, once the page knows them. */
async function legendOf(page) {
  await page.page.waitForFunction(() => /\d/.test(document.querySelector('#legend [data-state=flips] b')?.textContent));
  return page.page.evaluate(() =>
    Object.fromEntries(
      [...document.querySelectorAll('#legend > [data-state]')].map((row) => [
        row.dataset.state,
        Number(row.querySelector('b').textContent.replaceAll(',', '')),
      ]),
    ),
  );
}

/** The same from the package, for the input or the result. */
async function expectedLegend(isResult) {
  const session = await FlipSession.create(await generate(MESH), { backend: 'cpu' });
  if (isResult) await session.run();
  const states = await session.edgeStates();
  session.free();
  const count = (state) => states.filter((number) => EDGE_STATES[number] === state).length;
  const halved = ['delaunay', 'flips', 'waits'].map((state) => [state, count(state) / 2]);
  return Object.fromEntries([...halved, ['boundary', count('boundary')]]);
}

async function toTheEnd(page) {
  await page.page.evaluate(() => document.activeElement.blur());
  await page.page.keyboard.press('End');
  await page.until('the end', ({ state, measured, at }) => state === 'done' && measured === at);
}

for (const api of ['WebGPU', 'WebGL2']) {
  test(`a large mesh shows its edges near by and tints far away, and what flips is hot, on ${api}`, async (t) => {
    const page = await openEdgeflip(await startChromium(), ...(api === 'WebGL2' ? [withoutWebGpu] : []));
    const { facts, status } = await page.follow(at(FAR));
    assert.deepEqual([facts.Iterations, facts.Flips], ['0', '0'], 'the next iteration is known, but not shown');
    assert.match(status, /^[\d,]+ edges are wrong/);
    assert.equal(await says(page), 'tints');
    const far = countsOf(await page.picture());
    t.diagnostic(`far: ${JSON.stringify(far)}`);
    assert.ok(far.hot > 2000 && far.hot > 0.25 * (far.hot + far.grey + far.tinted), 'a field of orange');

    await toTheEnd(page);
    const quiet = countsOf(await page.picture());
    t.diagnostic(`far, at the end: ${JSON.stringify(quiet)}`);
    assert.equal(quiet.hot, 0, 'nothing flips any more');
    assert.ok(quiet.grey + quiet.tinted > 3000, 'tints');
    assert.deepEqual(await legendOf(page), await expectedLegend(true));

    await page.page.keyboard.press('c');
    const cut = await page.page.evaluate(() => {
      document.getElementById('halves').style.opacity = '0';
      return document.getElementById('cut').valueAsNumber / 1000;
    });
    const both = await page.picture();
    await page.page.evaluate(() => (document.getElementById('halves').style.opacity = ''));
    // The picture is the middle half of the canvas.
    const middle = Math.round(both.width * (2 * cut - 0.5));
    /** How light the mesh is beside the cut. */
    const light = (from, to) => {
      let sum = 0;
      const rows = [both.height / 2 - 20, both.height / 2 + 20].map(Math.round);
      for (let y = rows[0]; y < rows[1]; y++)
        for (let x = from; x < to; x++) sum += both.pixels[y * both.width + x] & 255;
      return sum / ((rows[1] - rows[0]) * (to - from));
    };
    const [before, now] = [light(middle - 35, middle - 6), light(middle + 6, middle + 35)];
    t.diagnostic(`before ${before.toFixed(0)}, now ${now.toFixed(0)}`);
    assert.ok(now > before + 8 && now < 245, 'thin triangles are darker, and round ones are tinted too');
    await page.page.keyboard.press('c');

    await page.follow(at(NEAR));
    await page.until('edges that flip', ({ newest }) => newest === '1');
    assert.equal(await says(page), 'edges');
    assert.deepEqual(await legendOf(page), await expectedLegend(false));
    await page.page.keyboard.press('n');
    assert.match(await page.page.textContent('#inspect'), /(?:Flips now|Waits).*more than 180°/s);
    await page.page.keyboard.press('Escape');
    const near = countsOf(await page.picture());
    t.diagnostic(`near: ${JSON.stringify(near)}`);
    assert.ok(near.grey > 0.02 * near.all && near.grey < 0.6 * near.all, 'edges');
    assert.ok(near.face > 0.2 * near.all, 'faces between them');
    assert.ok(near.hot > 0.01 * near.all && near.hot < 0.5 * near.all, 'edges that flip');

    // Without colours, and without edges.
    for (const [draws, isSo] of [
      ['edges', ({ hot, grey, all }) => hot === 0 && grey > 0.02 * all],
      ['nothing', ({ hot, grey }) => hot === 0 && grey === 0],
    ]) {
      await page.page.keyboard.press('e');
      await page.rest();
      const counts = countsOf(await page.picture());
      assert.ok(isSo(counts), `${draws}: ${JSON.stringify(counts)}`);
      assert.equal(await says(page), draws);
    }
    await page.close();
  });
}
