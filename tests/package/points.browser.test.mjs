// The entry `edgeflip/points` on a page of Chromium and of Firefox, and in a worker there: it loads one module, or that of
// the threads for many points, and the triangles are those in Node. Uses the existing dist/.

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { closeAll, ISOLATED, openPage, serve, startChromium, startFirefox } from '../browsers.mjs';
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

/** Runs in the page or in a worker: how many threads triangulated many points, the sums of the result, and the hint. */
const onThreads = async (url, threads) => {
  const { triangulate } = await import(url);
  let number = 1;
  const points = Float64Array.from({ length: 2 ** 18 }, () => (number = (number * 48271) % 0x7fffffff));
  const asked = triangulate(points, { threads });
  points.fill(NaN);
  const { triangles, twins, hull, duplicates, hint, ...found } = await asked;
  const sums = [triangles, twins, hull, duplicates].map((words) =>
    words.reduce((sum, word) => (Math.imul(sum, 31) + word) | 0, words.length),
  );
  return { threads: found.threads, sums, hint };
};

/** Runs a function in the page and in a worker there. */
const inBoth = async ([work, ...args]) => {
  const script = `onmessage = async ({ data }) => postMessage(await (${work})(...data))`;
  const away = new Worker(URL.createObjectURL(new Blob([script])));
  away.postMessage(args);
  const found = await Promise.all([
    new Function(`return ${work}`)()(...args),
    new Promise((resolve, reject) => {
      away.onmessage = ({ data }) => resolve(data);
      away.onerror = ({ message }) => reject(new Error(message));
    }),
  ]);
  away.terminate();
  const fetched = performance.getEntriesByType('resource').map((entry) => entry.name);
  return [...found, fetched.filter((url) => url.endsWith('.wasm'))];
};

const root = fileURLToPath(new URL('../..', import.meta.url));
const { pathname } = new URL('../../dist/points.js', import.meta.url);

for (const [name, start] of [
  ['Chromium', startChromium],
  ['Firefox', startFirefox],
]) {
  test(`points in ${name}`, async () => {
    const address = await serve(root);
    const { page, problems } = await openPage(await start(), `${address}tests/engines.html`);
    const [here, there, modules] = await page.evaluate(inBoth, [`${everything}`, `${address}dist/points.js`, sets]);
    const expected = await everything(pathname, sets);
    assert.match(expected[3], /so there is no triangle/);
    assert.equal(expected[2].split('\n')[0].split(',').length % 3, 0);
    assert.deepEqual(here, expected);
    assert.deepEqual(there, expected);
    assert.deepEqual(modules, [`${address}dist/wasm/edgeflip_points_bg.wasm`]);
    assert.deepEqual(problems, []);
    await page.close();
  });

  test(`points on several threads in ${name}`, async () => {
    const address = await serve(root, ISOLATED);
    const { page, problems } = await openPage(await start(), `${address}tests/engines.html`);
    const [here, there, modules] = await page.evaluate(inBoth, [`${onThreads}`, `${address}dist/points.js`, 3]);
    const expected = await onThreads(pathname, 1);
    assert.deepEqual(here, { ...expected, threads: 3 });
    assert.deepEqual(there, here);
    assert.deepEqual(modules, [`${address}dist/wasm/edgeflip_points_threads_bg.wasm`]);
    assert.deepEqual(problems, []);
    await page.close();
  });

  test(`many points on a page of ${name} that is not isolated have one thread, and the hint says why`, async () => {
    const address = await serve(root);
    const { page, problems } = await openPage(await start(), `${address}tests/engines.html`);
    const expected = await onThreads(pathname, 1);
    const why = 'workers cannot share memory here; make the page cross-origin isolated, by the headers COOP and COEP';
    for (const [threads, hint] of [
      [3, `The points were triangulated on one thread: ${why}.`],
      [1, undefined],
    ]) {
      const [here, there] = await page.evaluate(inBoth, [`${onThreads}`, `${address}dist/points.js`, threads]);
      assert.deepEqual(here, { ...expected, hint });
      assert.deepEqual(there, here);
    }
    assert.deepEqual(problems, []);
    await page.close();
  });
}
