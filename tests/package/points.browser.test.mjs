// The entry `edgeflip/points` on a page of Chromium and of Firefox, and in a worker there: it loads one module, and the
// triangles are those in Node. Uses the existing dist/.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { closeAll, openPage, serve, startChromium, startFirefox } from '../browsers.mjs';
import { randomOf } from './points.mjs';

after(closeAll);

const random = randomOf(5);
const sets = {
  lattice: Array.from({ length: 3000 }, () => random(40)),
  singles: Array.from({ length: 20_000 }, () => Math.fround(random(2 ** 32) / 1000)),
  doubles: Array.from({ length: 20_000 }, () => random(2 ** 32) / 1000),
  line: [0, 0, 1, 1, 2, 2],
};

/** Runs in the page or in a worker: all results of all sets, with their cells, as text. */
const everything = async (url, sets) => {
  const { triangulate, triangulateSync, voronoi, voronoiSync } = await import(url);
  const texts = [];
  for (const [name, numbers] of Object.entries(sets)) {
    const points = (name === 'singles' ? Float32Array : Float64Array).from(numbers);
    const result = await triangulate(points);
    const again = triangulateSync(points);
    const lists = [result, again].map((all) => Object.values(all).map((list) => (list ? `${list}` : '')));
    if (`${lists[0]}` !== `${lists[1]}`) throw new Error(`${name} without a promise`);
    const box = { bounds: [0.1, 0.2, 1e6, 2e6] };
    const cells = [await voronoi(points, result, box), voronoiSync(points, again, box)];
    const [bits, same] = cells.map((all) => Object.values(all).map((list) => new Uint32Array(list.buffer).join()));
    if (`${bits}` !== `${same}`) throw new Error(`${name}: cells without a promise`);
    texts.push([...lists[0], ...bits].join('\n'));
  }
  return texts;
};

for (const [name, start] of [
  ['Chromium', startChromium],
  ['Firefox', startFirefox],
]) {
  test(`points in ${name}`, async () => {
    const address = await serve(fileURLToPath(new URL('../..', import.meta.url)));
    const { page, problems } = await openPage(await start(), `${address}tests/engines.html`);
    const found = await page.evaluate(
      async ([work, url, sets]) => {
        const script = `onmessage = async () => postMessage(await (${work})('${url}', ${JSON.stringify(sets)}))`;
        const away = new Worker(URL.createObjectURL(new Blob([script])));
        away.postMessage('');
        const [here, there] = await Promise.all([
          new Function(`return ${work}`)()(url, sets),
          new Promise((resolve, reject) => {
            away.onmessage = ({ data }) => resolve(data);
            away.onerror = ({ message }) => reject(new Error(message));
          }),
        ]);
        away.terminate();
        const fetched = performance.getEntriesByType('resource').map((entry) => entry.name);
        return { here, there, modules: fetched.filter((url) => url.endsWith('.wasm')) };
      },
      [`${everything}`, `${address}dist/points.js`, sets],
    );
    const { pathname } = new URL('../../dist/points.js', import.meta.url);
    const expected = await everything(pathname, sets);
    assert.match(expected[3], /so there is no triangle/);
    assert.equal(expected[2].split('\n')[0].split(',').length % 3, 0);
    assert.deepEqual(found.here, expected);
    assert.deepEqual(found.there, expected);
    assert.deepEqual(found.modules, [`${address}dist/wasm/edgeflip_points_bg.wasm`]);
    assert.deepEqual(problems, []);
    await page.close();
  });
}
